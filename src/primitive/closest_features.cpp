// All pairs of features of two small polygons, in coordinates that are near zero and near one in size.
#include "primitive/closest_features.hpp"

#include <algorithm>
#include <cmath>

#include "math/double_double.hpp"
#include "odds/math/exact.hpp"

namespace odds::primitive::detail {
namespace {

/// Directions at less than this sine: rounding turns their cross product, and what is reckoned with it.
constexpr double careful_sine = 0.01;
/// Sides at no more than this sine are nearer in between than at their ends by nothing but rounding.
constexpr double least_sine = 4e-16;
/// What is left of a way after it was reckoned with them errs by as much of itself: so often is it reckoned again.
constexpr int careful_steps = 3;

/// The vector (b - a) x (d - c), right to the last bits of its length also where its terms cancel.
Vec3 careful_cross(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) noexcept {
  const auto component = [&](int u, int v) {
    const auto first = [&](int axis) { return math::two_difference(b[axis], a[axis]); };
    const auto second = [&](int axis) { return math::two_difference(d[axis], c[axis]); };
    return math::difference(math::product(first(u), second(v)), math::product(first(v), second(u))).high;
  };
  return {component(1, 2), component(2, 0), component(0, 1)};
}

/// A polygon of so many corners with what every comparison with it needs.
template <int corners>
struct Side {
  static constexpr int count = corners;
  static constexpr int edges = corners == 3 ? 3 : corners - 1;
  const Vec3* corner;
  Vec3 edge[3];
  double length2[3];
  Vec3 normal = Vec3::Zero();
  double normal2 = 0.0;
  bool is_sliver = false;  ///< at its first corner

  explicit Side(const Vec3* polygon) noexcept : corner(polygon) {
    for (int i = 0; i < edges; ++i) {
      edge[i] = corner[(i + 1) % count] - corner[i];
      length2[i] = edge[i].squaredNorm();
    }
    if constexpr (count == 3) {
      normal = edge[0].cross(corner[2] - corner[0]);
      normal2 = normal.squaredNorm();
      is_sliver = normal2 < careful_sine * careful_sine * (length2[0] * length2[2]);
    }
  }
};

/// Keeps the closest pair seen.
struct Closest {
  ClosestPoints best{HUGE_VAL, Vec3::Zero(), Vec3::Zero()};
  bool along_edges = false;  ///< two are nearly parallel

  void offer(const Vec3& on_a, const Vec3& on_b) noexcept {
    const double squared_distance = (on_a - on_b).squaredNorm();
    if (squared_distance < best.squared_distance) best = {squared_distance, on_a, on_b};
  }
};

/// How far along a triangle's first edge and the one back to its last corner a point above it is, in their lengths.
struct Foot {
  double along_u = 0.0;
  double along_v = 0.0;

  /// Of the point first corner + w.
  [[nodiscard]] static Foot of(const Vec3& w, const Side<3>& side, const Vec3& normal, double normal2) noexcept {
    return {w.cross(-side.edge[2]).dot(normal) / normal2, side.edge[0].cross(w).dot(normal) / normal2};
  }
  // Whatever rounding does to a sliver's normal, the point offered is one of the triangle's.
  template <class Offer>
  void offer_if_within(const Side<3>& side, const Offer& offer) const noexcept {
    if (along_u >= 0.0 && along_v >= 0.0 && along_u + along_v <= 1.0) {
      offer(side.corner[0] + along_u * side.edge[0] + along_v * -side.edge[2]);
    }
  }
};

// A corner against all edges and the face of a polygon; calls offer(point of polygon).
template <int corners, class Offer>
void corner_to_polygon(const Vec3& x, const Side<corners>& side, const Closest& closest, const Offer& offer) noexcept {
  if constexpr (corners == 1) return offer(side.corner[0]);
  for (int i = 0; i < side.edges; ++i) {
    const Vec3& from = side.corner[i];
    const double along = side.edge[i].dot(x - from);
    if (!(along > 0.0)) {
      offer(from);
    } else if (along < side.length2[i]) {
      offer(from + (along / side.length2[i]) * side.edge[i]);
    } else if (corners == 2) {  // a triangle's next edge begins there
      offer(side.corner[1]);
    }
  }
  if constexpr (corners == 3) {
    if (!(side.normal2 > 0.0)) return;
    const Vec3 w = x - side.corner[0];
    const double height = side.normal.dot(w);
    if (height * height >= closest.best.squared_distance * side.normal2) return;
    Foot::of(w, side, side.normal, side.normal2).offer_if_within(side, offer);
  }
}

// The pair of points inside both segments at which they pass; corners are left to corner_to_polygon. Dividing by the
// squared cross product keeps near-parallel segments accurate, where the usual a c - b^2 cancels.
template <int corners_a, int corners_b>
void edge_to_edge(const Side<corners_a>& a, int i, const Side<corners_b>& b, int j, Closest& closest) noexcept {
  const Vec3& u = a.edge[i];
  const Vec3& v = b.edge[j];
  const Vec3 normal = u.cross(v);
  const double normal2 = normal.squaredNorm();
  if (!(normal2 > 0.0)) return;
  const double lengths2 = a.length2[i] * b.length2[j];
  closest.along_edges |=
      normal2 < careful_sine * careful_sine * lengths2 && normal2 > least_sine * least_sine * lengths2;
  const Vec3 w = b.corner[j] - a.corner[i];
  const double height = w.dot(normal);
  if (height * height >= closest.best.squared_distance * normal2) return;  // so far apart are the lines
  const double along_u = w.cross(v).dot(normal);
  const double along_v = w.cross(u).dot(normal);
  if (along_u >= 0.0 && along_u <= normal2 && along_v >= 0.0 && along_v <= normal2) {
    closest.offer(a.corner[i] + (along_u / normal2) * u, b.corner[j] + (along_v / normal2) * v);
  }
}

// Of x above the face of a sliver.
template <class Offer>
void corner_to_sliver(const Vec3& x, const Side<3>& side, const Offer& offer) noexcept {
  const Vec3 normal = careful_cross(side.corner[0], side.corner[1], side.corner[0], side.corner[2]);
  const double normal2 = normal.squaredNorm();
  if (!(normal2 > 0.0)) return;
  Foot foot;
  for (int step = 0; step <= careful_steps; ++step) {
    const Vec3 left = x - side.corner[0] - foot.along_u * side.edge[0] + foot.along_v * side.edge[2];
    const Foot farther = Foot::of(left, side, normal, normal2);
    foot.along_u += farther.along_u;
    foot.along_v += farther.along_v;
  }
  foot.offer_if_within(side, offer);
}

// Of edges, if they are nearly parallel.
template <int corners_a, int corners_b>
void edge_along_edge(const Side<corners_a>& a, int i, const Side<corners_b>& b, int j, Closest& closest) noexcept {
  const Vec3& u = a.edge[i];
  const Vec3& v = b.edge[j];
  const Vec3 rounded = u.cross(v);
  const double lengths2 = a.length2[i] * b.length2[j];
  const double sine2 = rounded.squaredNorm() / lengths2;
  if (!(sine2 > least_sine * least_sine && sine2 < careful_sine * careful_sine)) return;
  const Vec3 w = b.corner[j] - a.corner[i];
  constexpr double roundings = 32.0 * 0x1p-53;  // of what the height is a product of
  const double least = std::fabs(w.dot(rounded)) - roundings * std::sqrt(w.squaredNorm() * lengths2);
  if (least > 0.0 && least * least >= closest.best.squared_distance * rounded.squaredNorm()) return;
  const Vec3 normal = careful_cross(a.corner[i], a.corner[(i + 1) % a.count], b.corner[j], b.corner[(j + 1) % b.count]);
  const double normal2 = normal.squaredNorm();
  if (!(normal2 > 0.0)) return;
  double along_u = 0.0;
  double along_v = 0.0;
  for (int step = 0; step <= careful_steps; ++step) {
    const Vec3 left = w + along_v * v - along_u * u;
    along_u += left.cross(v).dot(normal) / normal2;
    along_v += left.cross(u).dot(normal) / normal2;
  }
  if (along_u >= 0.0 && along_u <= 1.0 && along_v >= 0.0 && along_v <= 1.0) {
    closest.offer(a.corner[i] + along_u * u, b.corner[j] + along_v * v);
  }
}

// What rounding may have hidden: above the faces of slivers, and along edges that are nearly parallel.
template <int corners_a, int corners_b>
[[gnu::noinline]] void look_carefully(const Side<corners_a>& a, const Side<corners_b>& b, Closest& closest) noexcept {
  if constexpr (corners_b == 3) {
    for (int i = 0; i < a.count && b.is_sliver; ++i) {
      corner_to_sliver(a.corner[i], b, [&](const Vec3& on_b) { closest.offer(a.corner[i], on_b); });
    }
  }
  if constexpr (corners_a == 3) {
    for (int j = 0; j < b.count && a.is_sliver; ++j) {
      corner_to_sliver(b.corner[j], a, [&](const Vec3& on_a) { closest.offer(on_a, b.corner[j]); });
    }
  }
  for (int i = 0; i < a.edges; ++i) {
    for (int j = 0; j < b.edges; ++j) edge_along_edge(a, i, b, j, closest);
  }
}

template <int corners_a, int corners_b>
ClosestPoints all_pairs(const Vec3* polygon_a, const Vec3* polygon_b) noexcept {
  const Side<corners_a> a(polygon_a);
  const Side<corners_b> b(polygon_b);
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
  if (a.is_sliver || b.is_sliver || closest.along_edges) [[unlikely]]
    look_carefully(a, b, closest);
  return closest.best;
}

}  // namespace

template <int corners_a, int corners_b>
ClosestPoints closest_features(const Vec3* a, const Vec3* b) noexcept {
  // Relative to a corner, far-away pairs lose nothing; scaled by a power of two, no fourth power leaves the doubles.
  const Vec3 origin = a[0];
  Vec3 a_local[corners_a];
  Vec3 b_local[corners_b];
  double largest = 0.0;
  for (int i = 0; i < corners_a; ++i) a_local[i] = a[i] - origin;
  for (int i = 0; i < corners_b; ++i) b_local[i] = b[i] - origin;
  for (int i = 0; i < corners_a; ++i) largest = std::max(largest, a_local[i].cwiseAbs().maxCoeff());
  for (int i = 0; i < corners_b; ++i) largest = std::max(largest, b_local[i].cwiseAbs().maxCoeff());
  const bool scaled = largest > 0.0 && !(largest > 0x1p-150 && largest < 0x1p150);
  const int exponent = scaled ? std::ilogb(largest) : 0;
  if (scaled) {
    for (int i = 0; i < corners_a; ++i)
      a_local[i] = a_local[i].unaryExpr([=](double x) { return std::ldexp(x, -exponent); });
    for (int i = 0; i < corners_b; ++i)
      b_local[i] = b_local[i].unaryExpr([=](double x) { return std::ldexp(x, -exponent); });
  }
  ClosestPoints closest = all_pairs<corners_a, corners_b>(a_local, b_local);
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

template ClosestPoints closest_features<1, 3>(const Vec3*, const Vec3*) noexcept;
template ClosestPoints closest_features<2, 3>(const Vec3*, const Vec3*) noexcept;
template ClosestPoints closest_features<3, 3>(const Vec3*, const Vec3*) noexcept;

}  // namespace odds::primitive::detail
