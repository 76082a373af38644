// What touches beside flat faces that are known to lie on each other.
#pragma once

#include <cstdint>

#include "query/memory/pair_memory.hpp"
#include "query/posed_meshes.hpp"
#include "query/spending.hpp"

namespace odds::query {

enum class Beside : std::uint8_t {
  nothing,    ///< no other surfaces meet
  something,  ///< pairs of triangles that meet there have been added to the pair's hits: a proof
  unknown,    ///< the budget ended the search
};

/// Looks for other places where the bodies meet, for a part of the budget. Not for a while where bodies that nothing
/// was beside have hardly moved. Of the wide engine alone.
[[nodiscard]] Beside look_beside(const PosedMeshes& meshes, const Request& request, Pair::Implementation& pair,
                                 Spending& spending) noexcept;

}  // namespace odds::query
