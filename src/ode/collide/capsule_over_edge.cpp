#include "ode/collide/capsule_over_edge.hpp"

#include <algorithm>
#include <limits>

#include "ode/mesh/triangle_corners.hpp"

namespace odds::ode {

std::optional<WayOverEdge> way_over_edge(const PreparedMesh& mesh, const Capsule& capsule,
                                         const CapsulePlaces& places) noexcept {
  constexpr double same_crossing = 1e-6;  // of the axis: through a common edge of two triangles
  constexpr double parallel = 1e-3;       // sine; the planes of such faces meet far away, or nowhere
  const Vec3 axis = capsule.ends[1] - capsule.ends[0];
  const double square = axis.squaredNorm();
  if (!(square > 0.0)) return std::nullopt;
  WayOverEdge way;
  double first_in = std::numeric_limits<double>::infinity();  // along the axis, of its length
  double last_in = -std::numeric_limits<double>::infinity();
  double first_back = first_in;
  double last_back = last_in;
  for (const CapsulePlace& place : places.span()) {
    if (place.distance > Capsule::same_place * capsule.radius) break;
    const Vec3 out = unit_normal(mesh.corners(place.triangle));
    const double against = out.dot(axis);
    if (against == 0.0) return std::nullopt;  // it lies in a face, or the triangle has no direction
    const double at = axis.dot(place.on_axis - capsule.ends[0]) / square;
    if (against < 0.0) {
      if (at < first_in) way.in = {&place, out};
      first_in = std::min(first_in, at);
      last_in = std::max(last_in, at);
    } else {
      if (at > last_back) way.back = {&place, out};
      first_back = std::min(first_back, at);
      last_back = std::max(last_back, at);
    }
  }
  if (way.in.place == nullptr || way.back.place == nullptr) return std::nullopt;
  if (last_in - first_in > same_crossing || last_back - first_back > same_crossing) return std::nullopt;
  if (first_in - last_back > same_crossing) return std::nullopt;  // both ends are within
  const Vec3 edge = way.in.out.cross(way.back.out);
  const Vec3 across = axis.cross(edge);
  if (!(edge.norm() > parallel) || !(across.norm() > parallel * edge.norm() * axis.norm())) return std::nullopt;
  way.out = across.normalized();
  if (way.out.dot(way.in.out + way.back.out) < 0.0) way.out = -way.out;
  // A point of the edge: in both planes, and in that across the edge through where the axis goes in.
  const Vec3& entry = way.in.place->on_surface;
  const double beyond = way.back.out.dot(way.back.place->on_surface - entry);
  const Vec3 corner = entry + beyond * edge.cross(way.in.out) / edge.squaredNorm();
  way.depth = std::max(way.out.dot(corner - entry), 0.0);
  // Along the edge to where the moved axis touches it: both lines are in one plane across `out`.
  const Vec3 moved = entry + way.depth * way.out;
  const Vec3 gap = corner - moved;
  const Vec3 beside = way.out.cross(axis);  // across the axis, in that plane
  way.on_edge = corner - edge * (beside.dot(gap) / beside.dot(edge));
  return way;
}

}  // namespace odds::ode
