// Segments in which triangles meet. The pair is known to intersect (the exact kernel decided that), so that rounding
// may only move the ends; it can never take the piece away.
#include "query/patch/rim.hpp"

#include <algorithm>
#include <cmath>

#include "odds/math/tolerances.hpp"

namespace odds::query::patch {
namespace {

using Corners = std::array<Vec3, 3>;

/// The one or two points in which the border of a triangle meets a plane, given its corners' heights above the plane.
struct Crossing {
  std::array<Vec3, 3> points;
  int count = 0;
};

Crossing cross_plane(const Corners& t, const std::array<double, 3>& height) noexcept {
  Crossing found;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if (height[i] == 0.0 && found.count < 3) found.points[static_cast<std::size_t>(found.count++)] = t[i];
    if ((height[i] < 0.0 && height[j] > 0.0) || (height[i] > 0.0 && height[j] < 0.0)) {
      if (found.count < 3) {
        const double share = height[i] / (height[i] - height[j]);
        found.points[static_cast<std::size_t>(found.count++)] = t[i] + share * (t[j] - t[i]);
      }
    }
  }
  if (found.count == 0) {  // rounding has moved a touching triangle off the plane: its nearest corner
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < 3; ++i) {
      if (std::abs(height[i]) < std::abs(height[nearest])) nearest = i;
    }
    found.points[0] = t[nearest];
    found.count = 1;
  }
  return found;
}

std::array<double, 3> heights_above(const Corners& t, const Vec3& normal, const Vec3& origin) noexcept {
  std::array<double, 3> height{};
  double size = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    height[i] = normal.dot(t[i] - origin);
    size = std::max(size, (t[i] - origin).cwiseAbs().maxCoeff());
  }
  for (double& h : height) {
    if (std::abs(h) <= tolerances::on_plane * size) h = 0.0;
  }
  return height;
}

/// The common part of two intervals of points along `direction`; a point if rounding has emptied it.
RimPiece common_piece(const Crossing& a, const Crossing& b, const Vec3& direction) noexcept {
  const auto ends = [&direction](const Crossing& c) {
    std::pair<Vec3, Vec3> low_high{c.points[0], c.points[0]};
    for (int i = 1; i < c.count; ++i) {
      const Vec3& p = c.points[static_cast<std::size_t>(i)];
      if (direction.dot(p - low_high.first) < 0.0) low_high.first = p;
      if (direction.dot(p - low_high.second) > 0.0) low_high.second = p;
    }
    return low_high;
  };
  const auto [a_low, a_high] = ends(a);
  const auto [b_low, b_high] = ends(b);
  RimPiece piece;
  piece.from = direction.dot(b_low - a_low) > 0.0 ? b_low : a_low;
  piece.to = direction.dot(b_high - a_high) < 0.0 ? b_high : a_high;
  if (direction.dot(piece.to - piece.from) < 0.0) piece.from = piece.to = piece.middle();
  piece.length = piece.along().norm();
  return piece;
}

/// Clips a convex polygon by the half-space normal . (x - origin) <= 0 (Sutherland and Hodgman 1974).
struct Polygon {
  std::array<Vec3, 9> points;
  std::size_t count = 0;
};

Polygon clip(const Polygon& polygon, const Vec3& normal, const Vec3& origin) noexcept {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const Vec3& p = polygon.points[i];
    const Vec3& q = polygon.points[(i + 1) % polygon.count];
    const double hp = normal.dot(p - origin);
    const double hq = normal.dot(q - origin);
    if (hp <= 0.0 && kept.count < 9) kept.points[kept.count++] = p;
    if (((hp < 0.0 && hq > 0.0) || (hp > 0.0 && hq < 0.0)) && kept.count < 9) {
      kept.points[kept.count++] = p + (hp / (hp - hq)) * (q - p);
    }
  }
  return kept;
}

/// The sides of the common polygon of two triangles in one plane, counter-clockwise about B's normal.
std::size_t coplanar_pieces(const PlacedPair& placed, std::uint32_t pair, std::span<RimPiece> pieces) noexcept {
  Polygon polygon;
  for (const Vec3& p : placed.b) polygon.points[polygon.count++] = p;
  for (std::size_t i = 0; i < 3 && polygon.count > 0; ++i) {
    const Vec3& from = placed.a[i];
    const Vec3 outwards = (placed.a[(i + 1) % 3] - from).cross(placed.normal_a);
    polygon = clip(polygon, outwards, from);
  }
  if (polygon.count == 0) return 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < polygon.count && count < pieces.size(); ++i) {
    pieces[count] = RimPiece{};
    pieces[count].from = polygon.points[i];
    pieces[count].to = polygon.points[(i + 1) % polygon.count];
    pieces[count].length = pieces[count].along().norm();
    pieces[count].pair = pair;
    ++count;
  }
  return count;
}

/// The longest side of a triangle without area.
std::pair<Vec3, Vec3> longest_side(const Corners& t) noexcept {
  std::size_t best = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if ((t[(i + 1) % 3] - t[i]).squaredNorm() > (t[(best + 1) % 3] - t[best]).squaredNorm()) best = i;
  }
  return {t[best], t[(best + 1) % 3]};
}

/// Where a line segment meets a plane that it is known to reach.
Vec3 meet_plane(const std::pair<Vec3, Vec3>& side, const Vec3& normal, const Vec3& origin) noexcept {
  const double from = normal.dot(side.first - origin);
  const double to = normal.dot(side.second - origin);
  if (from == to) return 0.5 * (side.first + side.second);
  return side.first + std::clamp(from / (from - to), 0.0, 1.0) * (side.second - side.first);
}

/// The point of the first segment nearest to the second (Ericson, Real-Time Collision Detection, 2005, section 5.1.9).
Vec3 nearest_on(const std::pair<Vec3, Vec3>& first, const std::pair<Vec3, Vec3>& second) noexcept {
  const Vec3 u = first.second - first.first;
  const Vec3 v = second.second - second.first;
  const Vec3 w = first.first - second.first;
  const double uu = u.squaredNorm();
  const double vv = v.squaredNorm();
  const double uv = u.dot(v);
  const double determinant = uu * vv - uv * uv;
  double s = 0.0;
  if (determinant > tolerances::degenerate_triangle * uu * vv) {
    s = std::clamp((uv * v.dot(w) - vv * u.dot(w)) / determinant, 0.0, 1.0);
  }
  double t = vv > 0.0 ? std::clamp((uv * s + v.dot(w)) / vv, 0.0, 1.0) : 0.0;
  if (uu > 0.0) s = std::clamp((uv * t - u.dot(w)) / uu, 0.0, 1.0);
  return first.first + s * u;
}

/// A common point of two triangles of which at least one has no area.
Vec3 degenerate_point(const PlacedPair& placed) noexcept {
  if (placed.normal_b != Vec3::Zero()) return meet_plane(longest_side(placed.a), placed.normal_b, placed.b[0]);
  if (placed.normal_a != Vec3::Zero()) return meet_plane(longest_side(placed.b), placed.normal_a, placed.a[0]);
  const auto a = longest_side(placed.a);
  const auto b = longest_side(placed.b);
  return 0.5 * (nearest_on(a, b) + nearest_on(b, a));
}

}  // namespace

std::size_t rim_pieces(const PlacedPair& placed, bool both_solid, std::uint32_t pair,
                       std::span<RimPiece, most_pieces_of_a_pair> pieces) noexcept {
  pieces[0] = RimPiece{};
  pieces[0].pair = pair;
  if (placed.normal_a == Vec3::Zero() || placed.normal_b == Vec3::Zero()) {
    pieces[0].from = pieces[0].to = degenerate_point(placed);
    return 1;
  }
  const Vec3 direction = placed.normal_b.cross(placed.normal_a);
  if (direction.norm() <= tolerances::parallel_planes) {
    if (both_solid && placed.normal_a.dot(placed.normal_b) > 0.0) return 0;
    const std::size_t count = coplanar_pieces(placed, pair, pieces);
    if (count == 0) pieces[0].from = pieces[0].to = degenerate_point(placed);  // they touch in a point
    return std::max<std::size_t>(count, 1);
  }
  const Crossing in_plane_b = cross_plane(placed.a, heights_above(placed.a, placed.normal_b, placed.b[0]));
  const Crossing in_plane_a = cross_plane(placed.b, heights_above(placed.b, placed.normal_a, placed.a[0]));
  pieces[0] = common_piece(in_plane_b, in_plane_a, direction);
  pieces[0].pair = pair;
  return 1;
}

}  // namespace odds::query::patch
