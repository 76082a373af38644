// Contacts within a budget that is too short for a patch: late ones, or guesses until there are some.
#pragma once

#include <cstdint>

#include "query/memory/pair_memory.hpp"
#include "query/posed_meshes.hpp"
#include "query/spending.hpp"

namespace odds::query {

/// Whether contacts are made over several runs (Request::late_contacts).
[[nodiscard]] bool is_short(const Request& request, const Pair::Implementation& pair) noexcept;

/// A run has not had the time for all contacts: those that follow share it.
void note_unfinished(const Request& request, Pair::Implementation& pair) noexcept;

/// Hits that a search of such a run is asked for.
[[nodiscard]] std::uint32_t hits_of_a_guess(const Request& request, const Pair::Implementation& pair) noexcept;

/// The contacts of flat faces that lie on each other, or else of earlier poses, proved by a pair of triangles that met
/// before and meets now, while the work on those of now goes on. False if there are none, or they are of no use.
[[nodiscard]] bool carry_late_contacts(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const Request& request,
                                       Pair::Implementation& pair, Spending& spending) noexcept;

/// The same, proved by the pair's hits; where they are of no use, contacts that are guessed from those. `known_normal`:
/// the direction, or null. All in A's mesh frame.
void make_contacts_over_runs(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const Vec3* known_normal,
                             const Request& request, Pair::Implementation& pair, Spending& spending) noexcept;

/// At the end of a run: what has become of no use is dropped, where there is time, for others to use its memory.
void settle_late(const Request& request, Pair::Implementation& pair, Spending& spending) noexcept;

}  // namespace odds::query
