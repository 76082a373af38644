// Positions of what triangles have in common: an edge and a plane, two triangles in one plane, degenerate ones.
#pragma once

#include "odds/primitive/triangle_triangle.hpp"

namespace odds::primitive::detail {

/// Where the edge from p to q meets the plane of a, b, c: a corner if it lies exactly in the plane, else rounded. On
/// the edge and finite in any case. Precondition: p and q are not strictly on one side, nor both in the plane.
[[nodiscard]] Vec3 edge_through_plane(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b,
                                      const Vec3& c) noexcept;

/// Precondition: the triangles meet (exactly); coordinates small enough for cubes to be doubles. For two triangles with
/// area in one plane: the longest diagonal of their common polygon, rounded. Otherwise a common point, twice.
[[nodiscard]] IntersectionSegment flat_overlap(const Vec3 a[3], const Vec3 b[3]) noexcept;

}  // namespace odds::primitive::detail
