// Our class against ODE's capsule: the places where its axis comes nearest to the surface, and its two ends.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "ode/collide/capsule_over_edge.hpp"
#include "ode/collide/capsule_places.hpp"
#include "ode/collide/contact_writer.hpp"
#include "ode/collide/convex_contacts.hpp"
#include "ode/collide/kept_contacts.hpp"
#include "ode/collide/manifold.hpp"
#include "ode/collide/nearest_in_time.hpp"
#include "ode/geom/colliders.hpp"
#include "ode/geom/geom_data.hpp"
#include "ode/mesh/triangle_corners.hpp"
#include "ode/statistics.hpp"

namespace odds::ode {
namespace {

constexpr double same_place = Capsule::same_place;
// The share of the time after which the way out of a solid that holds all of it is not looked for.
constexpr double time_for_nearest = 0.9;
// The share for the first of few contacts; after it, there is no time for more.
constexpr double time_for_few = 0.5;
// An end adds a contact only if it is this part of the radius away from those that are there.
constexpr double separate_end = 1e-2;
// Cosine from which on two contacts lead the same way.
constexpr double same_direction = 0.999;
// Cosine from which on a place beside an axis that goes through the surface belongs to the same patch.
constexpr double same_patch = 0.85;

struct CapsuleContact {
  Vec3 position;  // mesh frame
  Vec3 out;       // unit, the way of the capsule out of the mesh
  double depth;
  std::uint32_t triangle;
};

// Which of several looks this collision is to have.
struct Turn {
  std::uint32_t number = 0;
  bool others_are_known = false;  // what was found in others: it has been looked for before
};

struct CapsuleContacts {
  std::array<CapsuleContact, 2 * most_contacts> all;
  std::size_t count = 0;
  NearestToCapsule met;
  // Of each end: whether what is nearest to it is surely known, and whether something that touches it is.
  std::array<bool, 2> end_is_sure = {false, false};
  std::array<bool, 2> end_touches = {false, false};

  void add(const CapsuleContact& contact) noexcept {
    if (count < all.size() && contact.depth >= 0.0) all[count++] = contact;
  }
  [[nodiscard]] bool near(const Vec3& position, double distance) const noexcept {
    return std::any_of(all.begin(), all.begin() + count,
                       [&](const CapsuleContact& c) { return (c.position - position).norm() <= distance; });
  }
};

// Of those that lead the same way, in a line along the axis, the deepest and the outermost on each side of it are
// enough: more would take the places of those that push elsewhere.
struct Line {
  CapsuleContact* beside = nullptr;  // on the same side of the deepest, nearer to it
  bool needs = true;                 // the new one
};

Line line_of(const Capsule& capsule, const CapsuleContact& added, CapsuleContacts& contacts) noexcept {
  const std::span<CapsuleContact> all = std::span(contacts.all).first(contacts.count);
  const auto leads_the_same_way = [&](const CapsuleContact& c) { return c.out.dot(added.out) > same_direction; };
  const CapsuleContact* deepest = nullptr;
  for (const CapsuleContact& contact : all) {
    if (leads_the_same_way(contact) && (deepest == nullptr || contact.depth > deepest->depth)) deepest = &contact;
  }
  Line line;
  if (deepest == nullptr || added.depth > deepest->depth + same_place * capsule.radius) return line;
  const auto beyond = [&](const CapsuleContact& c) { return capsule.axes.col(2).dot(c.position - deepest->position); };
  const double along = beyond(added);
  for (CapsuleContact& contact : all) {
    if (!leads_the_same_way(contact) || &contact == deepest || (beyond(contact) < 0.0) != (along < 0.0)) continue;
    line.beside = &contact;
    line.needs = line.needs && std::abs(along) > std::abs(beyond(contact));
  }
  return line;
}

// Both ends against one plane through `on_surface`: the capsule lies across it, or is altogether behind it.
void add_ends_behind(const Capsule& capsule, const Vec3& on_surface, const Vec3& out, std::uint32_t triangle,
                     CapsuleContacts& contacts) noexcept {
  for (const Vec3& end : capsule.ends) {
    const double below = out.dot(on_surface - end);
    if (below + capsule.radius > 0.0) contacts.add({end + below * out, out, below + capsule.radius, triangle});
  }
}

// Both ends are outside, on different sides of an edge: the edge, and each end where its own side holds it.
void add_over_edge(const Capsule& capsule, const WayOverEdge& way, CapsuleContacts& contacts) noexcept {
  contacts.add({way.on_edge, way.out, way.depth + capsule.radius, way.in.place->triangle});
  const std::array<const WayOverEdge::Side*, 2> sides = {&way.in, &way.back};
  for (std::size_t end = 0; end < sides.size(); ++end) {
    const auto& [place, out] = *sides[end];
    const double below = out.dot(place->on_surface - capsule.ends[end]);
    const Vec3 on_surface = capsule.ends[end] + below * out;
    if (contacts.near(on_surface, separate_end * capsule.radius)) continue;
    contacts.add({on_surface, out, below + capsule.radius, place->triangle});
  }
}

// How far the capsule's axis must go along `out` to be clear of a plane through `on_surface`.
double depth_behind(const Capsule& capsule, const Vec3& on_surface, const Vec3& out) noexcept {
  return std::max(out.dot(on_surface - capsule.ends[0]), out.dot(on_surface - capsule.ends[1]));
}

// A capsule that lies across a solid would be left along its axis, by half its length. The way out at the surface
// nearest to the middle of a part within, if that takes less than `least`.
std::optional<NearestSurface> way_out_sideways(const PreparedMesh& mesh, const Capsule& capsule,
                                               const CapsulePlaces& places, double least, Limit& limit) noexcept {
  constexpr std::size_t most_crossings = 6;
  const Vec3 axis = capsule.ends[1] - capsule.ends[0];
  const double square = axis.squaredNorm();
  if (!(square > 0.0)) return std::nullopt;
  std::array<double, most_crossings + 2> at{0.0, 1.0};  // along the axis: its ends, and where it crosses the surface
  std::size_t count = 2;
  for (const CapsulePlace& place : places.span()) {
    if (place.distance > same_place * capsule.radius || count == at.size()) break;
    at[count++] = axis.dot(place.on_axis - capsule.ends[0]) / square;
  }
  std::sort(at.begin(), at.begin() + static_cast<std::ptrdiff_t>(count));
  std::optional<NearestSurface> best;
  for (std::size_t i = 1; i < count && !limit.time_is_up(); ++i) {
    if (!(at[i] - at[i - 1] > 1e-6)) continue;
    const Vec3 middle = capsule.ends[0] + 0.5 * (at[i - 1] + at[i]) * axis;
    if (!in_bounds(mesh, middle)) continue;
    bool finished = false;  // a longer way than the shortest leads out, too
    const auto nearest = nearest_in_time(mesh, middle, least, 1.0, Wanted::what_is_met, limit, finished);
    if (!nearest || !nearest->inside || nearest->outward == Vec3::Zero()) continue;
    const double depth = depth_behind(capsule, nearest->point, nearest->outward);
    if (!(depth < least)) continue;
    least = depth;
    best = nearest;
  }
  return best;
}

// The axis goes through the surface: of all crossings the one whose plane is left soonest tells the way out, or the
// edge that it cuts off. A sheet is left to the side of the capsule's middle.
std::optional<Vec3> add_crossing(const PreparedMesh& mesh, const Capsule& capsule, const CapsulePlaces& places,
                                 Limit& limit, CapsuleContacts& contacts) noexcept {
  const CapsulePlace* best = nullptr;
  Vec3 best_out = Vec3::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (const CapsulePlace& place : places.span()) {
    if (place.distance > same_place * capsule.radius) break;
    Vec3 out = unit_normal(mesh.corners(place.triangle));
    if (out == Vec3::Zero()) continue;
    if (!mesh.closed && out.dot(capsule.middle() - place.on_surface) < 0.0) out = -out;
    const double depth = depth_behind(capsule, place.on_surface, out);
    if (depth >= least) continue;
    least = depth;
    best = &place;
    best_out = out;
  }
  if (best == nullptr) return std::nullopt;
  std::optional<WayOverEdge> over_edge;
  if (mesh.closed && !places.cut_off) over_edge = way_over_edge(mesh, capsule, places);
  if (over_edge && !(over_edge->depth < least)) over_edge.reset();
  if (over_edge) least = over_edge->depth;
  if (mesh.closed && least > capsule.radius) {
    if (const auto sideways = way_out_sideways(mesh, capsule, places, least, limit)) {
      add_ends_behind(capsule, sideways->point, sideways->outward, sideways->triangle, contacts);
      return sideways->outward;
    }
  }
  if (over_edge) {
    add_over_edge(capsule, *over_edge, contacts);
    return over_edge->out;
  }
  add_ends_behind(capsule, best->on_surface, best_out, best->triangle, contacts);
  return best_out;
}

// The axis is outside: where its distance has a local minimum, of those places. `apart_from`: only what is not of that
// patch.
void add_minima(const PreparedMesh& mesh, const Capsule& capsule, const CapsulePlaces& places, std::size_t begin,
                std::size_t end, const std::optional<Vec3>& apart_from, const Limit& limit,
                CapsuleContacts& contacts) noexcept {
  for (std::size_t i = begin; i < end && contacts.count < contacts.all.size(); ++i) {
    const CapsulePlace& place = places.all[i];
    if (place.distance <= same_place * capsule.radius) continue;
    const Vec3 out = places.nearest_is_sure
                         ? Vec3((place.on_axis - place.on_surface) / place.distance)
                         : way_from_any(place.on_surface, unit_normal(mesh.corners(place.triangle)), place.on_axis);
    if (apart_from && out.dot(*apart_from) > same_patch) continue;
    // Where triangles were left out, a rim of one of them would pass for a minimum.
    if (contacts.count > 0 && (!places.complete || limit.time_is_up())) return;
    if (contacts.near(place.on_surface, separate_end * capsule.radius)) continue;
    const CapsuleContact contact = {place.on_surface, out, capsule.radius - place.distance, place.triangle};
    const Line line = line_of(capsule, contact, contacts);
    if (!line.needs) continue;
    if (contacts.count > 0 && !is_local_minimum(mesh, places, i, same_place * capsule.radius)) continue;
    // On an edge or at a corner several triangles are as near: none of them alone says on which side the axis is.
    if (apart_from && mesh.closed && out.dot(outward_at(mesh, place.on_surface, place.triangle, place.on_axis)) < 0.0) {
      continue;
    }
    if (line.beside != nullptr) {
      *line.beside = contact;
    } else {
      contacts.add(contact);
    }
  }
}

// An end as a ball, within that share of the time. A capsule that lies needs both, whichever is a little deeper.
void add_end_ball(const PreparedMesh& mesh, const Capsule& capsule, std::size_t which, double share, Limit& limit,
                  CapsuleContacts& contacts) noexcept {
  if (contacts.end_is_sure[which]) return;
  const Vec3& end = capsule.ends[which];
  bool finished = false;  // what is not the nearest place of an end is a place all the same
  const auto nearest = nearest_in_time(mesh, end, capsule.radius, share, Wanted::what_is_met, limit, finished,
                                       capsule.guess.to_end[which]);
  contacts.end_is_sure[which] = finished;
  if (nearest) contacts.met.to_end[which] = nearest->triangle;
  if (!nearest || nearest->inside || nearest->distance <= same_place * capsule.radius) return;
  contacts.end_touches[which] = true;
  if (contacts.near(nearest->point, separate_end * capsule.radius)) return;
  const Vec3 out =
      finished ? Vec3((end - nearest->point) / nearest->distance) : way_from_any(nearest->point, nearest->outward, end);
  contacts.add({nearest->point, out, capsule.radius - nearest->distance, nearest->triangle});
}

// An end against the triangle that was nearest to it when it was looked for last.
void add_known_end(const PreparedMesh& mesh, const Capsule& capsule, std::size_t which,
                   CapsuleContacts& contacts) noexcept {
  const std::uint32_t triangle = capsule.guess.to_end[which];
  if (triangle >= mesh.mesh().triangles().size()) return;
  const Vec3& end = capsule.ends[which];
  const Corners corners = mesh.corners(triangle);
  const Vec3 place = closest_point(corners, end);
  const Vec3 normal = unit_normal(corners);
  const double distance = (place - end).norm();
  const bool is_beside = distance > same_place * capsule.radius && distance < capsule.radius;
  if (!is_beside || (mesh.closed && !(normal.dot(end - place) > 0.0))) return;
  if (contacts.near(place, separate_end * capsule.radius)) return;
  contacts.add({place, way_from_any(place, normal, end), capsule.radius - distance, triangle});
}

// The part of the axis that is over a triangle, seen along its normal, in lengths of the axis from its first end.
struct Over {
  double first = 0.0;
  double last = 1.0;
};

Over over(const Corners& corners, const Vec3& normal, const Capsule& capsule) noexcept {
  const Vec3 axis = capsule.ends[1] - capsule.ends[0];
  Over part;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 inwards = normal.cross(corners[(i + 1) % 3] - corners[i]);
    const double at = inwards.dot(capsule.ends[0] - corners[i]);
    const double change = inwards.dot(axis);
    if (at < 0.0 && at + change < 0.0) return {1.0, 0.0};
    if (change > 0.0) part.first = std::max(part.first, -at / change);
    if (change < 0.0) part.last = std::min(part.last, -at / change);
  }
  return part;
}

// A capsule that lies on flat ground is as near to it all along, but for rounding, and any place is the nearest one. If
// the ground ends before one of its ends, it is held by the last place over the ground, too.
void add_last_over_ground(const PreparedMesh& mesh, const Capsule& capsule, const CapsulePlaces& places,
                          std::size_t which, const Limit& limit, CapsuleContacts& contacts) noexcept {
  constexpr double lies = 0.01;  // sine
  const CapsulePlace& nearest = places.all[0];
  const Vec3 out = (nearest.on_axis - nearest.on_surface) / nearest.distance;
  const Vec3 axis = capsule.ends[1] - capsule.ends[0];
  if (std::abs(axis.dot(out)) > lies * axis.norm()) return;
  CapsuleContact last = {nearest.on_surface, out, -1.0, nearest.triangle};
  double farthest = 0.0;  // from the other end
  for (const CapsulePlace& place : places.span()) {
    if (limit.time_is_up()) return;
    const Corners corners = mesh.corners(place.triangle);
    const Vec3 normal = unit_normal(corners);
    if (std::abs(normal.dot(out)) < same_direction) continue;
    const Over part = over(corners, normal, capsule);
    const double end = which == 0 ? 1.0 - part.first : part.last;
    if (part.first > part.last || end <= farthest) continue;
    farthest = end;
    const Vec3 on_axis = capsule.ends[1 - which] + end * (capsule.ends[which] - capsule.ends[1 - which]);
    const Vec3 up = normal.dot(out) < 0.0 ? Vec3(-normal) : normal;
    const double height = up.dot(on_axis - corners[0]);
    last = {on_axis - height * up, up, capsule.radius - height, place.triangle};
  }
  if (!contacts.near(last.position, separate_end * capsule.radius)) contacts.add(last);
}

// The surface at the first place, as it is seen from the axis. The nearest point of the surface to the axis is the
// nearest to that point of the axis, too, and its pseudo-normal tells the side.
// Nothing if that takes long.
std::optional<NearestSurface> seen_from_axis(const PreparedMesh& mesh, const CapsulePlaces& places,
                                             Limit& limit) noexcept {
  const CapsulePlace& place = places.all[0];
  if (!places.nearest_is_sure) {
    return surface_towards(mesh, place.on_axis, place.on_surface, place.triangle,
                           ray_to_tell_side(Wanted::what_is_met, limit));
  }
  const Vec3 outward = outward_at(mesh, place.on_surface, place.triangle, place.on_axis);
  return NearestSurface{place.on_surface, place.distance, place.triangle, outward,
                        outward.dot(place.on_axis - place.on_surface) < 0.0};
}

// No triangle crosses the axis: outside the mesh, or all of it inside.
void add_beside(const PreparedMesh& mesh, const Capsule& capsule, CapsulePlaces& places, Limit& limit,
                CapsuleContacts& contacts) noexcept {
  if (mesh.closed && places.count > 0) {
    const std::optional<NearestSurface> seen = seen_from_axis(mesh, places, limit);
    if (!seen) return;
    if (seen->inside) {
      add_ends_behind(capsule, seen->point, seen->outward, seen->triangle, contacts);
      return;
    }
  } else if (mesh.closed && in_bounds(mesh, capsule.middle())) {
    constexpr double anywhere = std::numeric_limits<double>::infinity();
    bool finished = false;
    const auto nearest =
        nearest_in_time(mesh, capsule.middle(), anywhere, time_for_nearest, Wanted::something, limit, finished);
    places.complete = places.complete && finished;
    places.cut_off = places.cut_off || !finished;
    if (!nearest) return;
    if (nearest->inside) {
      add_ends_behind(capsule, nearest->point, nearest->outward, nearest->triangle, contacts);
      return;
    }
  }
  // The nearest place and both ends hold it, if there is no time for more.
  add_minima(mesh, capsule, places, 0, std::min<std::size_t>(places.count, 1), std::nullopt, limit, contacts);
  for (std::size_t end = 0; end < capsule.ends.size(); ++end) {
    if (!limit.time_is_up()) {
      add_end_ball(mesh, capsule, end, 1.0, limit, contacts);
    } else if (!contacts.end_touches[end]) {
      add_known_end(mesh, capsule, end, contacts);
    }
  }
  for (std::size_t end = 0; end < capsule.ends.size() && places.complete && places.count > 0; ++end) {
    if (!contacts.end_touches[end]) add_last_over_ground(mesh, capsule, places, end, limit, contacts);
  }
  add_minima(mesh, capsule, places, 1, places.count, std::nullopt, limit, contacts);
}

void add_contacts(const PreparedMesh& mesh, const Capsule& capsule, CapsulePlaces& places, Limit& limit,
                  CapsuleContacts& contacts) noexcept {
  if (places.count > 0) contacts.met.to_axis = places.all[0].triangle;
  if (places.count == 0 || places.all[0].distance > same_place * capsule.radius) {
    return add_beside(mesh, capsule, places, limit, contacts);
  }
  contacts.count = 0;  // an end that was found before it was known that the axis goes through the surface
  const std::optional<Vec3> out = add_crossing(mesh, capsule, places, limit, contacts);
  add_minima(mesh, capsule, places, 0, places.count, out, limit, contacts);
}

// Where there is no time to look along the whole axis, each part has its turn: what was nearest so far is known.
PartOfAxis part_in_turn(std::uint32_t turn, const Limit& limit) noexcept {
  constexpr std::uint32_t parts = 3;
  constexpr std::uint64_t enough_nodes = 60;  // for an axis that lies on the ground
  if (limit.nodes_in_time(1.0) >= enough_nodes) return {};
  return {turn % parts, parts};
}

// Where there is hardly time for all. A capsule that lies is held by its nearest place and both ends: where there is
// time for one of them only, each has its turn, and what was nearest in others is known.
Seen find_few_contacts(const PreparedMesh& mesh, const Capsule& capsule, const Turn& turn, Limit& limit,
                       CapsuleContacts& found) noexcept {
  constexpr std::uint32_t turns = 3;
  const std::uint32_t own = turn.number % turns;
  CapsulePlaces places;
  if (own > 0) add_end_ball(mesh, capsule, own - 1, time_for_few, limit, found);
  const PartOfAxis part = turn.others_are_known ? part_in_turn(turn.number / turns, limit) : PartOfAxis{};
  find_nearest_place(mesh, capsule, part, limit, places);
  add_contacts(mesh, capsule, places, limit, found);
  return places.complete && limit.units > 0 ? Seen::all : Seen::cut_off;
}

Seen find_contacts(const PreparedMesh& mesh, const Capsule& capsule, const Turn& turn, Limit& limit,
                   CapsuleContacts& found) noexcept {
  const bool has_few = has_little_time(limit);
  if (has_few) {
    const Seen seen = find_few_contacts(mesh, capsule, turn, limit, found);
    if (seen == Seen::all || limit.time_is_up(time_for_few) || limit.units == 0) return seen;
  }
  CapsulePlaces places;
  find_places(mesh, capsule, limit, places);
  if (has_few && places.cut_off) return Seen::cut_off;
  found.count = 0;
  found.end_is_sure = found.end_touches = {false, false};  // they are to be added again
  add_contacts(mesh, capsule, places, limit, found);
  if (places.cut_off || limit.units == 0) return Seen::cut_off;
  return places.complete ? Seen::all : Seen::what_has_room;
}

// The deepest first, then always the one farthest from those before it.
void write(CapsuleContacts& contacts, const math::Pose& pose, ContactWriter& writer) noexcept {
  const auto deeper = [](const CapsuleContact& a, const CapsuleContact& b) { return a.depth > b.depth; };
  for (auto next = contacts.all.begin(); next != contacts.all.begin() + contacts.count; ++next) {
    std::rotate(std::upper_bound(contacts.all.begin(), next, *next, deeper), next, next + 1);
  }
  for (std::size_t done = 0; done < contacts.count && !writer.full(); ++done) {
    std::size_t next = done;
    double farthest = -1.0;
    for (std::size_t i = done; done > 0 && i < contacts.count; ++i) {
      double gap = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < done; ++k) {
        gap = std::min(gap, (contacts.all[i].position - contacts.all[k].position).norm());
      }
      if (gap > farthest) {
        farthest = gap;
        next = i;
      }
    }
    std::swap(contacts.all[done], contacts.all[next]);
    const CapsuleContact& contact = contacts.all[done];
    writer.add(pose * contact.position, -(pose.rotation * contact.out), contact.depth, contact.triangle,
               query::no_feature);
  }
}

NearestToCapsule met_last(const GeomData& data, dGeomID capsule) noexcept {
  std::array<std::uint32_t, LastPlaces::most> places;
  if (data.met.of(capsule, places) < 3) return {};
  return {places[0], {places[1], places[2]}};
}

}  // namespace

int collide_capsule(dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts, int skip) noexcept {
  count(statistics().primitive_queries);
  GeomData& data = own_data(o1);
  const PreparedMesh& mesh = *data.mesh;
  const std::optional<math::Pose> mesh_in_world = world_pose(o1);
  const std::optional<math::Pose> capsule_in_world = world_pose(o2);
  dReal radius = 0;
  dReal length = 0;
  dGeomCapsuleGetParams(o2, &radius, &length);
  if (!mesh_in_world || !capsule_in_world || !(radius < dInfinity) || !(length < dInfinity)) {
    count(statistics().bad_poses);
    return 0;
  }
  Limit limit(data, dCapsuleClass);
  const int room = room_for(flags, data.settings.max_contacts);
  const bool remembers = data.settings.carry_motion > 0.0;
  const math::Pose capsule_in_mesh = mesh_in_world->inverse() * *capsule_in_world;
  const Vec3 half_axis = 0.5 * length * capsule_in_mesh.rotation.col(2);
  const Capsule capsule = {{capsule_in_mesh.translation - half_axis, capsule_in_mesh.translation + half_axis},
                           radius,
                           capsule_in_mesh.rotation,
                           remembers ? met_last(data, o2) : NearestToCapsule()};
  const bool is_kept = remembers && data.settings.undecided_policy == ODDS_UNDECIDED_HIT;
  const RestingContacts::Question question{o2, dCapsuleClass, 0, Vec3(radius, radius, 0.5 * length), room};
  const double size = std::min(mesh.mesh().size(), length + 2.0 * radius);
  ContactWriter writer(o1, o2, room, contacts, skip);
  if (gives_only_held()) {
    return is_kept ? give_kept(*mesh_in_world, capsule_in_mesh, size, question, data.resting, writer) : 0;
  }
  CapsuleContacts found;
  found.met = capsule.guess;
  Turn turn;
  if (is_kept) {
    // Another one each time, also where nothing was found at this pose.
    const std::uint32_t looks = data.met.turn(o2);
    turn = looks > 0 ? Turn{looks, true} : Turn{data.resting.turn(question, capsule_in_mesh), false};
  }
  const Seen seen = find_contacts(mesh, capsule, turn, limit, found);
  if (remembers) data.met.note(o2, std::array{found.met.to_axis, found.met.to_end[0], found.met.to_end[1]});
  write(found, *mesh_in_world, writer);
  if (is_kept) {
    // Of a capsule that rolls what is kept lies behind it, and would drive it on: only what it met last is known, and
    // what is kept is given where nothing was found in time.
    const bool finished = writer.count() > 0 || (seen != Seen::cut_off && !limit.time_is_up());
    settle_contacts(*mesh_in_world, capsule_in_mesh, finished, size, question, data.resting, writer);
  }
  return limit.finish(seen == Seen::all, writer.count());
}

}  // namespace odds::ode
