// Nearest triangle by branch and bound; its side by the pseudo-normal.
#include "ode/mesh/nearest_surface.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

#include "ode/mesh/triangle_corners.hpp"

namespace odds::ode {
namespace {

// Relative to the mesh's size: what counts as on an edge or at a corner.
constexpr double on_feature = 1e-12;
// Relative to how far from the origin of the mesh's frame mesh and point are: by so much rounding moves a closest
// point.
constexpr double rounding = 4e-15;

// The angle-weighted mean of the normals of all triangles that meet at `point`, which lies on triangle `at`.
Vec3 pseudo_normal(const PreparedMesh& mesh, const Vec3& point, std::uint32_t at, double tolerance) noexcept {
  const Corners own = mesh.corners(at);
  const Vec3 own_normal = unit_normal(own);
  if (angle_at(own, point, tolerance) > 1.5 * std::numbers::pi && own_normal != Vec3::Zero()) return own_normal;
  std::array<std::uint32_t, PreparedMesh::most_touching> touching;
  constexpr std::uint64_t most_nodes = 4096;
  const std::size_t count = query::triangles_in_box(*mesh.shape, point, Mat3::Identity(), Vec3::Constant(tolerance),
                                                    touching, most_nodes, nullptr);
  if (count == touching.size()) {
    const auto before = [](const PreparedMesh::Fan& fan, double x) { return fan.tip.x() < x; };
    auto fan = std::lower_bound(mesh.fans.begin(), mesh.fans.end(), point.x() - tolerance, before);
    for (; fan != mesh.fans.end() && fan->tip.x() <= point.x() + tolerance; ++fan) {
      if ((fan->tip - point).norm() <= tolerance) return fan->normal;
    }
  }
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    const Corners corners = mesh.corners(touching[i]);
    if ((closest_point(corners, point) - point).norm() > tolerance) continue;
    sum += angle_at(corners, point, tolerance) * unit_normal(corners);
  }
  const double length = sum.norm();
  return length > 0.0 ? Vec3(sum / length) : own_normal;
}

}  // namespace

Vec3 outward_at(const PreparedMesh& mesh, const Vec3& point, std::uint32_t triangle, const Vec3& seen_from) noexcept {
  const double far = std::max(mesh.mesh().lower().cwiseAbs().maxCoeff(), mesh.mesh().upper().cwiseAbs().maxCoeff());
  const double tolerance = on_feature * mesh.mesh().size() + rounding * (far + seen_from.cwiseAbs().maxCoeff());
  return pseudo_normal(mesh, point, triangle, tolerance);
}

std::optional<NearestSurface> nearest_surface(const PreparedMesh& mesh, const Vec3& point, double reach,
                                              std::uint64_t& units) noexcept {
  constexpr double nothing = -std::numeric_limits<double>::infinity();
  const double square_reach = reach * reach;
  const std::uint32_t triangle = mesh.triangle_tree.greatest(
      [&](std::uint32_t t) {
        const double square = (closest_point(mesh.corners(t), point) - point).squaredNorm();
        return square <= square_reach ? -square : nothing;
      },
      [&](const Vec3& center, const Vec3& half) {
        const double square = ((point - center).cwiseAbs() - half).cwiseMax(0.0).squaredNorm();
        return square <= square_reach ? -square : nothing;
      },
      units);
  if (triangle == no_item) return std::nullopt;
  NearestSurface nearest;
  nearest.triangle = triangle;
  nearest.point = closest_point(mesh.corners(triangle), point);
  nearest.distance = (nearest.point - point).norm();
  nearest.outward = outward_at(mesh, nearest.point, triangle, point);
  nearest.inside = mesh.closed && nearest.outward.dot(point - nearest.point) < 0.0;
  // Where the search was cut short there may be nearer triangles, and of one that is not the nearest the side tells
  // nothing: a ball in a cavity would be pushed out through its walls.
  if (nearest.inside && units == 0) return std::nullopt;
  return nearest;
}

bool in_bounds(const PreparedMesh& mesh, const Vec3& point) noexcept {
  return (point.array() >= mesh.mesh().lower().array()).all() && (point.array() <= mesh.mesh().upper().array()).all();
}

}  // namespace odds::ode
