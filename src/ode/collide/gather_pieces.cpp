#include "ode/collide/gather_pieces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "ode/collide/convex_patch.hpp"
#include "ode/mesh/triangle_corners.hpp"

namespace odds::ode {
namespace {

constexpr std::size_t octants = 8;
constexpr std::size_t each = Pieces::most / octants;
/// Cut whatever the time: without any a body falls through what it has just found.
constexpr std::size_t least_cut = octants;

/// Those of a tetrahedron first: any face of the body has two of them, opposite each other.
constexpr std::array<std::size_t, octants> in_order = {0, 3, 5, 6, 7, 4, 2, 1};

/// Triangles near the body that are still to be cut, in groups: all in one, or by octants of it.
struct Near {
  std::array<std::uint32_t, Pieces::most> triangles;
  std::size_t count = 0;
  std::array<std::span<const std::uint32_t>, 2 * octants + 1> groups;
  std::size_t group_count = 0;

  [[nodiscard]] std::span<std::uint32_t> room(std::size_t most) noexcept {
    return std::span(triangles).subspan(count, std::min(most, triangles.size() - count));
  }
  void add_group(std::size_t found) noexcept {
    groups[group_count++] = std::span(triangles).subspan(count, found);
    count += found;
  }
};

/// The half-spaces that bound a body, and a part of its box, in the mesh's frame.
class Sieve {
 public:
  Sieve(const ConvexBody& body, const math::Pose& body_in_mesh) noexcept
      : box_center_(body.box_center()), body_in_mesh_(body_in_mesh) {
    // Of many sides some will do: what they let pass is cut by all of them later.
    const std::span<const HalfSpace> sides = body.sides();
    const std::size_t step = (sides.size() + most_sides - 1) / most_sides;
    for (std::size_t i = 0; i < sides.size(); i += step) add(sides[i]);
    of_body_ = count_;
  }

  /// Only what is in this octant of the box around the body, too.
  void set_octant(std::size_t octant) noexcept {
    count_ = of_body_;
    for (int axis = 0; axis < 3; ++axis) {
      const double sign = (octant >> axis & 1U) != 0 ? 1.0 : -1.0;
      add({-sign * Vec3::Unit(axis), -sign * box_center_[axis]});
    }
  }
  [[nodiscard]] bool lets_pass(const Vec3& center, const Vec3& half) const noexcept {
    return std::none_of(sides_.begin(), sides_.begin() + count_, [&](const HalfSpace& side) {
      return side.normal.dot(center) - side.normal.cwiseAbs().dot(half) > side.offset;
    });
  }
  [[nodiscard]] bool lets_pass(const Corners& corners) const noexcept {
    return std::none_of(sides_.begin(), sides_.begin() + count_, [&](const HalfSpace& side) {
      const auto is_out = [&](const Vec3& corner) { return side.normal.dot(corner) > side.offset; };
      return is_out(corners[0]) && is_out(corners[1]) && is_out(corners[2]);
    });
  }

 private:
  static constexpr std::size_t most_sides = 64;
  void add(const HalfSpace& side) noexcept {
    const Vec3 normal = body_in_mesh_.rotation * side.normal;
    sides_[count_++] = {normal, side.offset + normal.dot(body_in_mesh_.translation)};
  }

  Vec3 box_center_;
  math::Pose body_in_mesh_;
  std::array<HalfSpace, most_sides + 3> sides_;
  std::size_t count_ = 0;
  std::size_t of_body_ = 0;
};

std::size_t octant_of(const Piece& piece, const Vec3& box_center) noexcept {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < piece.count; ++i) sum += piece.corners[i] - box_center;
  return (sum.x() > 0.0 ? 1U : 0U) + (sum.y() > 0.0 ? 2U : 0U) + (sum.z() > 0.0 ? 4U : 0U);
}

/// Adds the pieces in that octant, which the sieve is set to, but for so many of the first; at most `most`. False if
/// there are more, or `nodes` were visited before.
bool sift(const PreparedMesh& mesh, const Sieve& sieve, const ConvexBody& body, const math::Pose& mesh_in_body,
          std::size_t octant, std::size_t skipped, std::uint64_t nodes, std::size_t most, Limit& limit,
          Pieces& pieces) noexcept {
  // A cut takes as long as these: of a box's six sides as one.
  const std::uint64_t nodes_a_cut = 1 + body.sides().size() / 32;
  const bool takes_long = has_many_sides(body);
  const std::size_t end = pieces.count + most;
  std::uint64_t left = nodes;
  const auto near = [&](const Vec3& center, const Vec3& half) { return sieve.lets_pass(center, half); };
  const auto take = [&](std::uint32_t triangle) {
    Corners corners = mesh.corners(triangle);
    if (!sieve.lets_pass(corners)) return true;
    if (takes_long && limit.time_is_up(time_for_pieces)) return false;
    left -= std::min(left, nodes_a_cut);
    for (Vec3& corner : corners) corner = mesh_in_body * corner;
    Piece& piece = pieces.all[pieces.count];
    if (!cut_by_sides(corners, body, piece) || octant_of(piece, body.box_center()) != octant) return true;
    if (skipped > 0) {
      --skipped;
      return true;
    }
    if (pieces.count == end) return false;
    piece.triangle = triangle;
    ++pieces.count;
    return true;
  };
  const bool all = mesh.triangle_tree.all_near(near, take, left);
  limit.spend(nodes - left);
  return all;
}

/// What is in the octant's box, and perhaps in the body; found sooner.
std::size_t find_in_box(const PreparedMesh& mesh, const math::Pose& body_in_mesh, const ConvexBody& body,
                        std::size_t octant, Limit& limit, std::span<std::uint32_t> found) noexcept {
  const Vec3& half = body.box_half_extents();
  const Vec3 signs(octant & 1U ? 0.5 : -0.5, octant & 2U ? 0.5 : -0.5, octant & 4U ? 0.5 : -0.5);
  const Vec3 center = body_in_mesh * Vec3(body.box_center() + half.cwiseProduct(signs));
  std::uint64_t visited = 0;
  const std::size_t count = query::triangles_in_box(*mesh.shape, center, body_in_mesh.rotation, 0.5 * half, found,
                                                    limit.nodes_in_time(time_for_pieces), nullptr, &visited);
  limit.spend(visited);
  return count;
}

/// Octant by octant, each its share of the room; then what is left of it goes to those that need more. What lies beside
/// the body in its box takes no place of what is in the body.
void find_by_octants(const PreparedMesh& mesh, const math::Pose& body_in_mesh, const ConvexBody& body, Limit& limit,
                     Pieces& pieces, Near& near) noexcept {
  const math::Pose mesh_in_body = body_in_mesh.inverse();
  Sieve sieve(body, body_in_mesh);
  std::array<std::size_t, octants> hungry;
  std::size_t hungry_count = 0;
  constexpr std::uint64_t least_nodes = 64;  // down to some triangles
  std::size_t turns = octants;
  const auto find = [&](std::size_t octant, std::size_t skipped, std::size_t most) {
    const std::uint64_t nodes = std::max(least_nodes, limit.nodes_in_time(time_for_pieces) / turns--);
    sieve.set_octant(octant);
    const std::size_t room = std::min(most, Pieces::most - near.count - pieces.count);
    const std::size_t before = pieces.count;
    const bool all =
        sift(mesh, sieve, body, mesh_in_body, octant, skipped, std::min(limit.units, nodes), room, limit, pieces);
    pieces.cut_off = pieces.cut_off || (!all && pieces.count < before + room);
    if (!all && pieces.count == before && skipped == 0) {
      near.add_group(find_in_box(mesh, body_in_mesh, body, octant, limit, near.room(room)));
    }
    return all;
  };
  for (const std::size_t octant : in_order) {
    if (turns < octants && limit.time_is_up(time_for_pieces)) {
      pieces.cut_off = true;
      return;
    }
    if (!find(octant, 0, each)) hungry[hungry_count++] = octant;
  }
  if (pieces.cut_off) return;
  turns = std::max<std::size_t>(hungry_count, 1);
  pieces.complete = true;
  for (std::size_t i = 0; i < hungry_count && !pieces.cut_off; ++i) {
    const std::size_t share = (Pieces::most - near.count - pieces.count) / (hungry_count - i);
    pieces.complete = find(hungry[i], each, share) && pieces.complete;
  }
  pieces.complete = pieces.complete && !pieces.cut_off;
}

void find_near(const PreparedMesh& mesh, const math::Pose& body_in_mesh, const ConvexBody& body, Limit& limit,
               Pieces& pieces, Near& near) noexcept {
  std::uint64_t visited = 0;
  const std::size_t found = query::triangles_in_box(*mesh.shape, body_in_mesh * body.box_center(),
                                                    body_in_mesh.rotation, body.box_half_extents(), near.triangles,
                                                    limit.nodes_in_time(time_for_pieces), &pieces.complete, &visited);
  limit.spend(visited);
  // Nothing is left to look anew, or no time.
  if (pieces.complete || limit.units == 0 || limit.time_is_up(time_for_pieces)) {
    pieces.cut_off = !pieces.complete && found < near.triangles.size();
    return near.add_group(found);
  }
  find_by_octants(mesh, body_in_mesh, body, limit, pieces, near);
  if (pieces.cut_off && pieces.count + near.count == 0) near.add_group(found);
}

/// How far it is along a line to where it comes out of the triangle; negative if it does not.
double way_out(const Corners& corners, const Vec3& from, const Vec3& along, double tolerance) noexcept {
  constexpr double nowhere = -1.0;
  constexpr double least_facing = 0.05;  // cosine: as of the directions that lead out of a surface
  const Vec3 normal = unit_normal(corners);
  const double facing = normal.dot(along);
  if (!(facing > least_facing)) return nowhere;
  const double way = normal.dot(corners[0] - from) / facing;
  const Vec3 place = from + way * along;
  return (closest_point(corners, place) - place).norm() <= tolerance ? way : nowhere;
}

/// Where a line enters a box, not before 0; infinity if it misses it.
double entry(const Vec3& center, const Vec3& half, const Vec3& from, const Vec3& along, double tolerance) noexcept {
  double enter = 0.0;
  double leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double middle = center[axis] - from[axis];
    const double reach = half[axis] + tolerance;
    if (along[axis] == 0.0) {
      if (std::abs(middle) > reach) return std::numeric_limits<double>::infinity();
      continue;
    }
    const double one = (middle - reach) / along[axis];
    const double other = (middle + reach) / along[axis];
    enter = std::max(enter, std::min(one, other));
    leave = std::min(leave, std::max(one, other));
  }
  return enter <= leave ? enter : std::numeric_limits<double>::infinity();
}

}  // namespace

std::optional<Above> surface_above(const PreparedMesh& mesh, const math::Pose& body_in_mesh, const ConvexBody& body,
                                   const Vec3& point, const Vec3& up, double most, Limit& limit) noexcept {
  constexpr std::uint64_t most_units = 256;  // some ten microseconds: the search does not look at the clock
  constexpr std::uint64_t least_units = 64;  // from the root to a triangle and a few beside it
  constexpr double nothing = -std::numeric_limits<double>::infinity();
  const Vec3 from = body_in_mesh * point;
  const Vec3 along = body_in_mesh.rotation * up;
  const double tolerance = 1e-9 * body.box_half_extents().norm();
  const std::uint64_t given =
      std::min(limit.units, std::clamp(limit.nodes_in_time(time_for_exits), least_units, most_units));
  std::uint64_t left = given;
  const std::uint32_t triangle = mesh.triangle_tree.greatest(
      [&](std::uint32_t t) {
        const double way = way_out(mesh.corners(t), from, along, tolerance);
        return way > 0.0 && way <= most ? -way : nothing;
      },
      [&](const Vec3& center, const Vec3& half) { return -entry(center, half, from, along, tolerance); }, left);
  limit.units -= std::min(limit.units, given - left);
  if (triangle == no_item) return std::nullopt;
  return Above{triangle, way_out(mesh.corners(triangle), from, along, tolerance)};
}

bool add_piece_above(const PreparedMesh& mesh, const math::Pose& body_in_mesh, const ConvexBody& body, const Vec3& up,
                     double most, Limit& limit, Pieces& pieces) noexcept {
  const auto above = surface_above(mesh, body_in_mesh, body, body.farthest(-up), up, most, limit);
  if (!above || pieces.count == pieces.all.size()) return false;
  const auto end = pieces.all.begin() + static_cast<std::ptrdiff_t>(pieces.count);
  const auto is_it = [&](const Piece& piece) { return piece.triangle == above->triangle; };
  if (std::any_of(pieces.all.begin(), end, is_it)) return false;
  Corners corners = mesh.corners(above->triangle);
  const math::Pose mesh_in_body = body_in_mesh.inverse();
  for (Vec3& corner : corners) corner = mesh_in_body * corner;
  Piece& piece = pieces.all[pieces.count];
  piece.triangle = above->triangle;
  if (!cut_by_sides(corners, body, piece)) return false;
  ++pieces.count;
  return true;
}

void gather_pieces(const PreparedMesh& mesh, const math::Pose& body_in_mesh, const ConvexBody& body, Limit& limit,
                   Pieces& pieces) noexcept {
  Near near;
  find_near(mesh, body_in_mesh, body, limit, pieces, near);
  const math::Pose mesh_in_body = body_in_mesh.inverse();
  std::size_t rounds = 0;
  for (std::size_t i = 0; i < near.group_count; ++i) rounds = std::max(rounds, near.groups[i].size());
  std::size_t cut = 0;
  const bool takes_long = has_many_sides(body);
  for (std::size_t round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < near.group_count; ++i) {
      if (round >= near.groups[i].size()) continue;
      const bool may_end = cut++ >= least_cut || (takes_long && pieces.count > 0);
      if (may_end && limit.time_is_up(time_for_pieces)) {
        pieces.complete = false;
        pieces.cut_off = true;
        return;
      }
      const std::uint32_t triangle = near.groups[i][round];
      Corners corners = mesh.corners(triangle);
      for (Vec3& corner : corners) corner = mesh_in_body * corner;
      Piece& piece = pieces.all[pieces.count];
      piece.triangle = triangle;
      if (cut_by_sides(corners, body, piece)) ++pieces.count;
    }
  }
}

}  // namespace odds::ode
