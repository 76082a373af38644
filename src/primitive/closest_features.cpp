// All pairs of features of two small polygons, in coordinates that are near zero and near one in size.
#include "primitive/closest_features.hpp"

#include <algorithm>
#include <cmath>

namespace odds::primitive::detail {
namespace {

/// A polygon with what every comparison with it needs.
struct Side {
  const Vec3* corner;
  int count;
  int edges;
  Vec3 edge[3];
  double length2[3];
  Vec3 normal = Vec3::Zero();
  double normal2 = 0.0;

  explicit Side(CornerSpan polygon) noexcept
      : corner(polygon.corner), count(polygon.count), edges(count == 3 ? 3 : count - 1) {
    for (int i = 0; i < edges; ++i) {
      edge[i] = corner[(i + 1) % count] - corner[i];
      length2[i] = edge[i].squaredNorm();
    }
    if (count == 3) {
      normal = edge[0].cross(corner[2] - corner[0]);
      normal2 = normal.squaredNorm();
    }
  }
};

/// Keeps the closest pair seen.
struct Closest {
  ClosestPoints best{HUGE_VAL, Vec3::Zero(), Vec3::Zero()};

  void offer(const Vec3& on_a, const Vec3& on_b) noexcept {
    const double squared_distance = (on_a - on_b).squaredNorm();
    if (squared_distance < best.squared_distance) best = {squared_distance, on_a, on_b};
  }
};

// A corner against all edges and the face of a polygon; calls offer(point of polygon).
template <class Offer>
void corner_to_polygon(const Vec3& x, const Side& side, const Closest& closest, const Offer& offer) noexcept {
  if (side.count == 1) return offer(side.corner[0]);
  for (int i = 0; i < side.edges; ++i) {
    const Vec3& from = side.corner[i];
    const double along = side.edge[i].dot(x - from);
    if (!(along > 0.0)) {
      offer(from);
    } else if (along < side.length2[i]) {
      offer(from + (along / side.length2[i]) * side.edge[i]);
    } else if (side.count == 2) {  // a triangle's next edge begins there
      offer(side.corner[1]);
    }
  }
  if (!(side.normal2 > 0.0)) return;
  const Vec3 w = x - side.corner[0];
  const double height = side.normal.dot(w);
  if (height * height >= closest.best.squared_distance * side.normal2) return;
  const Vec3 v = -side.edge[2];
  const double along_u = w.cross(v).dot(side.normal) / side.normal2;
  const double along_v = side.edge[0].cross(w).dot(side.normal) / side.normal2;
  // Whatever rounding does to a sliver's normal, the point offered is one of the triangle's.
  if (along_u >= 0.0 && along_v >= 0.0 && along_u + along_v <= 1.0) {
    offer(side.corner[0] + along_u * side.edge[0] + along_v * v);
  }
}

// The pair of points inside both segments at which they pass; corners are left to corner_to_polygon. Dividing by the
// squared cross product keeps near-parallel segments accurate, where the usual a c - b^2 cancels.
void edge_to_edge(const Side& a, int i, const Side& b, int j, Closest& closest) noexcept {
  const Vec3& u = a.edge[i];
  const Vec3& v = b.edge[j];
  const Vec3 normal = u.cross(v);
  const double normal2 = normal.squaredNorm();
  if (!(normal2 > 0.0)) return;
  const Vec3 w = b.corner[j] - a.corner[i];
  const double height = w.dot(normal);
  if (height * height >= closest.best.squared_distance * normal2) return;  // so far apart are the lines
  const double along_u = w.cross(v).dot(normal);
  const double along_v = w.cross(u).dot(normal);
  if (along_u >= 0.0 && along_u <= normal2 && along_v >= 0.0 && along_v <= normal2) {
    closest.offer(a.corner[i] + (along_u / normal2) * u, b.corner[j] + (along_v / normal2) * v);
  }
}

ClosestPoints all_pairs(CornerSpan polygon_a, CornerSpan polygon_b) noexcept {
  const Side a(polygon_a);
  const Side b(polygon_b);
  Closest closest;
  for (int i = 0; i < a.count; ++i) {
    corner_to_polygon(a.corner[i], b, closest, [&](const Vec3& on_b) { closest.offer(a.corner[i], on_b); });
  }
  for (int j = 0; j < b.count; ++j) {
    corner_to_polygon(b.corner[j], a, closest, [&](const Vec3& on_a) { closest.offer(on_a, b.corner[j]); });
  }
  for (int i = 0; i < a.edges; ++i) {
    for (int j = 0; j < b.edges; ++j) edge_to_edge(a, i, b, j, closest);
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
