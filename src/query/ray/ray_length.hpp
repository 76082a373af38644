// Where a ray that may begin far off, and may be infinite, can meet a tree.
#pragma once

#include <cmath>
#include <limits>

#include "odds/math/types.hpp"

namespace odds::query {

/// Nothing lies beyond the far side of the enclosing ball; this also makes an infinite length finite. `away`: of the
/// ray's origin, from the ball's middle.
[[nodiscard]] inline double length_within(double reach, double away, double max_distance) noexcept {
  constexpr double unit_length = 1e-6;  // how nearly the direction has it
  return std::fmin(max_distance, (away + reach) * (1.0 + unit_length));
}

[[nodiscard]] inline bool is_far_off(double reach, double away) noexcept { return away > 64.0 * reach; }

/// How much of a ray from far off comes before the near side of the enclosing ball, in units of the direction's length;
/// not a number where it leads away. Beyond that, single precision tells boxes apart, and all triangles agree on what
/// the rounding of large coordinates has made of the ray.
[[nodiscard]] inline double skipped_way(double reach, const Vec3& local, const Vec3& direction) noexcept {
  constexpr double rounding = 4e-15;  // of the way, and more
  const double to_middle = -local.dot(direction) / direction.squaredNorm();
  const double around = 2.0 * reach + rounding * local.norm();
  if (to_middle < -around) return std::numeric_limits<double>::quiet_NaN();
  return to_middle > around ? to_middle - around : 0.0;
}

}  // namespace odds::query
