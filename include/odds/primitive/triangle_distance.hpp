// Closest points of points, segments and triangles.
#pragma once

#include "odds/math/types.hpp"

namespace odds::primitive {

/// Two points at the smallest distance, each in its own primitive up to rounding; same frame and unit as the input.
struct ClosestPoints {
  double squared_distance = 0.0;  ///< 0 exactly if and only if the primitives meet
  Vec3 on_a = Vec3::Zero();
  Vec3 on_b = Vec3::Zero();
};

/// All functions: any corners up to 1e300 in size, degenerate triangles and segments included; never NaN. Distances are
/// right to some 1e-15 of the largest distance between corners, of triangles parallel to within 1e-6 to some 1e-12.
/// Squares beyond the range of doubles become 0 or infinite, the points stay right. No allocation; thread-safe.

/// The point of a closed triangle next to `point`.
[[nodiscard]] Vec3 closest_point_on_triangle(const Vec3& point, const Vec3 triangle[3]) noexcept;

/// Segment from `begin` to `end` (primitive a) and triangle (b). Whether they meet is decided exactly.
[[nodiscard]] ClosestPoints closest_points_segment_triangle(const Vec3& begin, const Vec3& end,
                                                            const Vec3 triangle[3]) noexcept;

/// Two triangles. If they meet (exactly as triangles_intersect says) both points are the middle of the segment in which
/// they do. Some 200 ns.
[[nodiscard]] ClosestPoints closest_points(const Vec3 a[3], const Vec3 b[3]) noexcept;

}  // namespace odds::primitive
