// Exact intersection of coplanar and degenerate triangles.
#include "primitive/simplex.hpp"

#include <algorithm>

#include "odds/primitive/predicates.hpp"

namespace odds::primitive::detail {
namespace {

// Along a line this order is the order of the points on it.
bool lexicographically_less(const Vec3& a, const Vec3& b) noexcept {
  if (a.x() != b.x()) return a.x() < b.x();
  if (a.y() != b.y()) return a.y() < b.y();
  return a.z() < b.z();
}

// True if all of `points` lie strictly on the side `side` of the line p q, seen along `axis`.
bool all_on_side(const Simplex& points, const Vec3& p, const Vec3& q, int side, int axis) noexcept {
  return std::all_of(points.begin(), points.end(),
                     [&](const Vec3& x) { return projected_orientation(p, q, x, axis) == side; });
}

// True if an edge of `a` separates it strictly from `b`, both in one plane.
bool edge_separates(const Simplex& a, const Simplex& b, int axis) noexcept {
  if (a.count == 1) return false;
  if (a.count == 2) {
    return all_on_side(b, a.corner[0], a.corner[1], 1, axis) || all_on_side(b, a.corner[0], a.corner[1], -1, axis);
  }
  const int outside = -projected_orientation(a.corner[0], a.corner[1], a.corner[2], axis);
  return all_on_side(b, a.corner[0], a.corner[1], outside, axis) ||
         all_on_side(b, a.corner[1], a.corner[2], outside, axis) ||
         all_on_side(b, a.corner[2], a.corner[0], outside, axis);
}

// Separating axis theorem in the plane: of two disjoint convex polygons, not all on one line, an edge separates.
bool coplanar_intersect(const Simplex& a, const Simplex& b, int axis) noexcept {
  return !edge_separates(a, b, axis) && !edge_separates(b, a, axis);
}

bool on_one_line_intersect(const Simplex& a, const Simplex& b) noexcept {
  const auto [a_first, a_last] = std::minmax_element(a.begin(), a.end(), lexicographically_less);
  const auto [b_first, b_last] = std::minmax_element(b.begin(), b.end(), lexicographically_less);
  return !lexicographically_less(*a_last, *b_first) && !lexicographically_less(*b_last, *a_first);
}

// Two segments or points.
bool thin_intersect(const Simplex& a, const Simplex& b) noexcept {
  const Vec3 corner[4] = {a.corner[0], a.corner[a.count - 1], b.corner[0], b.corner[b.count - 1]};
  if (orient3d(corner[0], corner[1], corner[2], corner[3]) != 0) return false;
  for (int left_out = 0; left_out < 4; ++left_out) {
    const Vec3& p = corner[(left_out + 1) % 4];
    const Vec3& q = corner[(left_out + 2) % 4];
    const Vec3& r = corner[(left_out + 3) % 4];
    if (!collinear(p, q, r)) return coplanar_intersect(a, b, projection_axis(p, q, r));
  }
  return on_one_line_intersect(a, b);
}

// A triangle with area, and a segment or point.
bool triangle_meets_thin(const Simplex& triangle, const Simplex& thin) noexcept {
  const auto& [a, b, c] = triangle.corner;
  const Vec3& p = thin.corner[0];
  const Vec3& q = thin.corner[thin.count - 1];
  const int side_p = orient3d(a, b, c, p);
  const int side_q = orient3d(a, b, c, q);
  if (side_p * side_q > 0) return false;
  if (side_p == 0 && side_q == 0) return coplanar_intersect(triangle, thin, projection_axis(a, b, c));
  // The line p q meets the plane in one point: inside if it passes all edges on one side.
  const int ab = orient3d(p, q, a, b);
  const int bc = orient3d(p, q, b, c);
  const int ca = orient3d(p, q, c, a);
  return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
}

}  // namespace

int projected_orientation(const Vec3& a, const Vec3& b, const Vec3& c, int axis) noexcept {
  const int u = axis == 2 ? 0 : axis + 1;
  const int v = axis == 0 ? 2 : axis - 1;
  return orient2d(a[u], a[v], b[u], b[v], c[u], c[v]);
}

int projection_axis(const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  int axis = 0;
  (b - a).cross(c - a).cwiseAbs().maxCoeff(&axis);  // a good guess keeps the filters of orient2d conclusive
  for (int tried = 0; tried < 2; ++tried, axis = (axis + 1) % 3) {
    if (projected_orientation(a, b, c, axis) != 0) return axis;
  }
  return axis;
}

Simplex simplex_of(const Vec3 triangle[3]) noexcept {
  if (!collinear(triangle[0], triangle[1], triangle[2])) return {{triangle[0], triangle[1], triangle[2]}, 3};
  const auto [first, last] = std::minmax_element(triangle, triangle + 3, lexicographically_less);
  if (*first == *last) return {{*first, *first, *first}, 1};
  return {{*first, *last, *last}, 2};
}

bool simplices_intersect(const Simplex& a, const Simplex& b) noexcept {
  if (a.count == 3 && b.count == 3) {
    return coplanar_intersect(a, b, projection_axis(a.corner[0], a.corner[1], a.corner[2]));
  }
  if (a.count == 3) return triangle_meets_thin(a, b);
  if (b.count == 3) return triangle_meets_thin(b, a);
  return thin_intersect(a, b);
}

}  // namespace odds::primitive::detail
