// A few pairs of leaves that a search has looked at, or is to look at.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "odds/tree/wide_tree.hpp"

namespace odds::query::wide {

/// Slots of a leaf of A and of one of B.
struct TwoLeafSlots {
  tree::Slot a = 0;
  tree::Slot b = 0;

  [[nodiscard]] bool operator==(const TwoLeafSlots&) const noexcept = default;
};

/// Each once, in the order in which they came. No allocation.
template <std::size_t capacity>
class FewLeafPairs {
 public:
  static constexpr std::size_t most = capacity;

  void forget() noexcept { count_ = 0; }
  [[nodiscard]] bool is_full() const noexcept { return count_ == most; }
  [[nodiscard]] std::span<const TwoLeafSlots> pairs() const noexcept { return std::span(pairs_).first(count_); }
  [[nodiscard]] bool has(const TwoLeafSlots& pair) const noexcept {
    return std::find(pairs().begin(), pairs().end(), pair) != pairs().end();
  }
  /// Full, it stays as it is.
  void note(const TwoLeafSlots& pair) noexcept {
    if (!is_full() && !has(pair)) pairs_[count_++] = pair;
  }

 private:
  std::array<TwoLeafSlots, most> pairs_;
  std::size_t count_ = 0;
};

}  // namespace odds::query::wide
