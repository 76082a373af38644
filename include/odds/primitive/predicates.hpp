// On which side of a plane a point lies: exact for all doubles, fast where rounding cannot matter.
#pragma once

#include <algorithm>
#include <cmath>

#include "odds/math/orient2d.hpp"
#include "odds/math/types.hpp"

namespace odds::primitive {

using math::collinear;
using math::orient2d;

/// Rounding error of a 3x3 determinant of differences, relative to the product of the largest differences along x, y,
/// z. With u = 2^-53: each 2x2 minor errs by 8u and is at most 2, so each of the three terms errs by 8u + 2(u + u) =
/// 12u and is at most 2, and the two sums add (4 + 6)u: 46u; two more for the rounding of the bound and for terms in
/// u^2.
inline constexpr double kOrient3dError = 48.0 * 0x1p-53;

namespace detail {
[[nodiscard]] int orient3d_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) noexcept;
}

/// Bound of the rounding error of a determinant of differences that are at most x, y, z in size along the axes;
/// infinite where products may leave the range of doubles, so that no sign is trusted there.
[[nodiscard]] inline double orient3d_error_bound(double x, double y, double z) noexcept {
  const bool in_range = std::min({x, y, z}) >= math::kFilterSmallest && std::max({x, y, z}) <= math::kFilterLargest;
  return in_range ? kOrient3dError * (x * y * z) : HUGE_VAL;
}

/// Exact sign of ((b - a) x (c - a)) . (d - a): 1 if d lies on the side of the plane (a, b, c) to which its normal
/// points (a, b, c turn counter-clockwise seen from there), -1 on the other, 0 if the four points lie in one plane. Any
/// finite doubles, subnormals included; unit-free. A swap of two arguments flips the sign. Some 5 ns when rounding
/// cannot matter, some 60 ns when it could, some 300 ns in one plane, some 50 us where coordinates leave 2^-305 to
/// 2^330. No allocation; thread-safe. Source of the exact part: Shewchuk 1997.
[[nodiscard]] inline int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) noexcept {
  const double bx = b.x() - a.x(), by = b.y() - a.y(), bz = b.z() - a.z();
  const double cx = c.x() - a.x(), cy = c.y() - a.y(), cz = c.z() - a.z();
  const double dx = d.x() - a.x(), dy = d.y() - a.y(), dz = d.z() - a.z();
  const double determinant = (by * cz - bz * cy) * dx + (bz * cx - bx * cz) * dy + (bx * cy - by * cx) * dz;
  const double bound = orient3d_error_bound(std::max({std::fabs(bx), std::fabs(cx), std::fabs(dx)}),
                                            std::max({std::fabs(by), std::fabs(cy), std::fabs(dy)}),
                                            std::max({std::fabs(bz), std::fabs(cz), std::fabs(dz)}));
  if (determinant > bound) return 1;
  if (determinant < -bound) return -1;
  return detail::orient3d_exact(a, b, c, d);
}

}  // namespace odds::primitive
