// Where a ray crosses a triangle.
#pragma once

#include "odds/math/types.hpp"

namespace odds::primitive {

/// Distance along origin + t * direction to the triangle with these corners, in units of `direction`'s length; a
/// negative number where it is not crossed, or lies along the triangle's plane, or the triangle has no area. Moeller
/// and Trumbore 1997, with closed edges: they are widened by 1e-12 of their length, and by what rounding may make of a
/// long way to them, up to 1e-6: for a crossing counted twice does no harm to the nearest one, and a gap would. Where
/// the determinant may be nothing but rounding, as in a plane that is askew to the axes, a crossing counts if the
/// points that it is on the ray and on the triangle are one. Thread-safe.
[[nodiscard]] double distance_along_ray(const Vec3 corners[3], const Vec3& origin, const Vec3& direction) noexcept;

}  // namespace odds::primitive
