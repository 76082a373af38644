// What earlier runs of a pair say about how deep the bodies can be in each other now.
#pragma once

#include <limits>

#include "odds/math/pose.hpp"
#include "odds/math/motion.hpp"

namespace odds::query {

/// Bodies that were apart, or had a known depth, can since have gone deeper by no more than they have moved. That
/// bounds the depth of contacts that there was no time to measure: a guess of a direction never throws a body away.
class KnownDepth {
 public:
  void forget() noexcept { known_ = false; }
  /// `depth` metres, 0 where they are apart; `pose` of B in A.
  void note(const math::Pose& pose, double depth) noexcept {
    pose_ = pose;
    depth_ = depth;
    known_ = true;
  }
  [[nodiscard]] bool known() const noexcept { return known_; }
  /// Of any contact at this pose; infinite if nothing is known. `reach` of B's surface from its frame's origin.
  [[nodiscard]] double most(const math::Pose& pose, double reach) const noexcept {
    return known_ ? depth_ + math::motion_bound(pose_, pose, reach) : std::numeric_limits<double>::infinity();
  }

 private:
  math::Pose pose_;
  double depth_ = 0.0;
  bool known_ = false;
};

}  // namespace odds::query
