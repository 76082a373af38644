// How far a motion carries a body at most.
#pragma once

#include <algorithm>

#include "odds/math/pose.hpp"
#include "odds/math/tolerances.hpp"

namespace odds::math {

/// Twice the sine of half the angle by which a frame turns from pose `from` to pose `to`: the angle while it is small.
[[nodiscard]] inline double turn_between(const Pose& from, const Pose& to) noexcept {
  constexpr double root_half = 0.70710678118654757;
  return root_half * (to.rotation - from.rotation).norm();
}

/// No point at distance 1 from the moved frame's origin goes farther as that frame turns, also where both poses are
/// only just rigid: what they are off their nearest rotations, up to 1.5 times the tolerance in the spectral norm and
/// in that of Frobenius, may be a stretch along one axis, of which both norms are the same.
[[nodiscard]] inline double turn_bound(const Pose& from, const Pose& to) noexcept {
  constexpr double root_half = 0.70710678118654757;
  constexpr double stretches = 6.0 * tolerances::pose_orthonormality;  // 1.5 of each pose, times 1 + root_half
  const double norm = (to.rotation - from.rotation).norm();
  return std::min(norm, root_half * norm + stretches);
}

/// No point within `reach` of the moved frame's origin goes farther from pose `from` to pose `to`, if both are rigid.
/// Metres. A rotation by an angle differs from the identity by 2 sin(angle / 2) in the spectral norm, and by sqrt(2)
/// times that in the Frobenius norm.
[[nodiscard]] inline double motion_bound(const Pose& from, const Pose& to, double reach) noexcept {
  return ((to.translation - from.translation).norm() + reach * turn_between(from, to)) * (1.0 + 1e-12);
}

/// How far the surfaces of two bodies lie from the origins of their frames at most, metres.
struct Reaches {
  double a = 0.0;
  double b = 0.0;

  /// Whose motion is counted. A body that turns about itself moves in the other one's frame by up to 1.5 times as much
  /// then as in its own.
  [[nodiscard]] bool is_a_much_smaller() const noexcept { return a < 0.25 * b; }
  [[nodiscard]] double of_the_moving() const noexcept { return is_a_much_smaller() ? a : b; }
};

/// By how much at most two bodies come nearer to each other, or deeper into each other, as B goes from pose `from` to
/// pose `to` in A's frame, also where both are only just rigid. Metres; of several motions one after the other, the
/// sum. No more than any point of B moves in A's frame, and no more than any point of A does in B's: where a crate that
/// rocks is A, its ground is carried far in its frame, and it is not in that of the ground. Which of them depends on
/// the bodies alone, for at poses that are only just rigid distances differ by 1.5 times the tolerance between both
/// frames, and not only once where they take turns.
[[nodiscard]] inline double approach_bound(const Pose& from, const Pose& to, const Reaches& reaches) noexcept {
  if (!reaches.is_a_much_smaller()) {
    return ((to.translation - from.translation).norm() + reaches.b * turn_bound(from, to)) * (1.0 + 1e-12);
  }
  const Vec3 moved = to.inverse().translation - from.inverse().translation;
  const double motion = moved.norm() + reaches.a * turn_bound(from, to);
  if (motion == 0.0) return 0.0;
  const double rounding = 0x1p-48 * (from.translation.lpNorm<1>() + to.translation.lpNorm<1>());  // of inverse poses
  return motion * (1.0 + 4.0 * tolerances::pose_orthonormality) + rounding;
}

/// The same as `motion_bound`, of a body's points within `reach` of one of them, `place` in the body's frame. Metres.
[[nodiscard]] inline double motion_bound_about(const Vec3& place, const Pose& from, const Pose& to,
                                               double reach) noexcept {
  return motion_bound({from.rotation, from * place}, {to.rotation, to * place}, reach);
}

/// How the moved frame's point that is at `place` in pose `to` has come there from pose `from`.
[[nodiscard]] inline Vec3 motion_of(const Vec3& place, const Pose& from, const Pose& to) noexcept {
  return place - from * (to.inverse() * place);
}

}  // namespace odds::math
