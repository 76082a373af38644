// What a pair answers where no surfaces meet: apart, or one wholly within the other.
#pragma once

#include "query/memory/pair_memory.hpp"
#include "query/posed_meshes.hpp"
#include "query/spending.hpp"

namespace odds::query {

/// No surfaces meet, and, where solids are asked for, neither lies within the other.
void note_clear(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const Request& request,
                Pair::Implementation& pair) noexcept;

/// Where no surfaces meet, and solids are asked for: whether one shape lies within the other all the same. `reaches`
/// from the trees' origins; `same`: no surface has been crossed since `pair.within` was last looked at. False if not;
/// then the answer stands.
[[nodiscard]] bool answer_within(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const Request& request,
                                 const math::Reaches& reaches, bool same, Pair::Implementation& pair,
                                 Spending& spending) noexcept;

}  // namespace odds::query
