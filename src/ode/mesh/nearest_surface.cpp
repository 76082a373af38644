// The nearest triangle; its side by the pseudo-normal.
#include "ode/mesh/nearest_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "ode/mesh/triangle_corners.hpp"
#include "query/counted_ray.hpp"
#include "query/shape/near_segment.hpp"

namespace odds::ode {
namespace {

// Relative to the mesh's size: what counts as on an edge or at a corner.
constexpr double on_feature = 1e-12;
// Relative to how far from the origin of the mesh's frame mesh and point are: by so much rounding moves a closest
// point.
constexpr double rounding = 4e-15;

using Touching = std::array<std::uint32_t, PreparedMesh::most_touching>;

// Triangles that meet at `point`, in their order: sums are then the same in every tree.
std::size_t find_touching(const PreparedMesh& mesh, const Vec3& point, double tolerance, Touching& touching) noexcept {
  std::size_t count = 0;
  std::uint64_t nodes = 4096;
  const auto take = [&](std::uint32_t triangle) {
    if ((closest_point(mesh.corners(triangle), point) - point).norm() > tolerance) return true;
    touching[count++] = triangle;
    return count < touching.size();
  };
  const query::NearSegment about(mesh.mesh(), *mesh.wide_tree, point, point);
  static_cast<void>(about.all_within(
      tolerance, take, [] { return true; }, nodes));
  std::sort(touching.begin(), touching.begin() + static_cast<std::ptrdiff_t>(count));
  return count;
}

// The angle-weighted mean of the normals of triangles at `point`: of those that are not thin, if `thin` is not zero.
Vec3 mean_normal(const PreparedMesh& mesh, const Vec3& point, double tolerance, std::span<const std::uint32_t> touching,
                 double thin) noexcept {
  Vec3 sum = Vec3::Zero();
  for (const std::uint32_t triangle : touching) {
    const Corners corners = mesh.corners(triangle);
    if (thin > 0.0 && is_thin(corners, thin)) continue;
    sum += angle_at(corners, point, tolerance) * unit_normal(corners);
  }
  const double length = sum.norm();
  return length > 0.0 ? Vec3(sum / length) : Vec3(Vec3::Zero());
}

// The angle-weighted mean of the normals of all triangles that meet at `point`, which lies on triangle `at`. Those of
// thin ones point anywhere, and their corners may lie as far beside their neighbours as they are high. Where there are
// some, the others about the point have the word, unless they do not tell the side: on the rim of a sheet so thin.
Vec3 pseudo_normal(const PreparedMesh& mesh, const Vec3& point, std::uint32_t at, double tolerance,
                   const Vec3& seen_from) noexcept {
  constexpr double least = 0.1;  // cosine
  const double thin = mesh.thin;
  const auto tells_side = [&](const Vec3& normal) {
    return std::abs(normal.dot(seen_from - point)) > least * (seen_from - point).norm();
  };
  const Corners own = mesh.corners(at);
  const Vec3 own_normal = unit_normal(own);
  const bool within = angle_at(own, point, tolerance) > 1.5 * std::numbers::pi && own_normal != Vec3::Zero();
  const auto may_be_rounding = [thin](const Corners& corners) { return thin > 0.0 && is_thin(corners, thin); };
  if (within && !may_be_rounding(own)) return own_normal;
  Touching touching;
  const std::size_t count = find_touching(mesh, point, tolerance, touching);
  const std::span<const std::uint32_t> all = std::span(touching).first(count);
  if (std::any_of(all.begin(), all.end(), [&](std::uint32_t t) { return may_be_rounding(mesh.corners(t)); })) {
    Touching about;
    const std::size_t count_about = find_touching(mesh, point, thin, about);
    const Vec3 normal = mean_normal(mesh, point, thin, std::span(about).first(count_about), thin);
    if (count_about < about.size() && tells_side(normal)) return normal;
  }
  if (within) return own_normal;
  if (count == touching.size()) {
    const auto before = [](const PreparedMesh::Fan& fan, double x) { return fan.tip.x() < x; };
    auto fan = std::lower_bound(mesh.fans.begin(), mesh.fans.end(), point.x() - tolerance, before);
    for (; fan != mesh.fans.end() && fan->tip.x() <= point.x() + tolerance; ++fan) {
      if ((fan->tip - point).norm() <= tolerance) return fan->normal;
    }
  }
  const Vec3 normal = mean_normal(mesh, point, tolerance, all, 0.0);
  return normal != Vec3::Zero() ? normal : own_normal;
}

}  // namespace

Vec3 outward_at(const PreparedMesh& mesh, const Vec3& point, std::uint32_t triangle, const Vec3& seen_from) noexcept {
  const double far = std::max(mesh.mesh().lower().cwiseAbs().maxCoeff(), mesh.mesh().upper().cwiseAbs().maxCoeff());
  const double tolerance = on_feature * mesh.mesh().size() + rounding * (far + seen_from.cwiseAbs().maxCoeff());
  return pseudo_normal(mesh, point, triangle, tolerance, seen_from);
}

std::optional<NearestSurface> nearest_surface(const PreparedMesh& mesh, const Vec3& point, double reach,
                                              std::uint32_t guess, const query::Deadline& deadline, int sure_nodes,
                                              const query::RayAllowance& ray, std::uint64_t& units,
                                              bool& finished) noexcept {
  bool has_seen_any = false;
  const auto distance = [&](std::uint32_t t) {
    has_seen_any = true;
    return (closest_point(mesh.corners(t), point) - point).norm();
  };
  const auto may_go_on = [&] { return (!has_seen_any && sure_nodes-- > 0) || !deadline(); };
  const double guessed =
      guess < mesh.mesh().triangles().size() ? distance(guess) : std::numeric_limits<double>::infinity();
  std::uint32_t triangle = query::NearSegment(mesh.mesh(), *mesh.wide_tree, point, point)
                               .nearest(std::min(reach, guessed), 0.0, distance, may_go_on, units, finished);
  if (triangle == query::no_feature) {
    if (!(guessed <= reach) || guess >= mesh.mesh().triangles().size()) return std::nullopt;
    triangle = guess;
  }
  NearestSurface nearest;
  nearest.triangle = triangle;
  nearest.point = closest_point(mesh.corners(triangle), point);
  nearest.distance = (nearest.point - point).norm();
  // There may be nearer triangles, and of one that is not the nearest the side tells nothing: a ball in a cavity would
  // be pushed out through its walls.
  if (!finished && nearest.distance > 0.0) {
    return surface_towards(mesh, point, nearest.point, triangle, ray);
  }
  nearest.outward = outward_at(mesh, nearest.point, triangle, point);
  nearest.inside = mesh.closed && nearest.outward.dot(point - nearest.point) < 0.0;
  return nearest;
}

std::optional<NearestSurface> surface_towards(const PreparedMesh& mesh, const Vec3& point, const Vec3& place,
                                              std::uint32_t triangle, const query::RayAllowance& ray) noexcept {
  if (ray.nodes == 0) return std::nullopt;
  // Aimed a little into the triangle: at its rim the ray might meet a neighbour that faces the other way, at the tip of
  // a spike for one.
  constexpr double inwards = 1e-3;  // of the way to its middle
  const Corners corners = mesh.corners(triangle);
  const Vec3 target = place + inwards * ((corners[0] + corners[1] + corners[2]) / 3.0 - place);
  const double length = (target - point).norm();
  const Vec3 direction = (target - point) / length;
  query::RayEffort effort;
  const auto hit = query::cast_counted_ray(*mesh.shape, point, direction, length * (1.0 + 1e-9), ray, effort);
  if (!effort.finished) return std::nullopt;
  NearestSurface met = {place, (place - point).norm(), triangle, unit_normal(corners), false};
  if (hit && hit->triangle != triangle) {
    const Vec3 normal = unit_normal(mesh.corners(hit->triangle));
    met = {point + hit->distance * direction, hit->distance, hit->triangle, normal, false};
  }
  met.inside = mesh.closed && met.outward.dot(direction) > 0.0;
  return met;
}

bool in_bounds(const PreparedMesh& mesh, const Vec3& point) noexcept {
  return (point.array() >= mesh.mesh().lower().array()).all() && (point.array() <= mesh.mesh().upper().array()).all();
}

}  // namespace odds::ode
