// Distance of a point from the convex hull of few points, from above.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "odds/math/types.hpp"

namespace odds::volume {

/// GJK for a point. Never too small by more than rounding, and stopped once `good_enough` is proved; exact otherwise,
/// but for some 1e-6 of itself. Any input, flat and repeated points too. `vertices` not empty.
[[nodiscard]] double distance_to_hull(const Vec3& point, std::span<const Vec3> vertices, double good_enough) noexcept;

/// The point of the closed triangle a b c, degenerate or not, that is nearest to the origin.
[[nodiscard]] Vec3 nearest_to_origin(const Vec3& a, const Vec3& b, const Vec3& c) noexcept;

}  // namespace odds::volume
