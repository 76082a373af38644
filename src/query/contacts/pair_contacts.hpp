// The contacts of a pair's answer.
#pragma once

#include <cstdint>

#include "query/memory/pair_memory.hpp"
#include "query/posed_meshes.hpp"
#include "query/search/search.hpp"

namespace odds::query {

/// Hits that are wanted: one proves; a patch takes as many as its making has time for.
[[nodiscard]] std::uint32_t wanted_hits(const Request& request, const Pair::Implementation& pair) noexcept;

/// Makes the answer's contacts from the pair's hits, within the budget: with care, in a hurry, or roughly. `searched`:
/// how the hits were found; `most_depth`: what is known of the depth, metres.
void make_contacts(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const SearchResult& searched,
                   double most_depth, const Request& request, PatchBuilder& patches, Pair::Implementation& pair,
                   Spending& spending) noexcept;

/// The contacts of an earlier run, where the bodies have hardly moved since: false if they will not do.
[[nodiscard]] bool carry_contacts(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const Request& request,
                                  Pair::Implementation& pair, Spending& spending) noexcept;

/// Whether one of the pairs of triangles that met where the contacts of an earlier run are from meets now: then the
/// answer is a hit.
[[nodiscard]] bool prove_carried(const PosedMeshes& meshes, Pair::Implementation& pair, Spending& spending) noexcept;

}  // namespace odds::query
