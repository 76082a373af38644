// The contact of one pair of triangles, for those who want a single contact and want it soon.
#pragma once

#include <optional>

#include "query/patch/eight.hpp"

namespace odds::query::patch {

/// What PatchBuilder makes of the first hit alone, if no ray is cast and nothing is believed of the depth, in a fifth
/// of the time: what that does with eight pairs at a time is done here along eight directions. Nothing if the pair
/// needs more care: if its indices or coordinates are not in range or not finite, if it meets in a point or in a face,
/// or as a wall on a wall.
[[nodiscard]] std::optional<Contact> contact_of_one_pair(const PatchInput& input, const Kernels& kernels) noexcept;

}  // namespace odds::query::patch
