// A search from the roots in instalments: what one run that its budget ends leaves for the next.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "query/wide/few_leaf_pairs.hpp"

namespace odds::query::wide {

/// A search that always begins at the roots, and is always ended soon, looks at the same beginning each time, and may
/// never come to where the bodies touch. So it is gone on with where the last one was ended, at another pose, and the
/// pairs of leaves that met are looked at first, some in each run. What is open may be of poses some runs ago: only a
/// search that began at the roots in the same run proves that nothing meets.
///
/// Only for a while after a search from the roots has found nothing: where it does find hits, they come from all over
/// the rim. Also after a proof that nothing meets, for what hops touches there again. No allocation.
struct Sweep {
  using MetLeaves = FewLeafPairs<16>;
  static constexpr int a_while = 32;  ///< runs
  /// A pair as OpenPairs has it.
  struct Open {
    std::uint32_t opened;
    std::uint32_t other;
  };
  static constexpr std::size_t most_open = 256;
  static constexpr std::size_t most_leaf_pairs = 56;

  void forget() noexcept {
    met.forget();
    open_count = leaf_pair_count = 0;
    runs_left = 0;
  }

  MetLeaves met;
  MetLeaves looked_at;               ///< of those, in the run that is under way
  std::array<Open, most_open> open;  ///< oldest first
  std::array<TwoLeafSlots, most_leaf_pairs> leaf_pairs;
  std::size_t open_count = 0;
  std::size_t leaf_pair_count = 0;
  int runs_left = 0;  ///< in instalments
};

}  // namespace odds::query::wide
