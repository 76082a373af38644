// The point of a mesh's surface nearest to a point, and on which side of the surface that point is.
#pragma once

#include <cstdint>
#include <optional>

#include "odds/query/contact_patch.hpp"
#include "ode/mesh/prepared_mesh.hpp"
#include "query/counted_ray.hpp"

namespace odds::ode {

struct NearestSurface {
  Vec3 point;       ///< on the surface, mesh frame
  double distance;  ///< metres, >= 0
  std::uint32_t triangle;
  Vec3 outward;  ///< unit pseudo-normal of the surface at `point`; zero if only degenerate triangles meet there
  bool inside;   ///< behind the surface; only ever true for a closed mesh
};

/// Nothing if the surface is farther than `reach` (metres; infinity allowed), or the limits ended the search before any
/// triangle was seen. Each visited node takes one from `units`; if they run out later, or `deadline` says that the time
/// is up, it is not `finished`: what surface_towards gives for the nearest place so far, within `ray`. The
/// deadline is not asked at the first `sure_nodes`, unless a triangle was seen.
/// `guess`: a triangle that may be near, the first of those places; no_feature, or no triangle of the mesh: none.
/// noexcept, no allocation.
[[nodiscard]] std::optional<NearestSurface> nearest_surface(const PreparedMesh& mesh, const Vec3& point, double reach,
                                                            std::uint32_t guess, const query::Deadline& deadline,
                                                            int sure_nodes, const query::RayAllowance& ray,
                                                            std::uint64_t& units, bool& finished) noexcept;

/// What a ray from `point` to a place of `triangle` meets first, which need not be the nearest; its plane tells the
/// side. Nothing if that takes more than `ray` may: of a length that a search has shortened some dozen nodes.
[[nodiscard]] std::optional<NearestSurface> surface_towards(const PreparedMesh& mesh, const Vec3& point,
                                                            const Vec3& place, std::uint32_t triangle,
                                                            const query::RayAllowance& ray) noexcept;

/// The pseudo-normal, as in NearestSurface, at a point of `triangle` that is nearest to `seen_from`.
[[nodiscard]] Vec3 outward_at(const PreparedMesh& mesh, const Vec3& point, std::uint32_t triangle,
                              const Vec3& seen_from) noexcept;

/// Whether `point` is in the mesh's bounding box: a cheap necessary condition for being inside a closed mesh.
[[nodiscard]] bool in_bounds(const PreparedMesh& mesh, const Vec3& point) noexcept;

}  // namespace odds::ode
