// The contact of one pair of triangles, for those who want a single contact and want it soon.
#pragma once

#include <optional>

#include "query/patch/eight.hpp"

namespace odds::query::patch {

/// What PatchBuilder makes of the first hit alone where no ray is cast and nothing is believed of the depth, but by
/// eight directions at a time, which for one pair takes less than eight pairs at a time do. Precondition: there is a
/// hit. Nothing if the pair needs more care: if its indices or coordinates are not in range or not finite, if it meets
/// in a point or in a face, or as a wall on a wall.
[[nodiscard]] std::optional<Contact> contact_of_one_pair(const PatchInput& input, const Kernels& kernels) noexcept;

}  // namespace odds::query::patch
