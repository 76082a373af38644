// Up at once, down slowly: a share that is a little too large costs little, one that is too small buys nothing.
#include "ode/frame/frame_need.hpp"

#include <algorithm>

namespace odds::ode {
namespace {

constexpr double clear_fall = 0.125;  // of the way down to what the last one cost
constexpr double far_fall = 0.85;     // in a turn that was of use, while far from what was too little
constexpr double near_fall = 0.995;   // ... near to it
constexpr double near = 1.5;
constexpr double forgetting = 0.99;

}  // namespace

double FrameNeed::least_share(double unknown, double most) const noexcept {
  return std::min(need_ >= 0.0 ? need_ : unknown, most);
}

bool FrameNeed::learn(double share, double cost, Outcome outcome, double most) noexcept {
  hungry_ = outcome == Outcome::starved || outcome == Outcome::enough;
  if (outcome == Outcome::starved) {
    // A search does nothing with a share that is smaller than its smallest piece of work.
    const double too_little = std::max(share, cost);
    const bool had_most = share >= most;
    need_ = had_most ? nobody_knows : std::max(need_, 2.0 * too_little);
    starved_at_ = had_most ? 0.0 : std::max(starved_at_, too_little);
    return had_most;
  }
  if (outcome == Outcome::carried) return true;
  if (outcome == Outcome::enough || outcome == Outcome::plenty) {
    fall(cost);
  } else {
    need_ = cost >= need_ ? cost : need_ + clear_fall * (cost - need_);
  }
  starved_at_ *= forgetting;
  return true;
}

// Something smaller may do as well, but for what has lately been too little.
void FrameNeed::fall(double cost) noexcept {
  const double known = need_ >= 0.0 ? std::min(need_, cost) : cost;
  need_ = std::max(far_fall * known, std::min(near_fall * known, near * starved_at_));
}

}  // namespace odds::ode
