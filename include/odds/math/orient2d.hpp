// On which side of a line a point of the plane lies, and whether three points lie on one line: exact for all doubles.
#pragma once

#include <algorithm>
#include <cmath>

#include "odds/math/types.hpp"

namespace odds::math {

/// Below this size of differences products may fall under the normal range, above the other they may exceed it; there
/// the floating-point filters of the exact predicates hand over to exact arithmetic.
inline constexpr double kFilterSmallest = 1e-97;
inline constexpr double kFilterLargest = 1e102;

namespace detail {
[[nodiscard]] int orient2d_exact(double ax, double ay, double bx, double by, double cx, double cy) noexcept;
}

/// Exact sign of (b - a) x (c - a): 1 if a, b, c turn counter-clockwise, -1 if clockwise, 0 if they lie on one line.
/// Any finite doubles, subnormals included; unit-free. A few ns when rounding cannot matter, some 100 ns otherwise,
/// some 10 us where coordinates leave 2^-305 to 2^330. No allocation; thread-safe.
[[nodiscard]] inline int orient2d(double ax, double ay, double bx, double by, double cx, double cy) noexcept {
  const double bax = bx - ax;
  const double bay = by - ay;
  const double cax = cx - ax;
  const double cay = cy - ay;
  const double largest_x = std::max(std::fabs(bax), std::fabs(cax));
  const double largest_y = std::max(std::fabs(bay), std::fabs(cay));
  if (std::min(largest_x, largest_y) >= kFilterSmallest && std::max(largest_x, largest_y) <= kFilterLargest) {
    // Each difference errs by u = 2^-53 relatively, each product by 3u, their difference by 2u more: 8u of the product
    // of the largest differences; one more for the rounding of the bound and for terms in u^2.
    constexpr double kError = 9.0 * 0x1p-53;
    const double determinant = bax * cay - bay * cax;
    const double bound = kError * (largest_x * largest_y);
    if (determinant > bound) return 1;
    if (determinant < -bound) return -1;
  }
  return detail::orient2d_exact(ax, ay, bx, by, cx, cy);
}

/// True if the three points lie exactly on one line (or coincide): the triangle has no area. Any finite doubles.
[[nodiscard]] inline bool collinear(const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  return orient2d(a.x(), a.y(), b.x(), b.y(), c.x(), c.y()) == 0 &&
         orient2d(a.y(), a.z(), b.y(), b.z(), c.y(), c.z()) == 0 &&
         orient2d(a.z(), a.x(), b.z(), b.x(), c.z(), c.x()) == 0;
}

}  // namespace odds::math
