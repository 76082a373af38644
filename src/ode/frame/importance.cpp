// Importance and shares: plain arithmetic.
#include "ode/frame/importance.hpp"

#include <algorithm>
#include <cmath>

namespace odds::ode {
namespace {

constexpr double base = 0.02;           // even what is proved apart may move
constexpr double memory_frames = 20.0;  // contacts of a tenth of a second ago say little
constexpr double spare = 1.5;           // a pair may need more than in the last frame

}  // namespace

double importance(const PairSigns& s) noexcept {
  const double recent = s.ever_contact ? std::exp(-static_cast<double>(s.since_contact) / memory_frames) : 0.0;
  // A proof of the last frame holds the longer, the slower the pair moves.
  const double stale = s.proved ? std::min(1.0, s.way_share) : 1.0;
  const double doubt = s.hit_probability * stale;
  const double likely = base + std::max(recent, doubt) + 0.1 * stale;
  const double moved = 1.0 + 2.0 * std::clamp(s.relative_speed, 0.0, 1.0);
  return std::log2(likely * moved * s.attention);
}

double turn(double importance, double most_important, std::uint64_t waited) noexcept {
  return std::max(importance - most_important, least_in_turns) + 2.0 * std::log2(1.0 + static_cast<double>(waited));
}

double share_of(const Share& s) noexcept {
  const double pool = std::max(0.0, s.left - s.kept);
  return std::min(std::max(spare * s.need, s.need + std::max(0.0, pool - s.need) * s.part), pool);
}

}  // namespace odds::ode
