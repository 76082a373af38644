// Lanes of what every processor of the family has, in which tests may be compiled.
#pragma once

#include <gtest/gtest.h>

#include "query/wide/lanes.hpp"

namespace odds::testing {

using LanesBuiltHere = ::testing::Types<
#if defined(__SSE2__)
    query::lanes::Sse2,
#elif defined(__aarch64__)
    query::lanes::Neon,
#endif
    query::lanes::Portable>;

}  // namespace odds::testing
