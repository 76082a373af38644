// Closest points of a segment and the triangles near it.
#include "ode/collide/capsule_places.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ode/mesh/triangle_corners.hpp"
#include "query/shape/near_segment.hpp"

namespace odds::ode {
namespace {

// Where more triangles are near than there is room for, each part of the axis gets its share.
constexpr int slices = 8;
// The share of the time after which places are no longer looked for.
constexpr double time_for_places = 0.6;

CapsulePlace place_of(const PreparedMesh& mesh, const Capsule& capsule, std::uint32_t triangle) noexcept {
  const Corners corners = mesh.corners(triangle);
  const primitive::ClosestPoints closest =
      primitive::closest_points_segment_triangle(capsule.ends[0], capsule.ends[1], corners.data());
  double square = 0.0;
  for (const Vec3& corner : corners) square = std::max(square, (corner - closest.on_b).squaredNorm());
  return {closest.on_a, closest.on_b, std::sqrt(closest.squared_distance), std::sqrt(square), triangle};
}

using Triangles = std::array<std::uint32_t, CapsulePlaces::most>;

// The triangles in the box around one part of the axis, as many as there is room for; `complete`: all.
std::size_t triangles_about(const PreparedMesh& mesh, const Capsule& capsule, const Vec3& center, double half_length,
                            Limit& limit, std::span<std::uint32_t> room, bool& complete) noexcept {
  std::uint64_t visited = 0;
  const std::size_t found =
      query::triangles_in_box(*mesh.shape, center, capsule.axes, Vec3(capsule.radius, capsule.radius, half_length),
                              room, limit.units, &complete, &visited);
  limit.spend(visited);
  return found;
}

void add(const PreparedMesh& mesh, const Capsule& capsule, std::span<const std::uint32_t> triangles, Limit& limit,
         CapsulePlaces& places) noexcept {
  for (const std::uint32_t triangle : triangles) {
    if (places.count == CapsulePlaces::most) return;
    if (limit.time_is_up()) {
      places.complete = false;
      return;
    }
    const CapsulePlace place = place_of(mesh, capsule, triangle);
    if (place.distance < capsule.radius) places.all[places.count++] = place;
  }
}

// The nearest triangle, of those that are nearer than `within`; if the limit is reached first, the nearest of those
// seen. no_feature: there is none.
std::uint32_t find_nearest(const PreparedMesh& mesh, const Capsule& capsule, const query::NearSegment& axis,
                           double within, Limit& limit, bool& finished) noexcept {
  // Along one that lies on flat ground all are as near as each other, but for rounding.
  constexpr double not_nearer = 1e-12;
  const auto distance = [&](std::uint32_t t) {
    const double d = place_of(mesh, capsule, t).distance;
    return d < capsule.radius ? d : std::numeric_limits<double>::infinity();
  };
  const std::uint64_t nodes = limit.nodes_left();
  std::uint64_t left = nodes;
  const std::uint32_t nearest = axis.nearest(
      within, axis.margin() + not_nearer * capsule.radius, distance, [&] { return !limit.time_is_up(); }, left,
      finished);
  limit.spend(nodes - left);
  return nearest;
}

// All triangles within the radius, the nearest nodes first: the box around a capsule has many that are farther. False
// if there is no room for them, or no time.
bool add_all_within(const PreparedMesh& mesh, const Capsule& capsule, const query::NearSegment& axis, Limit& limit,
                    CapsulePlaces& places) noexcept {
  const auto take = [&](std::uint32_t t) {
    const CapsulePlace place = place_of(mesh, capsule, t);
    if (!(place.distance < capsule.radius)) return true;
    if (places.count == CapsulePlaces::most) return false;
    places.all[places.count++] = place;
    return true;
  };
  const std::uint64_t nodes = limit.nodes_left();
  std::uint64_t left = nodes;
  const bool all = axis.all_within(
      capsule.radius, take, [&] { return !limit.time_is_up(time_for_places); }, left);
  limit.spend(nodes - left);
  return all;
}

// Not all triangles were seen, or there was no room for them. The nearest of those that there was time for is among the
// places: it holds the capsule.
void add_of_many(const PreparedMesh& mesh, const Capsule& capsule, const query::NearSegment& axis, double half_length,
                 Limit& limit, CapsulePlaces& places) noexcept {
  double least = capsule.radius;
  for (const CapsulePlace& place : places.span()) least = std::min(least, place.distance);
  const std::uint32_t nearest = find_nearest(mesh, capsule, axis, least, limit, places.nearest_is_sure);
  // Each crossing of the axis is a way out; beside the axis, places are of use only if they are all there.
  const bool crosses =
      std::min(least, nearest == query::no_feature ? least : place_of(mesh, capsule, nearest).distance) <=
      Capsule::same_place * capsule.radius;
  if (crosses && !limit.time_is_up()) {
    // What crosses stays; the rest would take the room.
    const auto end = places.all.begin() + static_cast<std::ptrdiff_t>(places.count);
    const auto kept = std::partition(places.all.begin(), end, [&](const CapsulePlace& place) {
      return place.distance <= Capsule::same_place * capsule.radius;
    });
    places.count = std::min(static_cast<std::size_t>(kept - places.all.begin()), CapsulePlaces::most / 2);
    Triangles near;
    for (int i = 0; i < slices; ++i) {
      const double along = (2.0 * i + 1.0) / slices - 1.0;
      const Vec3 center = capsule.middle() + along * half_length * capsule.axes.col(2);
      const std::span<std::uint32_t> room = std::span(near).first(CapsulePlaces::most / slices);
      bool complete = true;
      const std::size_t found = triangles_about(mesh, capsule, center, half_length / slices, limit, room, complete);
      add(mesh, capsule, room.first(found), limit, places);
    }
  }
  if (nearest == query::no_feature) return;
  if (places.count == CapsulePlaces::most) --places.count;  // another of many
  places.all[places.count++] = place_of(mesh, capsule, nearest);
}

}  // namespace

void find_places(const PreparedMesh& mesh, const Capsule& capsule, Limit& limit, CapsulePlaces& places) noexcept {
  const double half_length = 0.5 * (capsule.ends[1] - capsule.ends[0]).norm() + capsule.radius;
  const query::NearSegment axis(*mesh.wide_tree, capsule.ends[0], capsule.ends[1]);
  places.complete = add_all_within(mesh, capsule, axis, limit, places);
  if (!places.complete) add_of_many(mesh, capsule, axis, half_length, limit, places);
  std::sort(places.all.begin(), places.all.begin() + places.count, [](const CapsulePlace& a, const CapsulePlace& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.triangle < b.triangle;
  });
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
