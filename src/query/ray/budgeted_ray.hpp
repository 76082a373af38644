// A ray out of what a query has left of its budget.
#pragma once

#include <cstdint>
#include <limits>

#include "odds/query/ray.hpp"
#include "odds/query/shape.hpp"
#include "query/spending.hpp"

namespace odds::query {

enum class Seen : std::uint8_t {
  surface,
  none,
  unknown,  ///< there was no time, or no work, to look to the end
};

/// No ray within a time visits more.
inline constexpr std::uint64_t most_nodes_of_a_ray = 256;

/// As cast_ray. It is not begun unless there is time for contacts (Spending::reserve_for_contacts) and some work left;
/// within a time it ends in less than 2 us; a node counts as a unit of work.
[[nodiscard]] Seen cast_budgeted_ray(const Shape& shape, const Vec3& point, const Vec3& direction, double length,
                                     Spending& spending, RayHit& found) noexcept;

/// The cosine between a direction and the outward normal of a triangle of the shape; 0 of one without an area.
[[nodiscard]] double facing(const Shape& shape, std::uint32_t triangle, const Vec3& direction) noexcept;

}  // namespace odds::query
