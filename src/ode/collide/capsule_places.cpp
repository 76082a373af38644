// Closest points of a segment and the triangles near it.
#include "ode/collide/capsule_places.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "ode/mesh/triangle_corners.hpp"
#include "query/ray/crossings.hpp"
#include "query/shape/near_segment.hpp"

namespace odds::ode {
namespace {

// Where more triangles are near than there is room for, so many that the axis goes through are enough.
constexpr std::size_t most_crossings = CapsulePlaces::most / 2;
// The share of the time after which places are no longer looked for, and after which the nearest is not, whose side is
// then to be told.
constexpr double time_for_places = 0.6;
constexpr double time_for_nearest_place = 0.8;

CapsulePlace place_of(const PreparedMesh& mesh, const Capsule& capsule, std::uint32_t triangle) noexcept {
  const Corners corners = mesh.corners(triangle);
  const primitive::ClosestPoints closest =
      primitive::closest_points_segment_triangle(capsule.ends[0], capsule.ends[1], corners.data());
  double square = 0.0;
  for (const Vec3& corner : corners) square = std::max(square, (corner - closest.on_b).squaredNorm());
  return {closest.on_a, closest.on_b, std::sqrt(closest.squared_distance), std::sqrt(square), triangle};
}

// The place of the nearest triangle, of those that are nearer than `within`; if the limit is reached first, of the
// nearest of those seen, the guess among them.
std::optional<CapsulePlace> find_nearest(const PreparedMesh& mesh, const Capsule& capsule,
                                         const query::NearSegment& axis, double within, Limit& limit,
                                         bool& finished) noexcept {
  // Along one that lies on flat ground all are as near as each other, but for rounding.
  constexpr double not_nearer = 1e-12;
  std::optional<CapsulePlace> nearest;
  bool passed_over = false;
  const auto distance = [&](std::uint32_t t) {
    // A leaf's triangles take as long as all that is above it.
    passed_over = passed_over || (nearest && limit.time_is_up(time_for_nearest_place));
    if (passed_over) return std::numeric_limits<double>::infinity();
    const CapsulePlace place = place_of(mesh, capsule, t);
    if (place.distance < (nearest ? nearest->distance : within)) nearest = place;
    return place.distance;
  };
  if (capsule.guess.to_axis < mesh.mesh().triangles().size()) {
    within = std::min(within, distance(capsule.guess.to_axis));
  }
  const std::uint64_t nodes = limit.nodes_left();
  std::uint64_t left = nodes;
  static_cast<void>(axis.nearest(
      within, axis.margin() + not_nearer * capsule.radius, distance,
      [&] { return !limit.time_is_up(time_for_nearest_place); }, left, finished));
  finished = finished && !passed_over;
  limit.spend(nodes - left);
  return nearest;
}

// All triangles within the radius, the nearest nodes first: the box around a capsule has many that are farther. False
// if there is no room for them, or no time.
bool add_all_within(const PreparedMesh& mesh, const Capsule& capsule, const query::NearSegment& axis, Limit& limit,
                    CapsulePlaces& places) noexcept {
  bool full = false;
  const auto take = [&](std::uint32_t t) {
    const CapsulePlace place = place_of(mesh, capsule, t);
    if (!(place.distance < capsule.radius)) return true;
    full = places.count == CapsulePlaces::most;
    if (full) return false;
    places.all[places.count++] = place;
    return true;
  };
  const std::uint64_t nodes = limit.nodes_left();
  std::uint64_t left = nodes;
  const bool all = axis.all_within(
      capsule.radius, take, [&] { return !limit.time_is_up(time_for_places); }, left);
  limit.spend(nodes - left);
  places.cut_off = !all && !full;
  return all;
}

// Keeps those places that the axis goes through, and adds the others of the kind, from its first end on.
void keep_crossings(const PreparedMesh& mesh, const Capsule& capsule, Limit& limit, CapsulePlaces& places) noexcept {
  const auto begin = places.all.begin();
  const auto end = begin + static_cast<std::ptrdiff_t>(places.count);
  const auto kept = std::partition(
      begin, end, [&](const CapsulePlace& place) { return place.distance <= Capsule::same_place * capsule.radius; });
  places.count = std::min(static_cast<std::size_t>(kept - begin), most_crossings);
  const Vec3 axis = capsule.ends[1] - capsule.ends[0];
  const double length = axis.norm();
  if (!(length > 0.0)) return;
  query::Crossings crossings(mesh.mesh(), *mesh.wide_tree, capsule.ends[0], axis / length, length, false);
  while (places.count < most_crossings && !limit.time_is_up()) {
    query::RayEffort effort;
    const auto hit = crossings.next({limit.nodes_in_time(1.0), limit.up()}, effort);
    limit.spend(effort.nodes);
    if (!hit) return;
    const auto is_it = [&](const CapsulePlace& place) { return place.triangle == hit->triangle; };
    if (std::none_of(begin, begin + static_cast<std::ptrdiff_t>(places.count), is_it)) {
      places.all[places.count++] = place_of(mesh, capsule, hit->triangle);
    }
  }
}

// Not all triangles were seen, or there was no room for them. The nearest of those that there was time for is among the
// places: it holds the capsule.
void add_of_many(const PreparedMesh& mesh, const Capsule& capsule, const query::NearSegment& axis, Limit& limit,
                 CapsulePlaces& places) noexcept {
  double least = capsule.radius;
  for (const CapsulePlace& place : places.span()) least = std::min(least, place.distance);
  const std::optional<CapsulePlace> nearest = find_nearest(mesh, capsule, axis, least, limit, places.nearest_is_sure);
  places.cut_off = places.cut_off || !places.nearest_is_sure;
  // Each crossing of the axis is a way out; beside the axis, places are of use only if they are all there.
  const bool crosses = (nearest ? nearest->distance : least) <= Capsule::same_place * capsule.radius;
  if (crosses && !limit.time_is_up()) keep_crossings(mesh, capsule, limit, places);
  if (!nearest) return;
  if (places.count == CapsulePlaces::most) --places.count;  // another of many
  places.all[places.count++] = *nearest;
}

void sort_nearest_first(CapsulePlaces& places) noexcept {
  std::sort(places.all.begin(), places.all.begin() + places.count, [](const CapsulePlace& a, const CapsulePlace& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.triangle < b.triangle;
  });
}

}  // namespace

bool has_little_time(const Limit& limit) noexcept {
  constexpr std::uint64_t enough_nodes = 1000;
  return limit.nodes_in_time(time_for_places) < enough_nodes;
}

void find_places(const PreparedMesh& mesh, const Capsule& capsule, Limit& limit, CapsulePlaces& places) noexcept {
  const query::NearSegment axis(mesh.mesh(), *mesh.wide_tree, capsule.ends[0], capsule.ends[1]);
  places.complete = add_all_within(mesh, capsule, axis, limit, places);
  if (!places.complete) add_of_many(mesh, capsule, axis, limit, places);
  sort_nearest_first(places);
}

void find_nearest_place(const PreparedMesh& mesh, const Capsule& capsule, PartOfAxis part, Limit& limit,
                        CapsulePlaces& places) noexcept {
  const Vec3 step = (capsule.ends[1] - capsule.ends[0]) / part.of;
  const Vec3 begin = capsule.ends[0] + part.number * step;
  const Vec3 end = part.number + 1 == part.of ? capsule.ends[1] : Vec3(begin + step);
  const query::NearSegment axis(mesh.mesh(), *mesh.wide_tree, begin, end);
  add_of_many(mesh, capsule, axis, limit, places);
  places.nearest_is_sure = places.nearest_is_sure && part.of == 1;
  places.cut_off = places.cut_off || part.of > 1;
  places.complete = places.count == 0 && places.nearest_is_sure;
  sort_nearest_first(places);
}

bool is_local_minimum(const PreparedMesh& mesh, const CapsulePlaces& places, std::size_t index,
                      double tolerance) noexcept {
  const CapsulePlace& place = places.all[index];
  for (std::size_t i = 0; i < index; ++i) {
    const CapsulePlace& closer = places.all[i];
    const double apart = (closer.on_surface - place.on_surface).norm();
    if (apart <= tolerance) return false;
    if (closer.distance >= place.distance || apart > closer.extent + tolerance) continue;
    const Vec3 touching = closest_point(mesh.corners(closer.triangle), place.on_surface);
    if ((touching - place.on_surface).norm() <= tolerance) return false;
  }
  return true;
}

}  // namespace odds::ode
