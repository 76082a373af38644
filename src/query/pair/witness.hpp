// Pairs of triangles that met in the run before, and mostly meet now: a hit without a search.
#pragma once

#include "query/memory/pair_memory.hpp"
#include "query/posed_meshes.hpp"
#include "query/spending.hpp"

namespace odds::query {

/// The witness of the last incremental hit or, within a short budget, one of the places that were guessed since. True:
/// one still meets, is the pair's hit, and no more are wanted.
[[nodiscard]] bool witness_suffices(const PosedMeshes& meshes, const Request& request, Pair::Implementation& pair,
                                    Spending& spending) noexcept;

/// The first hit of this run, if there is one, is the next one's witness.
void remember_witness(Pair::Implementation& pair) noexcept;

}  // namespace odds::query
