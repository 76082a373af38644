// The nearest surface, within what a collision may spend.
#pragma once

#include <optional>

#include "ode/collide/limit.hpp"
#include "ode/mesh/nearest_surface.hpp"

namespace odds::ode {

/// As nearest_surface, until that share of the time. Not `finished`: there may be a nearer one. noexcept, no
/// allocation.
inline std::optional<NearestSurface> nearest_in_time(const PreparedMesh& mesh, const Vec3& point, double reach,
                                                     double share, Limit& limit, bool& finished) noexcept {
  const std::uint64_t nodes = limit.nodes_in_time(share);
  std::uint64_t left = nodes;
  const std::optional<NearestSurface> nearest = nearest_surface(mesh, point, reach, left);
  limit.spend(nodes - left);
  finished = left > 0;
  return nearest;
}

}  // namespace odds::ode
