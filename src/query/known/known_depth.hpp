// What earlier runs of a pair say about how deep the bodies can be in each other now.
#pragma once

#include <algorithm>
#include <limits>

#include "odds/math/motion.hpp"
#include "odds/math/pose.hpp"

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
  /// What was noted, metres.
  [[nodiscard]] double depth() const noexcept { return depth_; }
  /// Of any contact at this pose; infinite if nothing is known.
  [[nodiscard]] double most(const math::Pose& pose, const math::Reaches& reaches) const noexcept {
    return known_ ? depth_ + math::approach_bound(pose_, pose, reaches) : std::numeric_limits<double>::infinity();
  }
  /// How B's point that is now at `place`, in A's frame, has moved since; zero if nothing is known.
  [[nodiscard]] Vec3 motion_of(const Vec3& place, const math::Pose& pose) const noexcept {
    return known_ ? math::motion_of(place, pose_, pose) : Vec3(Vec3::Zero());
  }
  /// How the origin of A's frame has moved in B's since, along the axes of A's now; zero if nothing is known.
  [[nodiscard]] Vec3 motion_of_a(const math::Pose& pose) const noexcept {
    return known_ ? Vec3(pose.rotation * (pose.inverse().translation - pose_.inverse().translation))
                  : Vec3(Vec3::Zero());
  }
  /// What is believed of one contact, metres: what was known, and how far B has since come along its normal there; a
  /// small share of how far it has slid, for surfaces have slopes. `place` in A's frame, `normal` unit and into A; 0 if
  /// nothing is known.
  [[nodiscard]] double believed(const Vec3& place, const Vec3& normal, const math::Pose& pose) const noexcept {
    if (!known_) return 0.0;
    const Vec3 come = motion_of(place, pose);
    const double along = normal.dot(come);
    const double slid = (come - along * normal).norm();
    return std::max(depth_ + along + slope * slid, 0.0);
  }

 private:
  static constexpr double slope = 0.05;

  math::Pose pose_;
  double depth_ = 0.0;
  bool known_ = false;
};

}  // namespace odds::query
