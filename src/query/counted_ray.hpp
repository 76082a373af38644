// A ray that says what it took and whether it came to its end, for those who work within a budget.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "odds/query/deadline.hpp"
#include "odds/query/ray.hpp"

namespace odds::query {

/// What one ray may take.
struct RayAllowance {
  static constexpr std::uint64_t between_looks = 2;  ///< at the deadline

  std::uint64_t nodes;
  Deadline deadline{};

  /// Before it visits another node.
  [[nodiscard]] bool is_up(std::uint64_t visited) const noexcept {
    return visited >= nodes || (visited % between_looks == between_looks - 1 && deadline());
  }
};

/// `finished`: false if its allowance was up; then what was found need not be the first crossing, nor nothing none.
struct RayEffort {
  std::uint64_t nodes = 0;
  bool finished = true;
};

/// As cast_ray.
[[nodiscard]] std::optional<RayHit> cast_counted_ray(const Shape& shape, const Vec3& origin, const Vec3& direction,
                                                     double max_distance, const RayAllowance& allowance,
                                                     RayEffort& effort) noexcept;

/// One of two rays.
struct CountedRay {
  const Shape& shape;
  Vec3 origin;     ///< shape's frame, metres
  Vec3 direction;  ///< unit
  double max_distance = 0.0;
};

/// What cast_ray of each would give, each within that many nodes; of two shapes of the wide engine, whose searches are
/// taken in turns, in two thirds of the time.
[[nodiscard]] std::array<std::optional<RayHit>, 2> cast_two_rays(const CountedRay& first, const CountedRay& second,
                                                                 std::uint64_t budget_nodes) noexcept;

}  // namespace odds::query
