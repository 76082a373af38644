#include "odds/query/ray.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <variant>

#include "odds/math/float_sums.hpp"
#include "odds/primitive/ray_triangle.hpp"
#include "query/counted_ray.hpp"
#include "query/ray/ray_length.hpp"
#include "query/search/search.hpp"
#include "query/shape_data.hpp"
#include "query/wide/searches.hpp"

namespace odds::query {
namespace {

template <volume::BoundingVolume V>
std::optional<RayHit> cast(const tree::Hierarchy<V>& hierarchy, const Vec3& origin, const Vec3& direction,
                           double length, const RayAllowance& allowance, RayEffort& effort) noexcept {
  volume::RaySegment segment = volume::RaySegment::make(origin, direction, length, hierarchy.reach());
  std::array<std::uint32_t, stack_capacity> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  std::optional<RayHit> nearest;
  std::uint64_t visited = 0;
  for (; size != 0 && !allowance.is_up(visited); ++visited) {
    const auto& node = hierarchy.nodes()[stack[--size]];
    if (!met_by(node.volume, segment)) continue;
    if (!node.is_leaf()) {
      // The child whose surface lies nearer along the ray is searched first, so that the segment shrinks early.
      const float first = math::dot(hierarchy.statistics()[node.first].centroid, segment.direction);
      const float second = math::dot(hierarchy.statistics()[node.first + 1].centroid, segment.direction);
      const bool swap = second < first;
      stack[size++] = node.first + (swap ? 0U : 1U);
      stack[size++] = node.first + (swap ? 1U : 0U);
      continue;
    }
    for (std::uint32_t t = node.first; t < node.first + node.count; ++t) {
      const double distance = primitive::distance_along_ray(hierarchy.corners()[t].data(), origin, direction);
      if (!(distance >= 0.0 && distance <= length)) continue;
      if (nearest && distance >= nearest->distance) continue;
      nearest = RayHit{distance, hierarchy.order()[t]};
      segment.length = static_cast<float>(distance * (1.0 + 1e-6));
    }
  }
  effort = {visited, size == 0};
  return nearest;
}

std::optional<RayHit> cast(const mesh::TriangleMesh& mesh, const tree::WideTree& tree, const Vec3& origin,
                           const Vec3& direction, double length, const RayAllowance& allowance,
                           RayEffort& effort) noexcept {
  return wide::searches_for(InstructionSet::best)->ray({mesh, tree, origin, direction, length, allowance, effort});
}

template <volume::BoundingVolume V>
std::optional<RayHit> cast(const mesh::TriangleMesh&, const tree::Hierarchy<V>& hierarchy, const Vec3& origin,
                           const Vec3& direction, double length, const RayAllowance& allowance,
                           RayEffort& effort) noexcept {
  return cast(hierarchy, origin, direction, length, allowance, effort);
}

bool is_castable(const Shape& shape, const Vec3& origin, const Vec3& direction, double max_distance) noexcept {
  return shape.has_polygons() && origin.allFinite() && std::abs(direction.squaredNorm() - 1.0) < 1e-6 &&
         max_distance >= 0.0;
}

template <class Tree>
[[gnu::noinline]] std::optional<RayHit> cast_from_afar(const mesh::TriangleMesh& mesh, const Tree& tree,
                                                       const Vec3& local, const Vec3& direction, double max_distance,
                                                       const RayAllowance& allowance, RayEffort& effort) noexcept {
  const double skipped = skipped_way(tree.reach(), local, direction);
  if (!(skipped <= max_distance)) return std::nullopt;
  const Vec3 nearer = local + skipped * direction;
  const double length = length_within(tree.reach(), nearer.norm(), max_distance - skipped);
  std::optional<RayHit> hit = cast(mesh, tree, nearer, direction, length, allowance, effort);
  if (hit) hit->distance += skipped;
  return hit;
}

/// Null also of a ray that begins far off: one at a time has to do for those.
const tree::WideTree* castable_wide_tree(const CountedRay& ray) noexcept {
  if (!is_castable(ray.shape, ray.origin, ray.direction, ray.max_distance)) return nullptr;
  const auto* const tree = std::get_if<tree::WideTree>(&ray.shape.data().tree);
  if (tree == nullptr || is_far_off(tree->reach(), (ray.origin - tree->origin()).norm())) return nullptr;
  return tree;
}

}  // namespace

std::optional<RayHit> cast_ray(const Shape& shape, const Vec3& origin, const Vec3& direction, double max_distance,
                               std::uint64_t budget_nodes) noexcept {
  RayEffort effort;
  return cast_counted_ray(shape, origin, direction, max_distance, {budget_nodes}, effort);
}

std::optional<RayHit> cast_counted_ray(const Shape& shape, const Vec3& origin, const Vec3& direction,
                                       double max_distance, const RayAllowance& allowance, RayEffort& effort) noexcept {
  effort = {};
  if (!is_castable(shape, origin, direction, max_distance)) return {};
  return std::visit(
      [&](const auto& tree) -> std::optional<RayHit> {
        const Vec3 local = origin - tree.origin();
        const double away = local.norm();
        if (is_far_off(tree.reach(), away)) [[unlikely]]
          return cast_from_afar(shape.mesh(), tree, local, direction, max_distance, allowance, effort);
        return cast(shape.mesh(), tree, local, direction, length_within(tree.reach(), away, max_distance), allowance,
                    effort);
      },
      shape.data().tree);
}

std::array<std::optional<RayHit>, 2> cast_two_rays(const CountedRay& first, const CountedRay& second,
                                                   std::uint64_t budget_nodes) noexcept {
  const tree::WideTree* const tree = castable_wide_tree(first);
  const tree::WideTree* const other_tree = castable_wide_tree(second);
  if (tree == nullptr || other_tree == nullptr) {
    return {cast_ray(first.shape, first.origin, first.direction, first.max_distance, budget_nodes),
            cast_ray(second.shape, second.origin, second.direction, second.max_distance, budget_nodes)};
  }
  RayEffort effort;
  RayEffort other_effort;
  const Vec3 local = first.origin - tree->origin();
  const Vec3 other_local = second.origin - other_tree->origin();
  return wide::searches_for(InstructionSet::best)
      ->two_rays({first.shape.mesh(),
                  *tree,
                  local,
                  first.direction,
                  length_within(tree->reach(), local.norm(), first.max_distance),
                  {budget_nodes},
                  effort},
                 {second.shape.mesh(),
                  *other_tree,
                  other_local,
                  second.direction,
                  length_within(other_tree->reach(), other_local.norm(), second.max_distance),
                  {budget_nodes},
                  other_effort});
}

}  // namespace odds::query
