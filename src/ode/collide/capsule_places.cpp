// Closest points of a segment and the triangles near it.
#include "ode/collide/capsule_places.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ode/mesh/triangle_corners.hpp"

namespace odds::ode {
namespace {

// Where more triangles are near than there is room for, each part of the axis gets its share.
constexpr int slices = 8;

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

// No point of a box is nearer to the axis than this.
double least_distance(const Capsule& capsule, const Vec3& center, const Vec3& half) noexcept {
  const Vec3 axis = capsule.ends[1] - capsule.ends[0];
  const Vec3 lower = capsule.ends[0].cwiseMin(capsule.ends[1]);
  const Vec3 upper = capsule.ends[0].cwiseMax(capsule.ends[1]);
  const double between_boxes = (lower - center - half).cwiseMax(center - half - upper).cwiseMax(0.0).norm();
  const double square = axis.squaredNorm();
  const double along = square > 0.0 ? std::clamp(axis.dot(center - capsule.ends[0]) / square, 0.0, 1.0) : 0.0;
  const double from_ball = (center - capsule.ends[0] - along * axis).norm() - half.norm();
  return std::max(between_boxes, from_ball);
}

// The nearest triangle of all, by the tree; if the limit is reached first, the nearest of those seen. no_item: none of
// them is within the radius.
std::uint32_t find_nearest(const PreparedMesh& mesh, const Capsule& capsule, Limit& limit) noexcept {
  // Along one that lies on flat ground all are as near as each other, but for rounding.
  constexpr double not_nearer = 1e-12;
  constexpr double nothing = -std::numeric_limits<double>::infinity();
  return mesh.triangle_tree.greatest(
      [&](std::uint32_t t) {
        const double distance = place_of(mesh, capsule, t).distance;
        return distance < capsule.radius ? -distance : nothing;
      },
      [&](const Vec3& center, const Vec3& half) {
        if (limit.time_is_up()) return nothing;
        const double gap = least_distance(capsule, center, half);
        return gap < capsule.radius ? -gap - not_nearer * capsule.radius : nothing;
      },
      limit.units);
}

// All triangles within the radius, by the tree: the box around a capsule has many that are farther. False if there is
// no room for them, or no time.
bool add_all_within(const PreparedMesh& mesh, const Capsule& capsule, Limit& limit, CapsulePlaces& places) noexcept {
  return mesh.triangle_tree.all_near(
      [&](const Vec3& center, const Vec3& half) { return least_distance(capsule, center, half) < capsule.radius; },
      [&](std::uint32_t t) {
        if (limit.time_is_up()) return false;
        const CapsulePlace place = place_of(mesh, capsule, t);
        if (!(place.distance < capsule.radius)) return true;
        if (places.count == CapsulePlaces::most) return false;
        places.all[places.count++] = place;
        return true;
      },
      limit.units);
}

// More triangles are in the box around the capsule than there is room for. The nearest comes first: it holds the
// capsule if there is no time for more.
void add_of_many(const PreparedMesh& mesh, const Capsule& capsule, double half_length, Limit& limit,
                 CapsulePlaces& places) noexcept {
  const std::uint32_t nearest = find_nearest(mesh, capsule, limit);
  places.complete = add_all_within(mesh, capsule, limit, places);
  if (places.complete) return;
  // Each crossing of the axis is a way out; beside the axis, places are of use only if they are all there.
  const bool crosses =
      nearest != no_item && place_of(mesh, capsule, nearest).distance <= Capsule::same_place * capsule.radius;
  if (crosses && !limit.time_is_up()) {
    places.count = 0;
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
  if (nearest == no_item) return;
  if (places.count == CapsulePlaces::most) --places.count;
  places.all[places.count++] = place_of(mesh, capsule, nearest);
}

}  // namespace

void find_places(const PreparedMesh& mesh, const Capsule& capsule, Limit& limit, CapsulePlaces& places) noexcept {
  const double half_length = 0.5 * (capsule.ends[1] - capsule.ends[0]).norm() + capsule.radius;
  Triangles near;
  const std::size_t found = triangles_about(mesh, capsule, capsule.middle(), half_length, limit, near, places.complete);
  if (places.complete || limit.units == 0) {
    add(mesh, capsule, std::span(near).first(found), limit, places);
  } else {
    add_of_many(mesh, capsule, half_length, limit, places);
  }
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
