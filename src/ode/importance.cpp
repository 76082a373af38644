// Importance and shares: plain arithmetic.
#include "ode/importance.hpp"

#include <algorithm>
#include <cmath>

namespace odds::ode {
namespace {

constexpr double base = 0.02;           // even what is proved apart may move
constexpr double memory_frames = 20.0;  // contacts of a tenth of a second ago say little

}  // namespace

double importance(const PairSigns& s) noexcept {
  const double recent = s.ever_contact ? std::exp(-static_cast<double>(s.since_contact) / memory_frames) : 0.0;
  // A proof of the last frame holds the longer, the slower the pair moves.
  const double stale = s.proved ? std::min(1.0, s.way_share) : 1.0;
  const double doubt = s.hit_probability * stale;
  const double likely = base + std::max(recent, doubt) + 0.1 * stale;
  const double moved = 1.0 + 2.0 * std::clamp(s.relative_speed, 0.0, 1.0);
  return std::log2(likely * moved * s.attention) + static_cast<double>(s.waited);
}

double PartsOfRest::next(double importance) noexcept {
  // Importances of thousands of frames have no sum that a double could hold; against the greatest of them they have.
  sum_ = 1.0 + sum_ * std::exp2(last_ - importance);
  last_ = importance;
  return 1.0 / sum_;
}

double share_of(const Share& s) noexcept {
  const double kept = std::min(s.after * s.floor, s.left);
  const double pool = s.left - kept;
  const double fair = pool * s.part;
  // One pair that needs much does not leave the others with their floors, as long as there are others.
  const double most = s.after > 0.0 ? 0.5 * pool : pool;
  return std::clamp(std::max(fair, std::min(s.demand, most)), std::min(s.floor, s.left), s.left);
}

}  // namespace odds::ode
