// Every crossing of a ray with a mesh, one after another.
#pragma once

#include <optional>

#include "odds/mesh/triangle_mesh.hpp"
#include "odds/query/ray.hpp"
#include "odds/tree/wide_tree.hpp"
#include "primitive/watertight_ray.hpp"
#include "query/counted_ray.hpp"

namespace odds::query {

/// Nearest first. The ray slips through no edge (see WatertightRay); crossings nearer to each other than 1e-10 of their
/// distance are one, as the neighbours of a common edge both meet it. Mesh and tree must outlive it.
class Crossings {
 public:
  /// Mesh's frame, metres: `origin` finite, `direction` of unit length, `length` >= 0, infinite for no end.
  /// `front_only`: triangles met from behind do not count.
  Crossings(const mesh::TriangleMesh& mesh, const tree::WideTree& tree, const Vec3& origin, const Vec3& direction,
            double length, bool front_only) noexcept;

  /// The next one; nothing if there is none. Where `effort` says that the allowance was up, there may be others before
  /// what is given. noexcept, no allocation.
  [[nodiscard]] std::optional<RayHit> next(const RayAllowance& allowance, RayEffort& effort) noexcept;

 private:
  const mesh::TriangleMesh& mesh_;
  const tree::WideTree& tree_;
  double skipped_;  ///< of the ray's way, before `origin_`
  Vec3 origin_;     ///< tree's frame
  Vec3 direction_;
  double length_;  ///< from `origin_`
  primitive::WatertightRay ray_;
  double after_ = -1.0;  ///< from `origin_`
};

}  // namespace odds::query
