// All that the wide engine may run on; those that this build or processor lacks are left out where they are asked for.
#pragma once

#include <array>
#include <string_view>

#include "odds/query/pair.hpp"

namespace odds::testing {

/// The portable one, which is everywhere, first.
inline constexpr std::array instruction_sets = {query::InstructionSet::portable, query::InstructionSet::sse2,
                                                query::InstructionSet::neon, query::InstructionSet::avx2,
                                                query::InstructionSet::avx512};
inline constexpr std::array<std::string_view, 5> instruction_set_names = {"portable", "sse2", "neon", "avx2", "avx512"};

/// Empty for the best.
[[nodiscard]] constexpr std::string_view name(query::InstructionSet set) {
  for (std::size_t i = 0; i < instruction_sets.size(); ++i) {
    if (instruction_sets[i] == set) return instruction_set_names[i];
  }
  return {};
}

}  // namespace odds::testing
