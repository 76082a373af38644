// The wide engine's searches with and without slabs, compiled alike.
#pragma once

#include "query/wide/searches.hpp"

namespace odds::ablation {

/// Null where the processor or the build lacks AVX2.
[[nodiscard]] const query::wide::Searches* searches_with_slabs() noexcept;
[[nodiscard]] const query::wide::Searches* searches_without_slabs() noexcept;

}  // namespace odds::ablation
