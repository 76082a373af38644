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
  return {closest.on_a, closest.on_b, std::sqrt(closest.squared_distance), triangle};
}

// The triangles in the box around one part of the axis, at most `share` of them.
void add_part(const PreparedMesh& mesh, const Capsule& capsule, const Vec3& center, double half_length,
              std::size_t share, Limit& limit, CapsulePlaces& places) noexcept {
  std::array<std::uint32_t, CapsulePlaces::most> near;
  bool complete = true;
  std::uint64_t visited = 0;
  const std::size_t found =
      query::triangles_in_box(*mesh.shape, center, capsule.axes, Vec3(capsule.radius, capsule.radius, half_length),
                              std::span(near).first(share), limit.units, &complete, &visited);
  limit.spend(visited);
  places.complete = places.complete && complete;
  for (std::size_t i = 0; i < found && places.count < CapsulePlaces::most; ++i) {
    if (limit.time_is_up()) {
      places.complete = false;
      return;
    }
    const CapsulePlace place = place_of(mesh, capsule, near[i]);
    if (place.distance < capsule.radius) places.all[places.count++] = place;
  }
}

// The nearest triangle of all, by the tree; nothing if the limit is reached first.
void add_nearest(const PreparedMesh& mesh, const Capsule& capsule, Limit& limit, CapsulePlaces& places) noexcept {
  constexpr double nothing = -std::numeric_limits<double>::infinity();
  const Vec3 lower = capsule.ends[0].cwiseMin(capsule.ends[1]);
  const Vec3 upper = capsule.ends[0].cwiseMax(capsule.ends[1]);
  const std::uint32_t nearest = mesh.triangle_tree.greatest(
      [&](std::uint32_t t) {
        const double distance = place_of(mesh, capsule, t).distance;
        return distance < capsule.radius ? -distance : nothing;
      },
      [&](const Vec3& center, const Vec3& half) {
        if (limit.time_is_up()) return nothing;
        const double gap = (lower - center - half).cwiseMax(center - half - upper).cwiseMax(0.0).norm();
        return gap < capsule.radius ? -gap : nothing;
      },
      limit.units);
  if (nearest == no_item) return;
  if (places.count == CapsulePlaces::most) --places.count;
  places.all[places.count++] = place_of(mesh, capsule, nearest);
}

}  // namespace

void find_places(const PreparedMesh& mesh, const Capsule& capsule, Limit& limit, CapsulePlaces& places) noexcept {
  const Vec3 axis = capsule.ends[1] - capsule.ends[0];
  const double half_length = 0.5 * axis.norm() + capsule.radius;
  add_part(mesh, capsule, capsule.middle(), half_length, CapsulePlaces::most, limit, places);
  if (!places.complete && !limit.time_is_up()) {
    places.count = 0;
    for (int i = 0; i < slices; ++i) {
      const double along = (2.0 * i + 1.0) / slices - 1.0;
      add_part(mesh, capsule, capsule.middle() + along * half_length * capsule.axes.col(2), half_length / slices,
               CapsulePlaces::most / slices, limit, places);
    }
    add_nearest(mesh, capsule, limit, places);
    places.complete = false;
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
    if ((closer.on_surface - place.on_surface).norm() <= tolerance) return false;
    if (closer.distance >= place.distance) continue;
    const Vec3 touching = closest_point(mesh.corners(closer.triangle), place.on_surface);
    if ((touching - place.on_surface).norm() <= tolerance) return false;
  }
  return true;
}

}  // namespace odds::ode
