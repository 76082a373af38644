// How far a motion carries a body at most.
#pragma once

#include "odds/math/pose.hpp"

namespace odds::math {

/// Twice the sine of half the angle by which a frame turns from pose `from` to pose `to`: the angle while it is small.
[[nodiscard]] inline double turn_between(const Pose& from, const Pose& to) noexcept {
  constexpr double root_half = 0.70710678118654757;
  return root_half * (to.rotation - from.rotation).norm();
}

/// No point within `reach` of the moved frame's origin goes farther from pose `from` to pose `to`. Metres. A rotation
/// by an angle differs from the identity by 2 sin(angle / 2) in the spectral norm, and by sqrt(2) times that in the
/// Frobenius norm.
[[nodiscard]] inline double motion_bound(const Pose& from, const Pose& to, double reach) noexcept {
  return ((to.translation - from.translation).norm() + reach * turn_between(from, to)) * (1.0 + 1e-12);
}

/// The same of a body's points within `reach` of one of them, `place` in the body's frame. Metres.
[[nodiscard]] inline double motion_bound_about(const Vec3& place, const Pose& from, const Pose& to,
                                               double reach) noexcept {
  return motion_bound({from.rotation, from * place}, {to.rotation, to * place}, reach);
}

/// How the moved frame's point that is at `place` in pose `to` has come there from pose `from`.
[[nodiscard]] inline Vec3 motion_of(const Vec3& place, const Pose& from, const Pose& to) noexcept {
  return place - from * (to.inverse() * place);
}

}  // namespace odds::math
