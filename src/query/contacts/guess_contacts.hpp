// Contacts of short budgets from a few pairs of triangles that meet.
#pragma once

#include "query/memory/pair_memory.hpp"
#include "query/posed_meshes.hpp"
#include "query/spending.hpp"

namespace odds::query {

/// A run that may guess begins.
void begin_haste(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, Pair::Implementation& pair) noexcept;

/// Contacts from the pair's hits. They hold, but hardly push: a wrong one moves a body by no more than what nobody need
/// have measured. `known_normal`: of all of them, or null. False: flat faces explain all that was looked at.
bool guess_contacts(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const Vec3* known_normal,
                    const Request& request, Pair::Implementation& pair, Spending& spending) noexcept;

/// Those guessed in earlier runs, as they have moved. False: none are left.
[[nodiscard]] bool recall_guess(const math::Pose& pose_b_in_a, const Request& request,
                                Pair::Implementation& pair) noexcept;

}  // namespace odds::query
