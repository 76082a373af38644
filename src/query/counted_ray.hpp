// A ray that says what it took and whether it came to its end, for those who work within a budget.
#pragma once

#include <cstdint>
#include <optional>

#include "odds/query/ray.hpp"

namespace odds::query {

/// `finished`: false if the nodes ran out; then what was found need not be the first crossing, nor nothing none.
struct RayEffort {
  std::uint64_t nodes = 0;
  bool finished = true;
};

/// As cast_ray.
[[nodiscard]] std::optional<RayHit> cast_counted_ray(const Shape& shape, const Vec3& origin, const Vec3& direction,
                                                     double max_distance, std::uint64_t budget_nodes,
                                                     RayEffort& effort) noexcept;

}  // namespace odds::query
