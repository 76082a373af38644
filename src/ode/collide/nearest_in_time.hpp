// The nearest surface, within what a collision may spend.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "ode/collide/end_of_share.hpp"
#include "ode/collide/limit.hpp"
#include "ode/mesh/nearest_surface.hpp"
#include "query/counted_ray.hpp"

namespace odds::ode {

/// What of a search that its time ends is of use.
enum class Wanted : std::uint8_t {
  nothing,      ///< only what is surely the nearest
  what_is_met,  ///< also what was met until then
  something,    ///< the same, and a little longer if it takes that to meet anything
};

/// For the ray that tells the side of what may not be the nearest. Where that takes until the budget is gone, the side
/// stays unknown, unless there would be nothing then.
[[nodiscard]] inline query::RayAllowance ray_to_tell_side(Wanted wanted, Limit& limit) noexcept {
  constexpr std::uint64_t most_nodes = 24;
  if (wanted == Wanted::nothing) return {0};
  return {most_nodes, wanted == Wanted::something ? query::Deadline() : limit.past()};
}

/// The way, unit, to a point from a place of the surface that may not be the nearest: that of the surface there, if it
/// faces the point, and straight from the place if it does so from its side only. On a smooth surface the former is
/// nearly right, where the latter leads aside and would push so.
[[nodiscard]] inline Vec3 way_from_any(const Vec3& place, const Vec3& normal, const Vec3& point) noexcept {
  constexpr double faces = 0.7;  // cosine
  const Vec3 straight = (point - place).normalized();
  const double facing = normal.dot(straight);
  return std::abs(facing) > faces ? Vec3(std::copysign(1.0, facing) * normal) : straight;
}

/// As nearest_surface, until that share of the time. Not `finished`: there may be a nearer one. noexcept, no
/// allocation.
[[nodiscard]] inline std::optional<NearestSurface> nearest_in_time(const PreparedMesh& mesh, const Vec3& point,
                                                                   double reach, double share, Wanted wanted,
                                                                   Limit& limit, bool& finished,
                                                                   std::uint32_t guess = query::no_feature) noexcept {
  const std::uint64_t nodes = limit.nodes_left();
  std::uint64_t left = nodes;
  EndOfShare end(limit, share, 0);
  const auto nearest = nearest_surface(mesh, point, reach, guess, end.deadline(),
                                       wanted == Wanted::something ? EndOfShare::to_a_triangle : 0,
                                       ray_to_tell_side(wanted, limit), left, finished);
  limit.spend(nodes - left);
  return nearest;
}

}  // namespace odds::ode
