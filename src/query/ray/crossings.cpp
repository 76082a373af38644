#include "query/ray/crossings.hpp"

#include "query/ray/ray_length.hpp"
#include "query/wide/searches.hpp"

namespace odds::query {
namespace {

constexpr double same_crossing = 10.0 * primitive::WatertightRay::no_area_is_farther;

/// How much of the ray's way lies before where it can meet the tree; not a number where it meets nothing.
double way_before(const tree::WideTree& tree, const Vec3& local, const Vec3& direction) noexcept {
  return is_far_off(tree.reach(), local.norm()) ? skipped_way(tree.reach(), local, direction) : 0.0;
}

}  // namespace

Crossings::Crossings(const mesh::TriangleMesh& mesh, const tree::WideTree& tree, const Vec3& origin,
                     const Vec3& direction, double length, bool front_only) noexcept
    : mesh_(mesh),
      tree_(tree),
      skipped_(way_before(tree, origin - tree.origin(), direction)),
      origin_(origin - tree.origin() + skipped_ * direction),
      direction_(direction),
      length_(length_within(tree.reach(), origin_.norm(), length - skipped_)),
      ray_(origin + skipped_ * direction, direction, front_only) {}

std::optional<RayHit> Crossings::next(const RayAllowance& allowance, RayEffort& effort) noexcept {
  effort = {};
  if (!(length_ >= 0.0)) return std::nullopt;
  const wide::RayTask task = {mesh_, tree_, origin_, direction_, length_, allowance, effort, &ray_, after_};
  std::optional<RayHit> hit = wide::searches_for(InstructionSet::best)->ray(task);
  if (!hit) return hit;
  after_ = hit->distance * (1.0 + same_crossing) + 1e-300;
  hit->distance += skipped_;
  return hit;
}

}  // namespace odds::query
