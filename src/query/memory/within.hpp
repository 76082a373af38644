// A mesh wholly within a solid: whether it is, and the way out. Where surfaces meet, contact patches tell more.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "odds/math/pose.hpp"
#include "odds/query/answer.hpp"
#include "odds/query/ray.hpp"
#include "odds/query/shape.hpp"
#include "query/spending.hpp"

namespace odds::query {

/// Which of two shapes whose surfaces do not meet lies within the other.
enum class Within : std::uint8_t { neither, b_in_a, a_in_b, unknown };

/// Whether the box of one shape leaves room for a point of the other: the cheap part of `within`, without a ray.
[[nodiscard]] bool may_be_within(const Shape& a, const Shape& b, const math::Pose& b_in_a) noexcept;

/// Where a line from the first vertex of the inner shape leaves the outer one, in the outer one's frame.
struct Exit {
  Vec3 direction = Vec3::Zero();  ///< unit; zero: none is known
  RayHit hit;
};

/// One vertex of each tells: no surface lies between it and the others (of a mesh in one piece). Two opposite rays have
/// to agree, or a third decides; `exit` is where the shortest of those leads that found one within the other. Unknown
/// where the budget ended it: before every ray it is asked whether there is time for contacts, and a node counts as a
/// unit of work. noexcept, no allocation.
[[nodiscard]] Within within(const Shape& a, const Shape& b, const math::Pose& b_in_a, Exit& exit,
                            Spending& spending) noexcept;

/// The contact, in A's mesh frame, along the shortest way by which the inner shape leaves the other, of some
/// directions: the `preferred` ones (unit, A's frame, the motion of B relative to A), which win unless another is much
/// shorter (tolerances::way_it_came), away from the outer mesh's middle, and its axes. If no ray found a way within the
/// budget, that by the `known` exit; nothing if there is none. noexcept, no allocation.
[[nodiscard]] std::optional<Contact> way_out(const Shape& a, const Shape& b, const math::Pose& b_in_a, Within which,
                                             std::span<const Vec3> preferred, const Exit& known,
                                             Spending& spending) noexcept;

}  // namespace odds::query
