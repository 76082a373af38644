// Our class against ODE's box: the surface inside the box, in patches of similar normals, each with one direction.
#include <algorithm>
#include <array>
#include <limits>

#include "ode/box_patch.hpp"
#include "ode/colliders.hpp"
#include "ode/contact_writer.hpp"
#include "ode/limit.hpp"
#include "ode/manifold.hpp"
#include "ode/nearest_surface.hpp"
#include "ode/statistics.hpp"
#include "ode/triangle_corners.hpp"

namespace odds::ode {
namespace {

constexpr std::size_t most_pieces = 128;
constexpr std::size_t most_patches = 6;
constexpr std::size_t most_points = 256;
constexpr double same_patch = 0.85;       // cosine of the largest angle to a patch's first normal, 32 degrees
constexpr double least_depth = 1e-3;      // of the deepest point of a manifold
constexpr double same_direction = 0.999;  // patches that leave the same way are one manifold
constexpr double same_place = 1e-6;       // of the box's size

struct Pieces {
  std::array<Piece, most_pieces> all;
  std::size_t count = 0;
  bool complete = true;
};

struct Patch {
  std::array<const Piece*, most_pieces> pieces;
  std::size_t count = 0;
  Exit exit;
  [[nodiscard]] std::span<const Piece* const> span() const noexcept { return {pieces.data(), count}; }
};

struct Point {
  Vec3 position;  // on the surface, box frame
  double depth;   // metres inside the box, against the direction
  std::uint32_t triangle;
};

// The points of one manifold as a source for select_manifold; only those with a depth worth having.
struct Points {
  std::array<Point, most_points> all;
  std::size_t count = 0;
  Vec3 normal = Vec3::Zero();

  void add(const Vec3& position, double depth, std::uint32_t triangle) noexcept {
    if (count < most_points) all[count++] = {position, depth, triangle};
  }
  // Drops points that touch only: they would push where nothing overlaps, and hide deeper ones at the same place.
  void keep_deep() noexcept {
    double deepest = 0.0;
    for (std::size_t i = 0; i < count; ++i) deepest = std::max(deepest, all[i].depth);
    const auto shallow = [deepest](const Point& p) { return p.depth < least_depth * deepest; };
    count = static_cast<std::size_t>(std::remove_if(all.begin(), all.begin() + count, shallow) - all.begin());
  }
  [[nodiscard]] const Vec3& position(std::uint32_t i) const noexcept { return all[i].position; }
  template <class Value>
  [[nodiscard]] std::uint32_t greatest(const Value& value) const noexcept {
    std::uint32_t best = no_item;
    double best_value = -std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < count; ++i) {
      const double v = value(all[i]);
      if (v > best_value) {
        best_value = v;
        best = i;
      }
    }
    return best;
  }
  [[nodiscard]] std::uint32_t first() const noexcept {
    return greatest([](const Point& p) { return p.depth; });
  }
  [[nodiscard]] std::uint32_t farthest(const Vec3& from) const noexcept {
    return greatest([&](const Point& p) {
      const Vec3 d = p.position - from;
      return (d - d.dot(normal) * normal).squaredNorm();
    });
  }
  [[nodiscard]] std::uint32_t extreme(const Vec3& direction) const noexcept {
    return greatest([&](const Point& p) { return direction.dot(p.position); });
  }
};

// Cuts every triangle near the box. Many small ones are gathered octant by octant, so that those kept are spread
// evenly.
void gather(const PreparedMesh& mesh, const math::Pose& box_in_mesh, const Vec3& half, Limit& limit,
            Pieces& pieces) noexcept {
  std::array<std::uint32_t, most_pieces> near;
  const math::Pose mesh_in_box = box_in_mesh.inverse();
  const auto cut_all = [&](std::size_t count) {
    for (std::size_t i = 0; i < count && pieces.count < most_pieces; ++i) {
      if (limit.time_is_up()) {
        pieces.complete = false;
        return;
      }
      Corners corners = mesh.corners(near[i]);
      for (Vec3& corner : corners) corner = mesh_in_box * corner;
      Piece& piece = pieces.all[pieces.count];
      piece.triangle = near[i];
      if (cut_by_box(corners, half, piece)) ++pieces.count;
    }
  };
  const std::size_t found = query::triangles_in_box(*mesh.shape, box_in_mesh.translation, box_in_mesh.rotation, half,
                                                    near, limit.units, &pieces.complete);
  if (pieces.complete) return cut_all(found);
  for (int octant = 0; octant < 8; ++octant) {
    const Vec3 center = 0.5 * half.cwiseProduct(Vec3(octant & 1 ? 1 : -1, octant & 2 ? 1 : -1, octant & 4 ? 1 : -1));
    bool octant_complete = true;
    const std::size_t part =
        query::triangles_in_box(*mesh.shape, box_in_mesh * center, box_in_mesh.rotation, 0.5 * half,
                                std::span(near).first(most_pieces / 8), limit.units, &octant_complete);
    cut_all(part);
  }
}

// Greedy, largest piece first: a piece joins the first patch whose leader's normal is close, or leads a new one.
std::size_t group(Pieces& pieces, std::array<Patch, most_patches>& patches) noexcept {
  std::sort(pieces.all.begin(), pieces.all.begin() + pieces.count, [](const Piece& a, const Piece& b) {
    return a.area != b.area ? a.area > b.area : a.triangle < b.triangle;
  });
  std::size_t count = 0;
  for (std::size_t i = 0; i < pieces.count; ++i) {
    const Piece& piece = pieces.all[i];
    std::size_t into = count;
    double closest = same_patch;
    for (std::size_t k = 0; k < count; ++k) {
      const double cosine = patches[k].pieces[0]->normal.dot(piece.normal);
      if (cosine > closest || (count == most_patches && into == count)) {
        closest = std::max(closest, cosine);
        into = k;
      }
    }
    if (into == count) patches[count++].count = 0;
    patches[into].pieces[patches[into].count++] = &piece;
  }
  return count;
}

// The way through the box from an inner point against `direction`.
double depth_in_box(const Vec3& point, const Vec3& direction, const Vec3& half) noexcept {
  double depth = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double speed = -direction[axis];
    if (std::abs(speed) < 1e-12) continue;
    depth = std::min(depth, std::max(0.0, (half[axis] - (speed > 0 ? 1.0 : -1.0) * point[axis]) / std::abs(speed)));
  }
  return depth;
}

bool contains(const Piece& piece, const Vec3& point) noexcept {
  for (std::size_t i = 0; i < piece.count; ++i) {
    const Vec3 edge = piece.corners[(i + 1) % piece.count] - piece.corners[i];
    if (piece.normal.cross(edge).dot(point - piece.corners[i]) < -1e-12 * edge.squaredNorm()) return false;
  }
  return true;
}

// Box corners under the piece: where a corner dips through a face, no corner of the piece itself is deep.
void add_box_corners(const Piece& piece, const Vec3& direction, const Vec3& half, Points& points) noexcept {
  const double facing = piece.normal.dot(direction);
  if (!(facing > 1e-6)) return;
  for (int c = 0; c < 8; ++c) {
    const Vec3 corner = half.cwiseProduct(Vec3(c & 1 ? 1 : -1, c & 2 ? 1 : -1, c & 4 ? 1 : -1));
    const double depth = piece.normal.dot(piece.corners[0] - corner) / facing;
    const Vec3 above = corner + depth * direction;
    if (depth > 0.0 && contains(piece, above)) points.add(above, depth, piece.triangle);
  }
}

// Edges of the surface over edges of the box: the deepest place where a ridge lies across an edge.
void add_edge_crossings(const Piece& piece, const Vec3& direction, const Vec3& half, Points& points) noexcept {
  for (std::size_t i = 0; i < piece.count; ++i) {
    if (piece.side[i] >= 0) continue;
    const Vec3& begin = piece.corners[i];
    const Vec3 edge = piece.corners[(i + 1) % piece.count] - begin;
    for (int e = 0; e < 12; ++e) {
      const int axis = e / 4;
      Vec3 middle = half;
      middle[axis] = 0.0;
      middle[(axis + 1) % 3] *= (e & 1) != 0 ? 1.0 : -1.0;
      middle[(axis + 2) % 3] *= (e & 2) != 0 ? 1.0 : -1.0;
      // begin + s edge = middle + u axis + depth direction
      Mat3 system;
      system << edge, -Vec3(Vec3::Unit(axis)), -direction;
      const double determinant = system.determinant();
      if (!(std::abs(determinant) > 1e-9 * edge.norm())) continue;
      const Vec3 solution = system.inverse() * (middle - begin);
      const bool crosses = solution[0] >= 0.0 && solution[0] <= 1.0 && std::abs(solution[1]) <= half[axis];
      if (crosses && solution[2] > 0.0) points.add(begin + solution[0] * edge, solution[2], piece.triangle);
    }
  }
}

bool is_flat(const Patch& patch) noexcept {
  return std::all_of(patch.pieces.begin(), patch.pieces.begin() + patch.count,
                     [&](const Piece* piece) { return piece->normal.dot(patch.pieces[0]->normal) > 1.0 - 1e-9; });
}

void add_points(const Patch& patch, const Vec3& direction, const Vec3& half, bool ridges, Points& points) noexcept {
  for (const Piece* piece : patch.span()) {
    add_box_corners(*piece, direction, half, points);
    if (ridges) add_edge_crossings(*piece, direction, half, points);
  }
  for (const Piece* piece : patch.span()) {
    for (std::size_t i = 0; i < piece->count; ++i) {
      points.add(piece->corners[i], depth_in_box(piece->corners[i], direction, half), piece->triangle);
    }
  }
}

// Patches whose exits lead the same way are one manifold; the room left is shared among the manifolds still to come.
void write_manifolds(std::span<Patch> patches, const Vec3& half, const math::Pose& box_in_world, ContactWriter& writer,
                     int room) noexcept {
  std::sort(patches.begin(), patches.end(), [](const Patch& a, const Patch& b) { return a.exit.depth > b.exit.depth; });
  const auto same = [](const Patch& a, const Patch& b) {
    return a.exit.direction.dot(b.exit.direction) > same_direction;
  };
  std::array<std::size_t, most_patches> leader = {};  // the first patch that leaves the same way
  std::size_t manifolds = 0;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    while (leader[i] < i && !(leader[leader[i]] == leader[i] && same(patches[leader[i]], patches[i]))) ++leader[i];
    manifolds += leader[i] == i ? 1 : 0;
  }
  const bool ridges = patches.size() > 1 || !is_flat(patches[0]);
  for (std::size_t i = 0; i < patches.size() && !writer.full(); ++i) {
    if (leader[i] != i) continue;
    Points points;
    points.normal = patches[i].exit.direction;
    for (std::size_t k = i; k < patches.size(); ++k) {
      if (leader[k] == i) add_points(patches[k], points.normal, half, ridges, points);
    }
    points.keep_deep();
    const std::size_t share = (static_cast<std::size_t>(room - writer.count()) + manifolds - 1) / manifolds;
    --manifolds;
    std::array<std::uint32_t, most_contacts> chosen;
    const std::size_t count = select_manifold(points, points.normal, same_place * half.norm(),
                                              std::span(chosen).first(std::min(share, most_contacts)));
    const Vec3 into_mesh = -(box_in_world.rotation * points.normal);
    for (std::size_t c = 0; c < count; ++c) {
      const Point& point = points.all[chosen[c]];
      writer.add(box_in_world * point.position, into_mesh, std::min(point.depth, patches[i].exit.depth), point.triangle,
                 query::no_feature);
    }
  }
}

// Whether no patch's leading piece lies in front of another's: then they bound a convex corner or edge.
bool are_convex(std::span<const Patch> patches, double tolerance) noexcept {
  const auto middle = [](const Piece& piece) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < piece.count; ++i) sum += piece.corners[i];
    return Vec3(sum / static_cast<double>(piece.count));
  };
  for (const Patch& a : patches) {
    for (const Patch& b : patches) {
      if (a.pieces[0]->normal.dot(middle(*b.pieces[0]) - middle(*a.pieces[0])) > tolerance) return false;
    }
  }
  return true;
}

// The exits of all patches: one and the same if the box lies on a convex edge or corner, or if a common way is no
// longer than the longest of their own; else each its own (it stands in a concave corner).
void find_exits(std::span<Patch> patches, const Pieces& pieces, const Vec3& half) noexcept {
  double longest = 0.0;
  for (Patch& patch : patches) {
    patch.exit = shortest_exit(patch.span(), half);
    longest = std::max(longest, patch.exit.depth);
  }
  if (patches.size() == 1) return;
  std::array<const Piece*, most_pieces> everything;
  for (std::size_t i = 0; i < pieces.count; ++i) everything[i] = &pieces.all[i];
  const Exit common = shortest_exit({everything.data(), pieces.count}, half);
  const bool is_common = common.depth <= longest * (1.0 + 1e-6) || are_convex(patches, same_place * half.norm());
  if (!is_common || !(common.depth < dInfinity)) return;
  for (Patch& patch : patches) patch.exit = common;
}

// No surface inside the box: it may still be swallowed by a closed mesh, and is pushed to the nearest surface.
void push_out(const PreparedMesh& mesh, const math::Pose& mesh_in_world, const math::Pose& box_in_mesh,
              const Vec3& half, Limit& limit, ContactWriter& writer) noexcept {
  const Vec3& center = box_in_mesh.translation;
  if (!mesh.closed || !in_bounds(mesh, center)) return;
  const auto nearest = nearest_surface(mesh, center, std::numeric_limits<double>::infinity(), limit.units);
  if (!nearest || !nearest->inside) return;
  const double reach = (box_in_mesh.rotation.transpose() * nearest->outward).cwiseAbs().dot(half);
  writer.add(mesh_in_world * nearest->point, -(mesh_in_world.rotation * nearest->outward), nearest->distance + reach,
             nearest->triangle, query::no_feature);
}

}  // namespace

int collide_box(dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts, int skip) noexcept {
  count(statistics().primitive_queries);
  const GeomData& data = own_data(o1);
  const std::optional<math::Pose> mesh_in_world = world_pose(o1);
  const std::optional<math::Pose> box_in_world = world_pose(o2);
  dVector3 lengths;
  dGeomBoxGetLengths(o2, lengths);
  const Vec3 half = 0.5 * Vec3(lengths[0], lengths[1], lengths[2]);
  if (!mesh_in_world || !box_in_world || !half.allFinite()) {
    count(statistics().bad_poses);
    return 0;
  }
  Limit limit(data.settings);
  const math::Pose box_in_mesh = mesh_in_world->inverse() * *box_in_world;
  const int room = room_for(flags, data.settings.max_contacts);
  ContactWriter writer(o1, o2, room, contacts, skip);
  Pieces pieces;
  gather(*data.mesh, box_in_mesh, half, limit, pieces);
  if (pieces.count == 0) {
    push_out(*data.mesh, *mesh_in_world, box_in_mesh, half, limit, writer);
  } else {
    std::array<Patch, most_patches> patches;
    const std::size_t count = group(pieces, patches);
    find_exits(std::span(patches).first(count), pieces, half);
    write_manifolds(std::span(patches).first(count), half, *box_in_world, writer, room);
  }
  if (!pieces.complete || limit.units == 0) count(statistics().primitive_cut_off);
  return writer.count();
}

}  // namespace odds::ode
