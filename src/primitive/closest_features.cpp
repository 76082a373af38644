// All pairs of features of two small polygons, in coordinates that are near zero and near one in size.
#include "primitive/closest_features.hpp"

#include <algorithm>
#include <cmath>

namespace odds::primitive::detail {
namespace {

Vec3 closest_on_segment(const Vec3& x, const Vec3& p, const Vec3& q) noexcept {
  const Vec3 direction = q - p;
  const double length2 = direction.squaredNorm();
  if (!(length2 > 0.0)) return p;
  const double t = direction.dot(x - p) / length2;
  if (!(t > 0.0)) return p;
  if (t >= 1.0) return q;
  return p + t * direction;
}

// Keeps the closest pair seen.
struct Closest {
  ClosestPoints best{HUGE_VAL, Vec3::Zero(), Vec3::Zero()};

  void offer(const Vec3& on_a, const Vec3& on_b) noexcept {
    const double squared_distance = (on_a - on_b).squaredNorm();
    if (squared_distance < best.squared_distance) best = {squared_distance, on_a, on_b};
  }
};

// A corner against all edges and the face of a polygon; calls offer(point of polygon).
template <class Offer>
void corner_to_polygon(const Vec3& x, CornerSpan polygon, const Offer& offer) noexcept {
  const Vec3* corner = polygon.corner;
  if (polygon.count == 1) return offer(corner[0]);
  if (polygon.count == 2) return offer(closest_on_segment(x, corner[0], corner[1]));
  for (int i = 0; i < 3; ++i) offer(closest_on_segment(x, corner[i], corner[(i + 1) % 3]));
  const Vec3 u = corner[1] - corner[0];
  const Vec3 v = corner[2] - corner[0];
  const Vec3 normal = u.cross(v);
  const double normal2 = normal.squaredNorm();
  if (!(normal2 > 0.0)) return;
  const Vec3 w = x - corner[0];
  const double along_u = w.cross(v).dot(normal) / normal2;
  const double along_v = u.cross(w).dot(normal) / normal2;
  // Whatever rounding does to a sliver's normal, the point offered is one of the triangle's.
  if (along_u >= 0.0 && along_v >= 0.0 && along_u + along_v <= 1.0) offer(corner[0] + along_u * u + along_v * v);
}

// The pair of points inside both segments at which they pass; corners are left to corner_to_polygon. Dividing by the
// squared cross product keeps near-parallel segments accurate, where the usual a c - b^2 cancels.
void edge_to_edge(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s, Closest& closest) noexcept {
  const Vec3 u = q - p;
  const Vec3 v = s - r;
  const Vec3 normal = u.cross(v);
  const double normal2 = normal.squaredNorm();
  if (!(normal2 > 0.0)) return;
  const Vec3 w = r - p;
  const double along_u = w.cross(v).dot(normal) / normal2;
  const double along_v = w.cross(u).dot(normal) / normal2;
  if (along_u >= 0.0 && along_u <= 1.0 && along_v >= 0.0 && along_v <= 1.0) {
    closest.offer(p + along_u * u, r + along_v * v);
  }
}

int edges_of(CornerSpan polygon) noexcept { return polygon.count == 3 ? 3 : polygon.count - 1; }

ClosestPoints all_pairs(CornerSpan a, CornerSpan b) noexcept {
  Closest closest;
  for (int i = 0; i < a.count; ++i) {
    corner_to_polygon(a.corner[i], b, [&](const Vec3& on_b) { closest.offer(a.corner[i], on_b); });
  }
  for (int j = 0; j < b.count; ++j) {
    corner_to_polygon(b.corner[j], a, [&](const Vec3& on_a) { closest.offer(on_a, b.corner[j]); });
  }
  for (int i = 0; i < edges_of(a); ++i) {
    for (int j = 0; j < edges_of(b); ++j) {
      edge_to_edge(a.corner[i], a.corner[(i + 1) % a.count], b.corner[j], b.corner[(j + 1) % b.count], closest);
    }
  }
  return closest.best;
}

}  // namespace

ClosestPoints closest_features(CornerSpan a, CornerSpan b) noexcept {
  // Relative to a corner, far-away pairs lose nothing; scaled by a power of two, no fourth power leaves the doubles.
  const Vec3 origin = a.corner[0];
  Vec3 a_local[3];
  Vec3 b_local[3];
  double largest = 0.0;
  for (int i = 0; i < a.count; ++i) a_local[i] = a.corner[i] - origin;
  for (int i = 0; i < b.count; ++i) b_local[i] = b.corner[i] - origin;
  for (int i = 0; i < a.count; ++i) largest = std::max(largest, a_local[i].cwiseAbs().maxCoeff());
  for (int i = 0; i < b.count; ++i) largest = std::max(largest, b_local[i].cwiseAbs().maxCoeff());
  const bool scaled = largest > 0.0 && !(largest > 0x1p-150 && largest < 0x1p150);
  const int exponent = scaled ? std::ilogb(largest) : 0;
  if (scaled) {
    for (int i = 0; i < a.count; ++i)
      a_local[i] = a_local[i].unaryExpr([=](double x) { return std::ldexp(x, -exponent); });
    for (int i = 0; i < b.count; ++i)
      b_local[i] = b_local[i].unaryExpr([=](double x) { return std::ldexp(x, -exponent); });
  }
  ClosestPoints closest = all_pairs({a_local, a.count}, {b_local, b.count});
  if (scaled) {
    const auto back = [=](double x) { return std::ldexp(x, exponent); };
    closest.on_a = closest.on_a.unaryExpr(back);
    closest.on_b = closest.on_b.unaryExpr(back);
    closest.squared_distance = std::ldexp(closest.squared_distance, 2 * exponent);
  }
  closest.on_a += origin;
  closest.on_b += origin;
  return closest;
}

}  // namespace odds::primitive::detail
