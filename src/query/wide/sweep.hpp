// A search from the roots in instalments: what one run that its budget ends leaves for the next.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "odds/tree/wide_tree.hpp"

namespace odds::query::wide {

/// A few pairs of leaves, each once.
class MetLeaves {
 public:
  struct Entry {
    tree::Slot a = 0;
    tree::Slot b = 0;

    [[nodiscard]] bool operator==(const Entry&) const noexcept = default;
  };
  static constexpr std::size_t most = 16;

  void forget() noexcept { count_ = 0; }
  [[nodiscard]] std::span<const Entry> pairs() const noexcept { return std::span(pairs_).first(count_); }
  [[nodiscard]] bool has(const Entry& entry) const noexcept {
    return std::find(pairs().begin(), pairs().end(), entry) != pairs().end();
  }
  /// Full, it stays as it is.
  void note(const Entry& entry) noexcept {
    if (count_ != most && !has(entry)) pairs_[count_++] = entry;
  }

 private:
  std::array<Entry, most> pairs_;
  std::size_t count_ = 0;
};

/// A search that always begins at the roots, and is always ended soon, looks at the same beginning each time, and may
/// never come to where the bodies touch. So it is gone on with where the last one was ended, at another pose, and the
/// pairs of leaves that met are looked at first, some in each run. What is open may be of poses some runs ago: only a
/// search that began at the roots in the same run proves that nothing meets.
///
/// Only for a while after a search from the roots has found nothing: where it does find hits, they come from all over
/// the rim. No allocation.
struct Sweep {
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
  std::array<MetLeaves::Entry, most_leaf_pairs> leaf_pairs;
  std::size_t open_count = 0;
  std::size_t leaf_pair_count = 0;
  int runs_left = 0;  ///< in instalments
};

}  // namespace odds::query::wide
