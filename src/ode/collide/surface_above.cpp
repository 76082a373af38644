// The nearest triangle over a point along a line, by branch and bound.
#include "ode/collide/surface_above.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ode/collide/convex_patch.hpp"
#include "ode/mesh/triangle_corners.hpp"

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

}  // namespace odds::ode
