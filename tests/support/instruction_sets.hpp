// All that the wide engine may run on; those that this build or processor lacks are left out where they are asked for.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <string_view>

#include "odds/query/pair.hpp"
#include "query/wide/lanes.hpp"
#include "query/wide/searches.hpp"

namespace odds::testing {

/// The portable one, which is everywhere, first.
inline constexpr std::array instruction_sets = {query::InstructionSet::portable, query::InstructionSet::sse2,
                                                query::InstructionSet::neon, query::InstructionSet::avx2,
                                                query::InstructionSet::avx512};

/// "avx2"; empty where it is not there.
[[nodiscard]] inline std::string_view name(query::InstructionSet set) {
  const query::wide::Searches* const searches = query::wide::searches_for(set);
  return searches == nullptr ? std::string_view() : std::string_view(searches->instruction_set);
}

/// Lanes of what every processor of the family has, in which tests may be compiled.
using LanesBuiltHere = ::testing::Types<
#if defined(__SSE2__)
    query::lanes::Sse2,
#elif defined(__aarch64__)
    query::lanes::Neon,
#endif
    query::lanes::Portable>;

}  // namespace odds::testing
