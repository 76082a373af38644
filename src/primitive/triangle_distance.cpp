// Distances: an exact decision about meeting first, then the closest pair of features.
#include "odds/primitive/triangle_distance.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "odds/primitive/predicates.hpp"
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

enum class Meeting : std::uint8_t {
  no,
  within,   ///< at a point of the triangle's plane within it, and of the segment between its ends
  at_most,  ///< at a border or an end, or not at all
};

/// Exact, and soon known of most: a segment taken for a triangle without an area would have each sign told by exact
/// arithmetic.
Meeting meeting_of(const Vec3& begin, const Vec3& end, const Vec3 triangle[3]) noexcept {
  const int side_begin = orient3d(triangle[0], triangle[1], triangle[2], begin);
  const int side_end = orient3d(triangle[0], triangle[1], triangle[2], end);
  if (side_begin * side_end > 0) return Meeting::no;
  if (side_begin == 0 && side_end == 0) return Meeting::at_most;  // in one plane, or the triangle has none
  const int first = orient3d(begin, end, triangle[0], triangle[1]);
  const int second = orient3d(begin, end, triangle[1], triangle[2]);
  if (first * second < 0) return Meeting::no;
  const int third = orient3d(begin, end, triangle[2], triangle[0]);
  if (first * third < 0 || second * third < 0) return Meeting::no;
  const bool is_within = side_begin * side_end != 0 && first * second * third != 0;
  return is_within ? Meeting::within : Meeting::at_most;
}

/// Where a segment whose ends are on both sides of a triangle's plane crosses it; false if it does so at a small angle,
/// for then rounding moves the place along it.
bool find_crossing(const Vec3& begin, const Vec3& end, const Vec3 triangle[3], Vec3& place) noexcept {
  constexpr double least_slope = 1e-3;
  const Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  const Vec3 from = begin - triangle[0];
  const Vec3 to = end - triangle[0];
  const double above = std::abs(normal.dot(from));
  const double below = std::abs(normal.dot(to));
  place = begin + above / (above + below) * (end - begin);
  return above + below > least_slope * normal.norm() * std::max(from.norm(), to.norm());
}

}  // namespace

Vec3 closest_point_on_triangle(const Vec3& point, const Vec3 triangle[3]) noexcept {
  return detail::closest_features<1, 3>(&point, triangle).on_b;
}

ClosestPoints closest_points_segment_triangle(const Vec3& begin, const Vec3& end, const Vec3 triangle[3]) noexcept {
  const Meeting meeting = meeting_of(begin, end, triangle);
  Vec3 place;
  if (meeting == Meeting::within && find_crossing(begin, end, triangle, place)) return met_at(place);
  const Vec3 flat[3] = {begin, end, end};
  IntersectionSegment common;
  if (meeting != Meeting::no && intersection_segment(flat, triangle, common)) {
    return met_at(0.5 * common.begin + 0.5 * common.end);
  }
  return apart(detail::closest_features<2, 3>(flat, triangle));
}

ClosestPoints closest_points(const Vec3 a[3], const Vec3 b[3]) noexcept {
  IntersectionSegment common;
  if (intersection_segment(a, b, common)) return met_at(0.5 * common.begin + 0.5 * common.end);
  return apart(detail::closest_features<3, 3>(a, b));
}

}  // namespace odds::primitive
