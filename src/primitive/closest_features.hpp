// Closest points of polygons with one to three corners by trying all pairs of features; knows nothing of intersection.
#pragma once

#include "odds/primitive/triangle_distance.hpp"

namespace odds::primitive::detail {

/// The closest pair among corners, edges and faces, those inside the other excepted: right for primitives that do not
/// meet, and for those that meet in a corner or an edge right up to rounding. May say 0 for primitives that are apart
/// by less than rounding.
///
/// Of polygons with so many corners: a point or segment, and a triangle; two triangles.
template <int corners_a, int corners_b>
[[nodiscard]] ClosestPoints closest_features(const Vec3* a, const Vec3* b) noexcept;

}  // namespace odds::primitive::detail
