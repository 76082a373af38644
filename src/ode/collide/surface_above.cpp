// The nearest triangle over a point along a line.
#include "ode/collide/surface_above.hpp"

#include <algorithm>

#include "ode/collide/convex_patch.hpp"
#include "ode/collide/end_of_share.hpp"
#include "ode/mesh/triangle_corners.hpp"
#include "query/shape/near_segment.hpp"

namespace odds::ode {
namespace {

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

}  // namespace

std::optional<Above> surface_above(const PreparedMesh& mesh, const math::Pose& body_in_mesh, const ConvexBody& body,
                                   const Vec3& point, const Vec3& up, double most, Limit& limit) noexcept {
  const Vec3 from = body_in_mesh * point;
  const Vec3 along = body_in_mesh.rotation * up;
  const double tolerance = 1e-9 * body.box_half_extents().norm();
  EndOfShare end(limit, time_for_exits, EndOfShare::to_a_triangle);  // a body without any piece has nothing else
  const std::uint64_t nodes = limit.nodes_left();
  std::uint64_t left = nodes;
  std::optional<Above> nearest;
  const auto take = [&](std::uint32_t triangle) {
    const double way = way_out(mesh.corners(triangle), from, along, tolerance);
    if (way > 0.0 && way <= (nearest ? nearest->way : most)) nearest = {triangle, way};
    return true;
  };
  const query::NearSegment line(mesh.mesh(), *mesh.wide_tree, from, from + most * along);
  static_cast<void>(line.all_within(
      tolerance, take, [&] { return !end.is_there(); }, left));
  limit.spend(nodes - left);
  return nearest;
}

}  // namespace odds::ode
