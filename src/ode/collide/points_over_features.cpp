// Corners and edges of a body under pieces of surface; those that are not near each other are told apart first.
#include "ode/collide/points_over_features.hpp"

#include <cmath>

#include "ode/collide/convex_patch.hpp"

namespace odds::ode {
namespace {

// A side of the body that leans over by no more than this (sine) cuts a piece off only a little before the point over a
// corner of that side: the surface goes on there.
constexpr double most_lean = 0.1;

// Whether a piece is over a corner of the body: seen along `direction` at `above`.
bool is_over(const Piece& piece, const ConvexBody& body, const Vec3& direction, const Vec3& above) noexcept {
  for (std::size_t i = 0; i < piece.count; ++i) {
    const std::int16_t side = piece.side[i];
    const bool is_cut = side != Piece::own_edge;
    if (is_cut && body.sides()[static_cast<std::size_t>(side)].normal.dot(direction) < most_lean) continue;
    const Vec3 edge = piece.corners[(i + 1) % piece.count] - piece.corners[i];
    if (piece.normal.cross(edge).dot(above - piece.corners[i]) < -1e-12 * edge.squaredNorm()) return false;
  }
  return true;
}

// A box around a piece, to which the points that it may contain come near.
struct Around {
  explicit Around(const Piece& piece) noexcept : lower(piece.corners[0]), upper(piece.corners[0]) {
    for (std::size_t i = 1; i < piece.count; ++i) {
      lower = lower.cwiseMin(piece.corners[i]);
      upper = upper.cwiseMax(piece.corners[i]);
    }
    const double little = 1e-6 * (upper - lower).maxCoeff();
    lower.array() -= little;
    upper.array() += little;
  }
  [[nodiscard]] bool has(const Vec3& point, double beside) const noexcept {
    return (point.array() >= lower.array() - beside).all() && (point.array() <= upper.array() + beside).all();
  }
  Vec3 lower;
  Vec3 upper;
};

}  // namespace

void add_corners_below(const Piece& piece, const ConvexBody& body, const Vec3& direction, const Features& features,
                       ManifoldPoints& points, std::array<double, Features::most>& depths) noexcept {
  const double facing = piece.normal.dot(direction);
  if (!(facing > 1e-6)) return;
  const Around around(piece);
  const bool may_lack_corners = piece.count == Piece::most_corners;
  for (std::size_t c = 0; c < features.corner_count; ++c) {
    const Vec3& corner = features.corners[c];
    const double depth = piece.normal.dot(piece.corners[0] - corner) / facing;
    if (!(depth > 0.0)) continue;
    const Vec3 above = corner + depth * direction;
    if (!(may_lack_corners || around.has(above, most_lean * depth)) || !is_over(piece, body, direction, above))
      continue;
    points.add(above, depth, piece.triangle);
    depths[c] = std::max(depths[c], depth);
  }
}

bool some_are_missed(const ConvexBody& body, const Vec3& direction, const Features& features, double depth,
                     const std::array<double, Features::most>& depths) noexcept {
  constexpr double nearly = 0.9;
  const double surface = depth - body.reach(-direction);
  for (std::size_t c = 0; c < features.corner_count; ++c) {
    if (depths[c] < nearly * (surface - direction.dot(features.corners[c]))) return true;
  }
  return false;
}

void add_curved_crossings(const Piece& piece, const ConvexBody& body, const Vec3& direction, double least,
                          ManifoldPoints& points) noexcept {
  const auto is_cut = [&](std::size_t i) { return piece.side[i % piece.count] != Piece::own_edge; };
  for (std::size_t i = 0; i < piece.count; ++i) {
    if (is_cut(i)) continue;
    const Vec3& begin = piece.corners[i];
    const Vec3 along = piece.corners[(i + 1) % piece.count] - begin;
    std::array<OverEdge, 2> over;
    const std::size_t count = body.over_curved_edge(begin, along, direction, over);
    for (const OverEdge& place : std::span(over).first(count)) {
      if (!(place.depth > least)) continue;
      // Where the body cut the edge off, the edge goes on, and may be over a side that leans.
      const double beyond = most_lean * place.depth / along.norm();
      const double first = is_cut(i + piece.count - 1) ? -beyond : 0.0;
      const double last = is_cut(i + 1) ? 1.0 + beyond : 1.0;
      if (place.at < first || place.at > last) continue;
      points.add(begin + place.at * along, place.depth, piece.triangle, points.all.size());
    }
  }
}

EdgesAlong::EdgesAlong(const Features& features, const Vec3& direction, double far) noexcept
    : edges_(std::span(features.edges).first(features.edge_count)), direction_(direction) {
  constexpr double rounding = 1e-12;
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const Vec3 side = edges_[e].along().cross(direction);
    const double length = side.norm();
    sides_[e] = {side, side.dot(edges_[e].begin), length, rounding * length * far};
  }
}

void EdgesAlong::add_crossings(const Piece& piece, ManifoldPoints& points) const noexcept {
  std::array<std::uint8_t, Features::most> near;
  std::size_t count = 0;
  const Ball ball(piece);
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const double beside = std::abs(sides_[e].of(ball.center));
    if (beside <= sides_[e].length * ball.radius + sides_[e].rounding) near[count++] = static_cast<std::uint8_t>(e);
  }
  for (std::size_t i = 0; i < piece.count && count > 0; ++i) {
    if (piece.side[i] != Piece::own_edge) continue;
    const Vec3& begin = piece.corners[i];
    const Vec3& end = piece.corners[(i + 1) % piece.count];
    for (const std::uint8_t e : std::span(near).first(count)) {
      if (!sides_[e].has_beside(begin, end)) add_crossing(begin, end - begin, edges_[e], piece.triangle, points);
    }
  }
}

void EdgesAlong::add_crossing(const Vec3& begin, const Vec3& edge, const Features::Edge& own, std::uint32_t triangle,
                              ManifoldPoints& points) const noexcept {
  const Vec3 along = own.along();
  // begin + s edge = own edge's begin + u along + depth direction
  Mat3 system;
  system << edge, -along, -direction_;
  const double determinant = system.determinant();
  if (!(std::abs(determinant) > 1e-9 * edge.norm() * along.norm())) return;
  const Vec3 solution = system.inverse() * (own.begin - begin);
  const bool crosses = solution[0] >= 0.0 && solution[0] <= 1.0 && solution[1] >= 0.0 && solution[1] <= 1.0;
  if (crosses && solution[2] > 0.0) points.add(begin + solution[0] * edge, solution[2], triangle);
}

}  // namespace odds::ode
