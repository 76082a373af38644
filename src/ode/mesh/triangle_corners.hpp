// One triangle as collisions with spheres and boxes see it: closest point, normal, angle at a point.
#pragma once

#include <array>

#include "odds/math/types.hpp"
#include "odds/primitive/triangle_distance.hpp"

namespace odds::ode {

using Corners = std::array<Vec3, 3>;

/// The point of the triangle nearest to `point`.
[[nodiscard]] inline Vec3 closest_point(const Corners& triangle, const Vec3& point) noexcept {
  return primitive::closest_point_on_triangle(point, triangle.data());
}

/// Unit normal by the right-hand rule, or zero if the triangle has no area.
[[nodiscard]] Vec3 unit_normal(const Corners& triangle) noexcept;

/// Whether a triangle is a hundred times as long as it is high, and no higher than `height` (metres): it may be nothing
/// but its corners' rounding, as where edges of unlike length meet, and face anywhere.
[[nodiscard]] bool is_thin(const Corners& triangle, double height) noexcept;

/// The angle under which the triangle is seen from a point on it, in radians: 2 pi inside, pi on an edge, the corner's
/// angle at a corner. `tolerance` (metres) decides what is on an edge. Weighting normals with it gives a pseudo-normal
/// whose sign tells inside from outside (Baerentzen and Aanaes 2005).
[[nodiscard]] double angle_at(const Corners& triangle, const Vec3& point_on_it, double tolerance) noexcept;

}  // namespace odds::ode
