// Cutting triangles by a box, and the box's way out of the pieces.
#include "ode/box_patch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ode/triangle_corners.hpp"

namespace odds::ode {
namespace {

// Directions that the surface faces at less than this (cosine) do not lead out of it.
constexpr double least_facing = 0.05;
// More edge directions than these add nothing but time in a patch of many triangles.
constexpr std::size_t most_edge_directions = 8;

// Keeps the part of the piece with sign * x[axis] <= limit (Sutherland and Hodgman 1974).
void cut(Piece& piece, int axis, double sign, double limit) noexcept {
  Piece kept;
  const auto face = static_cast<std::int8_t>(sign > 0 ? axis : axis + 3);
  for (std::size_t i = 0; i < piece.count; ++i) {
    const std::size_t next = (i + 1) % piece.count;
    const Vec3& a = piece.corners[i];
    const Vec3& b = piece.corners[next];
    const double above_a = sign * a[axis] - limit;
    const double above_b = sign * b[axis] - limit;
    const auto add = [&kept](const Vec3& corner, std::int8_t side) {
      if (kept.count == Piece::most_corners) return;
      kept.corners[kept.count] = corner;
      kept.side[kept.count++] = side;
    };
    const auto crossing = [&]() -> Vec3 {
      Vec3 point = a + (above_a / (above_a - above_b)) * (b - a);
      point[axis] = sign * limit;
      return point;
    };
    if (above_a <= 0.0) {
      add(a, piece.side[i]);
      if (above_b > 0.0) add(crossing(), face);
    } else if (above_b <= 0.0) {
      add(crossing(), piece.side[i]);
    }
  }
  piece.count = kept.count;
  piece.corners = kept.corners;
  piece.side = kept.side;
}

Vec3 outward_face(std::int8_t side) noexcept { return side < 3 ? Vec3(Vec3::Unit(side)) : Vec3(-Vec3::Unit(side - 3)); }

// How far the box must go along `direction` to be clear of the patch.
double depth_along(const Vec3& direction, std::span<const Piece* const> patch, const Vec3& half) noexcept {
  const double least_of_box = -direction.cwiseAbs().dot(half);
  double depth = 0.0;
  for (const Piece* piece : patch) {
    bool goes_on_ahead = false;
    for (std::size_t i = 0; i < piece->count; ++i) {
      depth = std::max(depth, direction.dot(piece->corners[i]) - least_of_box);
      const std::int8_t side = piece->side[i];
      goes_on_ahead = goes_on_ahead || (side >= 0 && outward_face(side).dot(direction) > 1e-9);
    }
    if (!goes_on_ahead) continue;
    const double facing = direction.dot(piece->normal);
    if (facing < least_facing) return std::numeric_limits<double>::infinity();
    const double below_plane = piece->normal.dot(piece->corners[0]) + piece->normal.cwiseAbs().dot(half);
    depth = std::max(depth, below_plane / facing);
  }
  return depth;
}

Vec3 mean_normal(std::span<const Piece* const> patch) noexcept {
  Vec3 sum = Vec3::Zero();
  for (const Piece* piece : patch) sum += piece->area * piece->normal;
  const double length = sum.norm();
  return length > 0.0 ? Vec3(sum / length) : patch.front()->normal;
}

}  // namespace

bool cut_by_box(const std::array<Vec3, 3>& triangle, const Vec3& half, Piece& piece) noexcept {
  piece.count = 3;
  for (std::size_t i = 0; i < 3; ++i) {
    piece.corners[i] = triangle[i];
    piece.side[i] = -1;
  }
  for (int axis = 0; axis < 3; ++axis) {
    cut(piece, axis, 1.0, half[axis]);
    cut(piece, axis, -1.0, half[axis]);
  }
  if (piece.count < 3) return false;
  piece.normal = unit_normal(triangle);
  Vec3 twice_area = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < piece.count; ++i) {
    twice_area += (piece.corners[i] - piece.corners[0]).cross(piece.corners[i + 1] - piece.corners[0]);
  }
  piece.area = 0.5 * twice_area.norm();
  return piece.area > 0.0 && piece.normal != Vec3::Zero();
}

Exit shortest_exit(std::span<const Piece* const> patch, const Vec3& half) noexcept {
  const Vec3 mean = mean_normal(patch);
  Exit best = {mean, std::numeric_limits<double>::infinity()};
  const auto consider = [&](const Vec3& direction) {
    if (direction.dot(mean) < least_facing) return;
    const double depth = depth_along(direction, patch, half);
    // A relative margin, so that among equal ways the first one considered wins whatever the rounding.
    if (depth < best.depth * (1.0 - 1e-6)) best = {direction, depth};
  };
  // The surface's own normals first: they win every tie.
  std::array<Vec3, most_edge_directions> tried;
  std::size_t tried_count = 0;
  for (const Piece* piece : patch) {
    const auto seen = [piece](const Vec3& normal) { return normal.dot(piece->normal) > 1.0 - 1e-9; };
    if (std::any_of(tried.begin(), tried.begin() + tried_count, seen)) continue;
    consider(piece->normal);
    if (tried_count < tried.size()) tried[tried_count++] = piece->normal;
  }
  for (int axis = 0; axis < 3; ++axis) {
    consider(Vec3::Unit(axis));
    consider(-Vec3::Unit(axis));
  }
  std::size_t edges = 0;
  for (const Piece* piece : patch) {
    for (std::size_t i = 0; i < piece->count && edges < most_edge_directions; ++i) {
      if (piece->side[i] >= 0) continue;
      ++edges;
      const Vec3 edge = piece->corners[(i + 1) % piece->count] - piece->corners[i];
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3 across = edge.cross(Vec3::Unit(axis));
        const double length = across.norm();
        if (!(length > 1e-6 * edge.norm())) continue;
        consider(across / (across.dot(mean) < 0.0 ? -length : length));
      }
    }
  }
  return best;
}

}  // namespace odds::ode
