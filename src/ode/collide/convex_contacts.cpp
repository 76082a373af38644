// The surface inside a convex body, grouped, and the points chosen.
#include "ode/collide/convex_contacts.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "ode/collide/convex_patch.hpp"
#include "ode/collide/gather_pieces.hpp"
#include "ode/collide/kept_contacts.hpp"
#include "ode/collide/manifold.hpp"
#include "ode/collide/manifold_points.hpp"
#include "ode/collide/nearest_in_time.hpp"
#include "ode/collide/points_over_features.hpp"
#include "ode/collide/surface_above.hpp"
#include "ode/geom/geom_data.hpp"
#include "ode/mesh/triangle_corners.hpp"
#include "ode/statistics.hpp"

namespace odds::ode {
namespace {

constexpr std::size_t most_pieces = Pieces::most + Pieces::most_added;
constexpr std::size_t most_patches = 6;
constexpr double same_patch = 0.85;       // cosine of the largest angle to a patch's first normal, 32 degrees
constexpr double same_direction = 0.999;  // patches that leave the same way are one manifold
constexpr double same_place = 1e-6;       // of the body's size
// What it takes to look for the surface over a body's lowest point.
constexpr double looking_us = 3.0;
// And for the lowest corners of a body with many sides in pieces, beside the pieces' own.
constexpr double for_features_us = 8.0;
constexpr double for_each_piece_us = 0.4;
// What it takes to choose eight contacts; among the fewer points that there is time for of a body with many sides.
constexpr double choosing_us = 4.0;
constexpr double choosing_of_few_us = 0.8;

constexpr std::size_t most_large_pieces = 16;

struct Patch {
  std::array<const Piece*, most_pieces> pieces;
  std::size_t count = 0;
  Exit exit;
  [[nodiscard]] std::span<const Piece* const> span() const noexcept { return {pieces.data(), count}; }
};

// Pieces, the largest first. They are too long to be moved about, or looked at again and again, themselves.
class BySize {
 public:
  explicit BySize(const Pieces& pieces) noexcept : count_(pieces.count) {
    struct Key {
      double area;
      std::uint32_t triangle;
      std::uint32_t index;
    };
    std::array<Key, most_pieces> keys;
    for (std::uint32_t i = 0; i < count_; ++i) keys[i] = {pieces.all[i].area, pieces.all[i].triangle, i};
    std::sort(keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(count_),
              [](const Key& a, const Key& b) { return a.area != b.area ? a.area > b.area : a.triangle < b.triangle; });
    for (std::size_t i = 0; i < count_; ++i) all_[i] = &pieces.all[keys[i].index];
  }
  [[nodiscard]] std::span<const Piece* const> span() const noexcept { return {all_.data(), count_}; }

 private:
  std::array<const Piece*, most_pieces> all_;
  std::size_t count_;
};

// Greedy: a piece joins the first patch whose leader's normal is close, or leads a new one.
std::size_t group(std::span<const Piece* const> pieces, std::array<Patch, most_patches>& patches) noexcept {
  std::size_t count = 0;
  for (const Piece* piece : pieces) {
    std::size_t into = count;
    double closest = same_patch;
    for (std::size_t k = 0; k < count; ++k) {
      const double cosine = patches[k].pieces[0]->normal.dot(piece->normal);
      if (cosine > closest || (count == most_patches && into == count)) {
        closest = std::max(closest, cosine);
        into = k;
      }
    }
    if (into == count) patches[count++].count = 0;
    patches[into].pieces[patches[into].count++] = piece;
  }
  return count;
}

bool is_flat(const Patch& patch) noexcept {
  return std::all_of(patch.pieces.begin(), patch.pieces.begin() + patch.count,
                     [&](const Piece* piece) { return piece->normal.dot(patch.pieces[0]->normal) > 1.0 - 1e-9; });
}

// False if the time is up: of a body with many sides, each corner takes long.
bool add_corners(const Piece& piece, const Vec3& direction, const ConvexBody& body, const Limit& limit,
                 ManifoldPoints& points) noexcept {
  for (std::size_t i = 0; i < piece.count; ++i) {
    const Vec3 corner = body.pull_in(piece.corners[i]);
    points.add(corner, body.way_through(corner, -direction), piece.triangle);
    if (has_many_sides(body) && limit.time_is_up()) return false;
  }
  return true;
}

void add_points(const Patch& patch, const Vec3& direction, const ConvexBody& body, bool ridges, const Limit& limit,
                ManifoldPoints& points) noexcept {
  Features features;
  const double takes_us = for_features_us + for_each_piece_us * static_cast<double>(patch.count);
  if (has_many_sides(body) && !limit.has_time_left(takes_us, time_for_points)) {
    features.add_corner(body.farthest(-direction));  // only the deepest, if it is below a face
    ridges = false;
  } else {
    body.add_features(direction, patch.exit.depth, features);
  }
  const EdgesAlong edges(features, direction, body.box_center().norm() + body.box_half_extents().norm());
  const std::span<const Piece* const> pieces = patch.span();
  bool is_late = false;
  std::array<double, Features::most> depths = {};
  for (std::size_t i = 0; i < pieces.size() && !is_late; ++i) {
    add_corners_below(*pieces[i], body, direction, features, points, depths);
    if (ridges) edges.add_crossings(*pieces[i], points);
    is_late = limit.time_is_up(time_for_points);
  }
  for (std::size_t i = 0; i < pieces.size() && !is_late; ++i) {
    if (!add_corners(*pieces[i], direction, body, limit, points)) return;
    is_late = limit.time_is_up(time_for_points);
  }
  if (!is_late) {
    const bool has_curved_edges = body.crowding() > 0.0;
    if (!has_curved_edges || !some_are_missed(body, direction, features, patch.exit.depth, depths)) return;
    // Of many pieces so small that their corners are near the body's edges only deeper places are worth their time.
    const double least = pieces.size() > most_large_pieces ? points.deepest() : 0.0;
    for (std::size_t i = 0; i < pieces.size() && !limit.time_is_up(0.9 * time_for_points); ++i) {
      add_curved_crossings(*pieces[i], body, direction, least, points);
    }
    return;
  }
  // Neighbours stand beside each other: a few from all over hold the body, the next ones on one side only.
  const std::size_t few = std::min<std::size_t>(8, pieces.size());
  for (std::size_t i = 0; i < few; ++i) {
    if (!add_corners(*pieces[i * pieces.size() / few], direction, body, limit, points)) return;
  }
}

// Tips that lean are under the surface beside the section that it makes through the body, at whose corners the body is
// shallow, or has no depth at all.
void add_leaning_tips(const PreparedMesh& mesh, const math::Pose& body_in_mesh, const ConvexBody& body,
                      const Exit& exit, Limit& limit, ManifoldPoints& points) noexcept {
  if (!body.may_lean() || !(exit.depth < dInfinity)) return;
  Features features;
  body.add_features(exit.direction, 0.5 * exit.depth, features);  // the lower half of what is below the surface
  const double same = same_place * body.box_half_extents().norm();
  std::size_t asked = 0;
  for (const Vec3& corner : std::span(features.corners).first(features.corner_count)) {
    if (limit.time_is_up(time_for_exits)) return;
    const auto is_over = [&](const ManifoldPoint& p) {
      return (p.position - corner).cross(exit.direction).squaredNorm() <= same * same;
    };
    if (std::any_of(points.all.begin(), points.all.begin() + points.count, is_over)) continue;
    if (asked++ == ManifoldPoints::most_tips) return;
    const double most = exit.depth * (1.0 + 1e-6);
    const auto above = surface_above(mesh, body_in_mesh, body, corner, exit.direction, most, limit);
    if (above) points.add(corner + above->way * exit.direction, above->way, above->triangle, points.all.size());
  }
}

// Patches whose exits lead the same way are one manifold; the room left is shared among the manifolds still to come.
void write_manifolds(const PreparedMesh& mesh, const math::Pose& body_in_mesh, std::span<Patch> patches,
                     const ConvexBody& body, const math::Pose& body_in_world, Limit& limit, ContactWriter& writer,
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
  // On flat surface corners say all; but where a sheet ends, no patch of its sides tells of it.
  const bool ridges = patches.size() > 1 || !is_flat(patches[0]) || body.crowding() > 0.0 || !mesh.closed;
  for (std::size_t i = 0; i < patches.size() && !writer.full(); ++i) {
    if (leader[i] != i) continue;
    if (writer.count() > 0 && limit.is_over()) break;  // the deepest manifold has to do
    ManifoldPoints points;
    points.normal = patches[i].exit.direction;
    for (std::size_t k = i; k < patches.size(); ++k) {
      if (leader[k] == i) add_points(patches[k], points.normal, body, ridges, limit, points);
    }
    add_leaning_tips(mesh, body_in_mesh, body, patches[i].exit, limit, points);
    // The time for choosing is the last one's: those before it may need no more than some contacts each.
    const bool is_last = manifolds == 1;
    const auto may_go_on = [&] { return is_last ? !limit.is_over() : !limit.time_is_up(); };
    points.keep_deep();
    points.keep_apart(body.crowding(), may_go_on);
    const std::size_t share = (static_cast<std::size_t>(room - writer.count()) + manifolds - 1) / manifolds;
    --manifolds;
    std::array<std::uint32_t, most_contacts> chosen;
    const std::size_t count =
        select_manifold(ManifoldSource(points), points.normal, same_place * body.box_half_extents().norm(),
                        std::span(chosen).first(std::min(share, most_contacts)), may_go_on);
    const Vec3 into_mesh = -(body_in_world.rotation * points.normal);
    for (std::size_t c = 0; c < count; ++c) {
      const ManifoldPoint& point = points.all[chosen[c]];
      writer.add(body_in_world * point.position, into_mesh, std::min(point.depth, patches[i].exit.depth),
                 point.triangle, query::no_feature);
    }
  }
}

Vec3 middle_of(const Piece& piece) noexcept {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < piece.count; ++i) sum += piece.corners[i];
  return sum / static_cast<double>(piece.count);
}

// Whether the middle of the leading piece of `a` is not in front of that of `b`.
bool lies_behind(const Patch& a, const Patch& b, double tolerance) noexcept {
  return !(b.pieces[0]->normal.dot(middle_of(*a.pieces[0]) - middle_of(*b.pieces[0])) > tolerance);
}

// Whether no patch's leading piece lies in front of another's: then they bound a convex corner or edge.
bool are_convex(std::span<const Patch> patches, double tolerance) noexcept {
  return std::all_of(patches.begin(), patches.end(), [&](const Patch& a) {
    return std::all_of(patches.begin(), patches.end(), [&](const Patch& b) { return lies_behind(b, a, tolerance); });
  });
}

// How a patch is left, far enough to leave another one, too.
Exit common_exit(const Patch& patch, const Patch& other, const ConvexBody& body) noexcept {
  Exit exit = patch.exit;
  const double lowest = -body.reach(-exit.direction);
  for (const Piece* piece : other.span()) {
    for (std::size_t i = 0; i < piece->count; ++i) {
      exit.depth = std::max(exit.depth, exit.direction.dot(piece->corners[i]) - lowest);
    }
  }
  return exit;
}

// The sides of a plate that goes through the body face away from each other: it cannot leave both ways, and goes the
// shorter. (The walls of a groove face each other, and both push.)
void leave_plates_one_way(std::span<Patch> patches, const ConvexBody& body, double tolerance) noexcept {
  for (std::size_t i = 1; i < patches.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      Patch& a = patches[i];
      Patch& b = patches[k];
      const bool opposed = a.exit.direction.dot(b.exit.direction) < -same_patch;
      if (!opposed || !lies_behind(a, b, tolerance) || !lies_behind(b, a, tolerance)) continue;
      const Exit by_a = common_exit(a, b, body);
      const Exit by_b = common_exit(b, a, body);
      a.exit = b.exit = by_a.depth < by_b.depth ? by_a : by_b;
    }
  }
}

// The exits of all patches: one and the same if the body lies on a convex edge or corner, or if a common way is no
// longer than the longest of their own; else each its own (it stands in a concave corner).
void find_exits(std::span<Patch> patches, std::span<const Piece* const> pieces, bool complete, const ConvexBody& body,
                const Limit& limit) noexcept {
  double longest = 0.0;
  for (Patch& patch : patches) {
    patch.exit = shortest_exit(patch.span(), body, !complete, limit);
    longest = std::max(longest, patch.exit.depth);
  }
  if (patches.size() == 1) return;
  const Exit common = shortest_exit(pieces, body, !complete, limit);
  const double tolerance = same_place * body.box_half_extents().norm();
  const bool is_common = common.depth <= longest * (1.0 + 1e-6) || are_convex(patches, tolerance);
  if (!is_common || !(common.depth < dInfinity)) return leave_plates_one_way(patches, body, tolerance);
  for (Patch& patch : patches) patch.exit = common;
}

// A body that lies across a solid would be left along its own length. Where that takes more than the body is thick, the
// way out at the surface nearest to the middle of what lies within is tried, too.
void leave_sideways(const PreparedMesh& mesh, const math::Pose& body_in_mesh, std::span<const Piece* const> pieces,
                    const ConvexBody& body, Limit& limit, std::span<Patch> patches) noexcept {
  double deepest = 0.0;
  for (const Patch& patch : patches) deepest = std::max(deepest, patch.exit.depth);
  if (!mesh.closed || !(deepest > 2.0 * body.box_half_extents().minCoeff()) || limit.time_is_up(time_for_exits)) return;
  Vec3 middle = Vec3::Zero();
  double area = 0.0;
  for (const Piece* piece : pieces) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 0; k < piece->count; ++k) sum += piece->corners[k];
    middle += piece->area / static_cast<double>(piece->count) * sum;
    area += piece->area;
  }
  middle = body_in_mesh * Vec3(middle / area);
  if (!in_bounds(mesh, middle)) return;
  bool finished = false;  // a longer way than the shortest leads out, too
  const auto nearest = nearest_in_time(mesh, middle, deepest, time_for_points, Wanted::what_is_met, limit, finished);
  if (!nearest || !nearest->inside || nearest->outward == Vec3::Zero()) return;
  const Vec3 out = body_in_mesh.rotation.transpose() * nearest->outward;
  const double depth = out.dot(body_in_mesh.inverse() * nearest->point) + body.reach(-out);
  for (Patch& patch : patches) {
    if (depth > 0.0 && depth < patch.exit.depth) patch.exit = {out, depth};
  }
}

// There was no room for all of the surface, and so perhaps for one side only of a plate that goes through the body: of
// two opposite ways the shorter at the surface nearest to its centre.
void leave_by_the_near_side(const PreparedMesh& mesh, const math::Pose& body_in_mesh, const ConvexBody& body,
                            Limit& limit, std::span<Patch> patches) noexcept {
  const auto is_long = [&](const Patch& p) { return p.exit.depth > body.box_half_extents().minCoeff(); };
  if (!mesh.closed || std::none_of(patches.begin(), patches.end(), is_long) || limit.time_is_up(time_for_exits)) return;
  const double size = body.box_half_extents().norm();
  bool finished = false;
  const auto nearest =
      nearest_in_time(mesh, body_in_mesh * body.center(), size, time_for_exits, Wanted::nothing, limit, finished);
  if (!nearest || nearest->outward == Vec3::Zero()) return;
  const Vec3 out = body_in_mesh.rotation.transpose() * nearest->outward;
  const Vec3 place = body_in_mesh.inverse() * nearest->point;
  const double depth = out.dot(place) + body.reach(-out);
  for (Patch& patch : patches) {
    const bool opposed = out.dot(patch.exit.direction) < -same_patch;
    const bool lies_behind = out.dot(middle_of(*patch.pieces[0]) - place) <= same_place * size;
    if (opposed && lies_behind && depth > 0.0 && depth < patch.exit.depth) patch.exit = {out, depth};
  }
}

// A collision that its limit ended may know nothing but a wall of what the body stands on, and along that wall's normal
// the body would go all of the solid's length. No way out is longer than that out of the box about the solid.
void leave_by_the_box(const PreparedMesh& mesh, const math::Pose& body_in_mesh, const ConvexBody& body,
                      std::span<Patch> patches) noexcept {
  const Vec3 center = body_in_mesh * body.box_center();
  const Vec3 half = body_in_mesh.rotation.cwiseAbs() * body.box_half_extents();
  const Vec3 up = mesh.mesh().upper() - (center - half);
  const Vec3 down = center + half - mesh.mesh().lower();
  Eigen::Index axis = 0;
  up.cwiseMin(down).minCoeff(&axis);
  const double sign = up[axis] <= down[axis] ? 1.0 : -1.0;
  const double side = sign > 0.0 ? mesh.mesh().upper()[axis] : -mesh.mesh().lower()[axis];
  const Vec3 out = sign * body_in_mesh.rotation.row(axis).transpose();
  const double depth = side - sign * body_in_mesh.translation[axis] + body.reach(-out);
  for (Patch& patch : patches) {
    if (depth > 0.0 && depth < patch.exit.depth) patch.exit = {out, depth};
  }
}

// No surface inside the body: it may still be swallowed by a closed mesh, and is pushed to the nearest surface. `late`:
// none was found in time. Then the surface over the body's lowest point is asked for, seen along the nearest one's
// normal: this takes no cutting. False if the limit ended the search for the nearest surface.
bool push_out(const PreparedMesh& mesh, const math::Pose& mesh_in_world, const math::Pose& body_in_mesh,
              const ConvexBody& body, bool late, Limit& limit, ContactWriter& writer) noexcept {
  const Vec3 center = body_in_mesh * body.center();
  const bool may_be_inside = mesh.closed && in_bounds(mesh, center);
  if (!may_be_inside && !late) return true;
  const double size = 2.0 * body.box_half_extents().norm();
  const double reach = may_be_inside ? std::numeric_limits<double>::infinity() : size;
  bool finished = false;
  const auto nearest = nearest_in_time(mesh, center, reach, time_for_points, Wanted::something, limit, finished);
  if (!nearest) return finished;
  const Vec3 outward = body_in_mesh.rotation.transpose() * nearest->outward;
  const Vec3 into_mesh = -(mesh_in_world.rotation * nearest->outward);
  if (nearest->inside) {
    const double below_center = body.reach(-outward) + outward.dot(body.center());
    writer.add(mesh_in_world * nearest->point, into_mesh, nearest->distance + below_center, nearest->triangle,
               query::no_feature);
  } else if (late && outward != Vec3::Zero()) {
    const Vec3 lowest = body.farthest(-outward);
    const double most = body.way_through(lowest, outward);
    const auto above = surface_above(mesh, body_in_mesh, body, lowest, outward, most, limit);
    if (!above) return finished;
    const Vec3 place = body_in_mesh * Vec3(lowest + above->way * outward);
    writer.add(mesh_in_world * place, into_mesh, above->way, above->triangle, query::no_feature);
  }
  return finished;
}

/// Whether a triangle of the mesh meets the body.
class Meets {
 public:
  Meets(const PreparedMesh& mesh, const math::Pose& body_in_mesh, const ConvexBody& body) noexcept
      : mesh_(mesh), mesh_in_body_(body_in_mesh.inverse()), body_(body) {}
  /// `motion` of the body, in the mesh's frame.
  [[nodiscard]] bool operator()(std::uint32_t triangle, const Vec3& motion = Vec3::Zero()) const noexcept {
    math::Pose mesh_in_body = mesh_in_body_;
    mesh_in_body.translation -= mesh_in_body.rotation * motion;
    Piece piece;
    return cut_triangle(mesh_, triangle, mesh_in_body, body_, all_sides, piece);
  }
  [[nodiscard]] HeldContacts::StillMeets still() noexcept {
    return {[](void* self, std::uint32_t triangle, const Vec3& motion) noexcept {
              return (*static_cast<Meets*>(self))(triangle, motion);
            },
            this};
  }

 private:
  const PreparedMesh& mesh_;
  math::Pose mesh_in_body_;
  const ConvexBody& body_;
};

// What is kept of bodies that rest; false if the contacts must be made.
bool write_resting(const Meets& meets, const math::Pose& mesh_in_world, const math::Pose& body_in_mesh,
                   const RestingContacts::Question& question, double motion, double size, RestingContacts& resting,
                   Limit& limit, ContactWriter& writer) noexcept {
  const auto meets_in_time = [&](std::uint32_t triangle) noexcept {
    if (limit.units == 0 || limit.time_is_up()) return false;
    --limit.units;
    return meets(triangle);
  };
  std::array<query::Contact, query::most_contacts> held;
  const std::size_t count = resting.write(question, body_in_mesh, motion, size, meets_in_time, held);
  write_kept(std::span(held).first(count), mesh_in_world, writer);
  return count > 0;
}

// Of pieces that were left out, the deepest are asked for: those over the lowest points of the body.
void add_deepest(const PreparedMesh& mesh, const math::Pose& body_in_mesh, const ConvexBody& body, Limit& limit,
                 Pieces& pieces, std::span<Patch> patches) noexcept {
  constexpr double deeper = 2.0;  // than the pieces that are known; farther up is another surface
  for (Patch& patch : patches) {
    const auto goes_the_same_way = [&](const Patch& p) { return p.exit.direction == patch.exit.direction; };
    const bool is_first = &*std::find_if(patches.begin(), patches.end(), goes_the_same_way) == &patch;
    if (!is_first || !(patch.exit.depth < dInfinity)) continue;
    if (limit.time_is_up(time_for_exits) || !limit.has_time_left(looking_us)) return;
    const double most = deeper * patch.exit.depth;
    if (!add_piece_above(mesh, body_in_mesh, body, patch.exit.direction, most, limit, pieces)) continue;
    patch.pieces[patch.count++] = &pieces.all[pieces.count - 1];
    std::swap(patch.pieces[0], patch.pieces[patch.count - 1]);  // there may not be room, or time, for the points of all
  }
}

}  // namespace

Seen write_convex_contacts(const PreparedMesh& mesh, const math::Pose& mesh_in_world, const math::Pose& body_in_world,
                           const ConvexBody& body, std::uint32_t turn, Limit& limit, ContactWriter& writer,
                           int room) noexcept {
  const math::Pose body_in_mesh = mesh_in_world.inverse() * body_in_world;
  Pieces pieces;
  gather_pieces(mesh, body_in_mesh, body, turn, limit, pieces);
  bool ways_are_known = true;
  if (pieces.count == 0) {
    if (!push_out(mesh, mesh_in_world, body_in_mesh, body, pieces.cut_off, limit, writer)) pieces.cut_off = true;
  } else {
    std::array<Patch, most_patches> patches;
    const BySize by_size(pieces);
    const std::size_t count = group(by_size.span(), patches);
    find_exits(std::span(patches).first(count), by_size.span(), pieces.complete, body, limit);
    ways_are_known = !limit.time_is_up(time_for_exits);
    leave_sideways(mesh, body_in_mesh, by_size.span(), body, limit, std::span(patches).first(count));
    if (!pieces.complete) {
      if (!pieces.nearest_first) {
        leave_by_the_near_side(mesh, body_in_mesh, body, limit, std::span(patches).first(count));
      }
      add_deepest(mesh, body_in_mesh, body, limit, pieces, std::span(patches).first(count));
    }
    if (mesh.closed && (pieces.cut_off || limit.time_is_up(time_for_exits))) {
      leave_by_the_box(mesh, body_in_mesh, body, std::span(patches).first(count));
    }
    write_manifolds(mesh, body_in_mesh, std::span(patches).first(count), body, body_in_world, limit, writer, room);
  }
  if (pieces.cut_off || !ways_are_known || limit.units == 0) return Seen::cut_off;
  return pieces.complete ? Seen::all : Seen::what_has_room;
}

int collide_convex_body(dGeomID mesh, dGeomID partner, const ConvexBody& body, int flags, dContactGeom* contacts,
                        int skip, std::optional<std::int64_t> begun_ns) noexcept {
  count(statistics().primitive_queries);
  GeomData& data = own_data(mesh);
  const std::optional<math::Pose> mesh_in_world = world_pose(mesh);
  const std::optional<math::Pose> body_in_world = world_pose(partner);
  if (!mesh_in_world || !body_in_world || !body.box_half_extents().allFinite()) {
    count(statistics().bad_poses);
    return 0;
  }
  Limit limit(data, dGeomGetClass(partner), has_many_sides(body) ? choosing_of_few_us : choosing_us, begun_ns);
  const int room = room_for(flags, data.settings.max_contacts);
  ContactWriter writer(mesh, partner, room, contacts, skip);
  const RestingContacts::Question question{partner, dGeomGetClass(partner), body.number(), body.box_half_extents(),
                                           room};
  const math::Pose body_in_mesh = mesh_in_world->inverse() * *body_in_world;
  const double size = std::min(data.mesh->mesh().size(), 2.0 * body.box_half_extents().norm());
  const double motion = data.settings.carry_motion * size;
  const bool holds = motion > 0.0 && data.settings.undecided_policy == ODDS_UNDECIDED_HIT;
  if (gives_only_held()) {
    return holds ? give_kept(*mesh_in_world, body_in_mesh, size, question, data.resting, writer) : 0;
  }
  Meets meets(*data.mesh, body_in_mesh, body);
  if (write_resting(meets, *mesh_in_world, body_in_mesh, question, motion, size, data.resting, limit, writer)) {
    return limit.finish_carried(writer.count());
  }
  const std::uint32_t turn = motion > 0.0 ? data.resting.turn(question, body_in_mesh) : 0;
  const Seen seen = write_convex_contacts(*data.mesh, *mesh_in_world, *body_in_world, body, turn, limit, writer, room);
  // Where only the choice of contacts was cut short, they are right, and some hold the body.
  constexpr int enough = 3;
  const bool finished = seen != Seen::cut_off && (writer.count() >= enough || !limit.time_is_up());
  if (holds || (finished && motion > 0.0)) {
    settle_contacts(*mesh_in_world, body_in_mesh, finished, size, question, data.resting, writer, meets.still());
  }
  return limit.finish(seen == Seen::all, writer.count());
}

}  // namespace odds::ode
