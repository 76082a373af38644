// Distances: an exact decision about meeting first, then the closest pair of features.
#include "odds/primitive/triangle_distance.hpp"

#include <algorithm>
#include <limits>

#include "odds/primitive/triangle_triangle.hpp"
#include "primitive/closest_features.hpp"
#include "primitive/simplex.hpp"

namespace odds::primitive {
namespace {

ClosestPoints met_at(const Vec3& point) noexcept { return {0.0, point, point}; }

// Zero is reserved for primitives that meet; a gap lost to rounding or underflow stays the smallest positive number.
ClosestPoints apart(ClosestPoints closest) noexcept {
  closest.squared_distance = std::max(closest.squared_distance, std::numeric_limits<double>::denorm_min());
  return closest;
}

}  // namespace

Vec3 closest_point_on_triangle(const Vec3& point, const Vec3 triangle[3]) noexcept {
  return detail::closest_features({&point, 1}, {triangle, 3}).on_b;
}

ClosestPoints closest_points_segment_triangle(const Vec3& begin, const Vec3& end, const Vec3 triangle[3]) noexcept {
  const Vec3 flat[3] = {begin, end, end};
  IntersectionSegment common;
  if (intersection_segment(flat, triangle, common)) return met_at(0.5 * common.begin + 0.5 * common.end);
  return apart(detail::closest_features({flat, 2}, {triangle, 3}));
}

ClosestPoints closest_points(const Vec3 a[3], const Vec3 b[3]) noexcept {
  IntersectionSegment common;
  if (intersection_segment(a, b, common)) return met_at(0.5 * common.begin + 0.5 * common.end);
  return apart(detail::closest_features({a, 3}, {b, 3}));
}

}  // namespace odds::primitive
