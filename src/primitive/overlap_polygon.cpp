// Rounded positions of common points; that there are some was decided before, exactly.
#include "primitive/overlap_polygon.hpp"

#include <cmath>

#include "odds/primitive/predicates.hpp"
#include "primitive/closest_features.hpp"
#include "primitive/simplex.hpp"

namespace odds::primitive::detail {
namespace {

// A triangle cut by three lines has at most six corners.
struct Polygon {
  Vec3 corner[9];
  int count = 0;
  void append(const Vec3& point) noexcept {
    if (count < 9) corner[count++] = point;
  }
};

// The part of a polygon on the left of the line p q, seen against `normal`.
Polygon clip(const Polygon& polygon, const Vec3& p, const Vec3& q, const Vec3& normal) noexcept {
  const Vec3 inward = normal.cross(q - p);
  Polygon inside;
  for (int i = 0; i < polygon.count; ++i) {
    const Vec3& current = polygon.corner[i];
    const Vec3& next = polygon.corner[(i + 1) % polygon.count];
    const double here = inward.dot(current - p);
    const double there = inward.dot(next - p);
    if (here >= 0.0) inside.append(current);
    if ((here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0)) {
      inside.append(current + (here / (here - there)) * (next - current));
    }
  }
  return inside;
}

IntersectionSegment longest_diagonal(const Polygon& polygon) noexcept {
  IntersectionSegment longest{polygon.corner[0], polygon.corner[0]};
  double length2 = 0.0;
  for (int i = 0; i < polygon.count; ++i) {
    for (int j = i + 1; j < polygon.count; ++j) {
      const double candidate = (polygon.corner[i] - polygon.corner[j]).squaredNorm();
      if (candidate > length2) {
        length2 = candidate;
        longest = {polygon.corner[i], polygon.corner[j]};
      }
    }
  }
  return longest;
}

// Where a segment that is not in the plane of a triangle crosses it.
bool crossing(const Simplex& triangle, const Simplex& thin, Vec3& point) noexcept {
  if (triangle.count != 3 || thin.count != 2) return false;
  const auto& [a, b, c] = triangle.corner;
  const auto& [p, q, unused] = thin.corner;
  if (orient3d(a, b, c, p) == 0 && orient3d(a, b, c, q) == 0) return false;
  point = edge_through_plane(p, q, a, b, c);
  return true;
}

}  // namespace

Vec3 edge_through_plane(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  if (orient3d(a, b, c, p) == 0) return p;
  if (orient3d(a, b, c, q) == 0) return q;
  const Vec3 normal = (b - a).cross(c - a);
  const double p_height = std::fabs(normal.dot(p - a));
  const double q_height = std::fabs(normal.dot(q - a));
  const double sum = p_height + q_height;
  const double fraction = sum > 0.0 ? p_height / sum : 0.5;
  return p + fraction * (q - p);
}

IntersectionSegment flat_overlap(const Vec3 a[3], const Vec3 b[3]) noexcept {
  const Simplex simple_a = simplex_of(a);
  const Simplex simple_b = simplex_of(b);
  if (simple_a.count == 3 && simple_b.count == 3) {
    const Vec3 normal = (b[1] - b[0]).cross(b[2] - b[0]).stableNormalized();
    Polygon common{{a[0], a[1], a[2]}, 3};
    for (int i = 0; i < 3; ++i) common = clip(common, b[i], b[(i + 1) % 3], normal);
    if (common.count > 0) return longest_diagonal(common);
  }
  Vec3 point;
  if (crossing(simple_a, simple_b, point) || crossing(simple_b, simple_a, point)) return {point, point};
  // They touch within rounding, or both lie in one plane and one has no area: the closest features are what they share.
  const ClosestPoints closest = closest_features<3, 3>(a, b);
  const Vec3 middle = 0.5 * closest.on_a + 0.5 * closest.on_b;
  return {middle, middle};
}

}  // namespace odds::primitive::detail
