// Closest points of polygons with one to three corners by trying all pairs of features; knows nothing of intersection.
#pragma once

#include "odds/primitive/triangle_distance.hpp"

namespace odds::primitive::detail {

/// Up to three corners; a segment has two, a point one. Degenerate ones are welcome.
struct CornerSpan {
  const Vec3* corner;
  int count;
};

/// The closest pair among corners, edges and faces, those inside the other excepted: right for primitives that do not
/// meet, and for those that meet in a corner or an edge right up to rounding. May say 0 for primitives that are apart
/// by less than rounding.
[[nodiscard]] ClosestPoints closest_features(CornerSpan a, CornerSpan b) noexcept;

}  // namespace odds::primitive::detail
