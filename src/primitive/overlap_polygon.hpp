// The longest diagonal of what two triangles in one plane have in common, or a common point of degenerate ones.
#pragma once

#include "odds/primitive/triangle_triangle.hpp"

namespace odds::primitive::detail {

/// Precondition: the triangles meet (exactly); coordinates small enough for cubes to be doubles. For two triangles with
/// area in one plane: the longest diagonal of their common polygon, rounded. Otherwise a common point, twice.
[[nodiscard]] IntersectionSegment flat_overlap(const Vec3 a[3], const Vec3 b[3]) noexcept;

}  // namespace odds::primitive::detail
