// The likeliest pairs of nodes among those that a search left undecided.
#pragma once

#include <array>
#include <cstdint>

#include "query/search/bucket_queue.hpp"

namespace odds::query {

/// A few pairs of nodes, in the order in which the search would have gone on. What comes when it is full is left out.
class Shortlist {
 public:
  static constexpr std::uint32_t capacity = 4;  ///< what is made of it waits for memory, and the budget is spent

  void add(const NodePair& pair) noexcept {
    if (size_ < capacity) pairs_[size_++] = pair;
  }
  [[nodiscard]] std::uint32_t size() const noexcept { return size_; }
  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] bool full() const noexcept { return size_ == capacity; }
  /// The pair of the highest rank. Precondition: not empty.
  [[nodiscard]] const NodePair& highest() const noexcept {
    const NodePair* best = begin();
    for (const NodePair& pair : *this) {
      if (pair.rank > best->rank) best = &pair;
    }
    return *best;
  }
  [[nodiscard]] const NodePair* begin() const noexcept { return pairs_.data(); }
  [[nodiscard]] const NodePair* end() const noexcept { return pairs_.data() + size_; }

 private:
  std::array<NodePair, capacity> pairs_;
  std::uint32_t size_ = 0;
};

}  // namespace odds::query
