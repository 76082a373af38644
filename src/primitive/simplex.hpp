// Points, segments and triangles as what they really are, and their exact intersection: for input that fixes no plane.
#pragma once

#include "odds/math/types.hpp"

namespace odds::primitive::detail {

/// Corners in general position: 1 (point), 2 (segment) or 3 (triangle with area).
struct Simplex {
  Vec3 corner[3];
  int count;

  [[nodiscard]] const Vec3* begin() const noexcept { return corner; }
  [[nodiscard]] const Vec3* end() const noexcept { return corner + count; }
};

/// The closed set that three corners span, without what is redundant. Exact.
[[nodiscard]] Simplex simplex_of(const Vec3 triangle[3]) noexcept;

/// True if two closed simplices meet. Exact. Precondition: they are not two triangles in different planes.
[[nodiscard]] bool simplices_intersect(const Simplex& a, const Simplex& b) noexcept;

/// Axis along which the plane of a triangle with area projects without collapsing. Exact.
[[nodiscard]] int projection_axis(const Vec3& a, const Vec3& b, const Vec3& c) noexcept;

/// orient2d of the projections along `axis`.
[[nodiscard]] int projected_orientation(const Vec3& a, const Vec3& b, const Vec3& c, int axis) noexcept;

}  // namespace odds::primitive::detail
