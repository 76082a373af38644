#include "odds/query/ray.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <variant>

#include "query/search.hpp"
#include "query/shape_data.hpp"
#include "query/wide/lookup.hpp"

namespace odds::query {
namespace {

/// Distance along the ray to the triangle, or a negative number.
double distance_to(const tree::TriangleCorners& triangle, const Vec3& origin, const Vec3& direction) noexcept {
  const Vec3 edge1 = triangle[1] - triangle[0];
  const Vec3 edge2 = triangle[2] - triangle[0];
  const Vec3 p = direction.cross(edge2);
  const double determinant = edge1.dot(p);
  if (determinant == 0.0) return -1.0;  // parallel or degenerate; its neighbours are met instead
  // Borders are widened by a few roundings: a crossing counted twice does no harm to the nearest one, a gap would.
  constexpr double slack = 1e-12;
  const Vec3 from_corner = origin - triangle[0];
  const double u = from_corner.dot(p) / determinant;
  if (!(u >= -slack && u <= 1.0 + slack)) return -1.0;
  const Vec3 q = from_corner.cross(edge1);
  const double v = direction.dot(q) / determinant;
  if (!(v >= -slack && u + v <= 1.0 + slack)) return -1.0;
  return edge2.dot(q) / determinant;
}

template <volume::BoundingVolume V>
std::optional<RayHit> cast(const tree::Hierarchy<V>& hierarchy, const Vec3& origin, const Vec3& direction,
                           double length, std::uint64_t budget_nodes) noexcept {
  volume::RaySegment segment = volume::RaySegment::make(origin, direction, length, hierarchy.reach());
  std::array<std::uint32_t, stack_capacity> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  std::optional<RayHit> nearest;
  for (std::uint64_t visited = 0; size != 0 && visited < budget_nodes; ++visited) {
    const auto& node = hierarchy.nodes()[stack[--size]];
    if (!met_by(node.volume, segment)) continue;
    if (!node.is_leaf()) {
      // The child whose surface lies nearer along the ray is searched first, so that the segment shrinks early.
      const float first = hierarchy.statistics()[node.first].centroid.dot(segment.direction);
      const float second = hierarchy.statistics()[node.first + 1].centroid.dot(segment.direction);
      const bool swap = second < first;
      stack[size++] = node.first + (swap ? 0U : 1U);
      stack[size++] = node.first + (swap ? 1U : 0U);
      continue;
    }
    for (std::uint32_t t = node.first; t < node.first + node.count; ++t) {
      const double distance = distance_to(hierarchy.corners()[t], origin, direction);
      if (!(distance >= 0.0 && distance <= length)) continue;
      if (nearest && distance >= nearest->distance) continue;
      nearest = RayHit{distance, hierarchy.order()[t]};
      segment.length = static_cast<float>(distance * (1.0 + 1e-6));
    }
  }
  return nearest;
}

std::optional<RayHit> cast(const mesh::TriangleMesh& mesh, const tree::WideTree& tree, const Vec3& origin,
                           const Vec3& direction, double length, std::uint64_t budget_nodes) noexcept {
  volume::RaySegment segment = volume::RaySegment::make(origin, direction, length, tree.reach());
  struct Open {
    tree::ChildRef child;
    float enter;
  };
  std::array<Open, (tree::wide_lanes - 1) * (tree::deepest_level + 2)> stack;
  std::size_t size = 0;
  stack[size++] = {tree.nodes()[0].child[0], 0.0F};
  std::optional<RayHit> nearest;
  for (std::uint64_t visited = 0; size != 0 && visited < budget_nodes; ++visited) {
    const Open open = stack[--size];
    if (open.enter > segment.length + segment.margin) continue;
    if (!open.child.is_leaf()) {
      const tree::WideNode& node = tree.nodes()[open.child.index()];
      float enter[tree::wide_lanes];
      const unsigned met = wide::lanes_met_by(node, segment, enter);
      const std::size_t first = size;
      for (unsigned lanes = met; lanes != 0; lanes &= lanes - 1U) {
        const auto lane = static_cast<unsigned>(std::countr_zero(lanes));
        // The nearest last, for it is visited first and shortens the segment.
        std::size_t at = size++;
        for (; at > first && stack[at - 1].enter < enter[lane]; --at) stack[at] = stack[at - 1];
        stack[at] = {node.child[lane], enter[lane]};
      }
      continue;
    }
    const tree::WideLeaf& leaf = tree.leaves()[open.child.index()];
    for (std::uint32_t t = 0; t < open.child.count(); ++t) {
      const mesh::Triangle& triangle = mesh.triangles()[leaf.triangle[t]];
      const tree::TriangleCorners corners = {mesh.vertices()[triangle[0]] - tree.origin(),
                                             mesh.vertices()[triangle[1]] - tree.origin(),
                                             mesh.vertices()[triangle[2]] - tree.origin()};
      const double distance = distance_to(corners, origin, direction);
      if (!(distance >= 0.0 && distance <= length)) continue;
      if (nearest && distance >= nearest->distance) continue;
      nearest = RayHit{distance, leaf.triangle[t]};
      segment.length = static_cast<float>(distance * (1.0 + 1e-6));
    }
  }
  return nearest;
}

template <volume::BoundingVolume V>
std::optional<RayHit> cast(const mesh::TriangleMesh&, const tree::Hierarchy<V>& hierarchy, const Vec3& origin,
                           const Vec3& direction, double length, std::uint64_t budget_nodes) noexcept {
  return cast(hierarchy, origin, direction, length, budget_nodes);
}

}  // namespace

std::optional<RayHit> cast_ray(const Shape& shape, const Vec3& origin, const Vec3& direction, double max_distance,
                               std::uint64_t budget_nodes) noexcept {
  if (!origin.allFinite() || !(std::abs(direction.squaredNorm() - 1.0) < 1e-6) || !(max_distance >= 0.0)) return {};
  return std::visit(
      [&](const auto& tree) -> std::optional<RayHit> {
        const Vec3 local = origin - tree.origin();
        // Nothing lies beyond the far side of the enclosing ball; this also makes an infinite length finite.
        const double length = std::fmin(max_distance, (local.norm() + tree.reach()) * (1.0 + 1e-9));
        return cast(shape.mesh(), tree, local, direction, length, budget_nodes);
      },
      shape.data().tree);
}

}  // namespace odds::query
