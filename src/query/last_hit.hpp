// What a proved hit says of the runs after it that a budget ends.
#pragma once

#include <algorithm>

#include "odds/math/motion.hpp"
#include "odds/math/pose.hpp"

namespace odds::query {

/// Bodies that were proved to meet go on meeting until they have moved some way, or are proved apart.
class LastHit {
 public:
  /// Of the smaller body's size: what hardly any motion parts, and what says nothing any more.
  static constexpr double near = 0.1;
  static constexpr double far = 0.3;
  static constexpr double stays = 0.9;  ///< probability that they meet while they have moved less than `near`

  void forget() noexcept { known_ = false; }
  /// `pose` of B in A.
  void note(const math::Pose& pose) noexcept {
    pose_ = pose;
    known_ = true;
  }
  /// That they meet, if nothing else is known; 0 if this is not. `reach` of B's surface from its frame's origin, `size`
  /// of the smaller body, metres.
  [[nodiscard]] double probability(const math::Pose& pose, double reach, double size) const noexcept {
    if (!known_) return 0.0;
    const double moved = math::motion_bound(pose_, pose, reach) / size;
    return moved < far ? stays - (stays - 0.5) * std::clamp((moved - near) / (far - near), 0.0, 1.0) : 0.0;
  }

 private:
  math::Pose pose_;
  bool known_ = false;
};

}  // namespace odds::query
