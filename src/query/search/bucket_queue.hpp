// The priority queue of the time-critical search: 64 buckets, newest first, fixed capacity.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace odds::query {

/// One pair of nodes that may collide.
struct NodePair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  float rank = 0.0F;  ///< log2 of the expected number of crossings; see Encounter::rank
};

/// Push and pop in constant time: a bucket is a linked stack in one array, and a bit mask knows which are not empty.
/// Within a bucket the newest pair comes first, so that many equally likely pairs are dug into, not searched
/// breadth-first.
class BucketQueue {
 public:
  static constexpr std::uint32_t bucket_count = 64;

  /// Allocates; nothing else does.
  explicit BucketQueue(std::uint32_t capacity) : entries_(capacity) { clear(); }

  void clear() noexcept {
    heads_.fill(none);
    used_ = 0;
    free_ = none;
    mask_ = 0;
    size_ = 0;
  }

  [[nodiscard]] bool empty() const noexcept { return mask_ == 0; }
  [[nodiscard]] std::uint32_t size() const noexcept { return size_; }
  [[nodiscard]] bool full() const noexcept { return size_ == entries_.size(); }

  /// Precondition: !full(), bucket < bucket_count.
  void push(std::uint32_t bucket, const NodePair& pair) noexcept {
    std::uint32_t slot = free_;
    if (slot != none) {
      free_ = entries_[slot].next;
    } else {
      slot = used_++;
    }
    entries_[slot] = {pair, heads_[bucket]};
    heads_[bucket] = slot;
    mask_ |= std::uint64_t{1} << bucket;
    ++size_;
  }

  /// The newest pair of the highest bucket. Precondition: !empty().
  [[nodiscard]] const NodePair& top() const noexcept { return entries_[heads_[highest()]].pair; }

  /// Gives `take` up to `most` pairs, in the order in which pop() would.
  template <class Take>
  void show_first(std::uint32_t most, const Take& take) const noexcept {
    for (std::uint64_t mask = mask_; mask != 0 && most != 0;) {
      const std::uint32_t bucket = 63U - static_cast<std::uint32_t>(std::countl_zero(mask));
      mask &= ~(std::uint64_t{1} << bucket);
      for (std::uint32_t slot = heads_[bucket]; slot != none && most != 0; slot = entries_[slot].next, --most) {
        take(entries_[slot].pair);
      }
    }
  }

  /// Removes top(). Precondition: !empty().
  NodePair pop() noexcept {
    const std::uint32_t bucket = highest();
    const std::uint32_t slot = heads_[bucket];
    Entry& entry = entries_[slot];
    heads_[bucket] = entry.next;
    if (entry.next == none) mask_ &= ~(std::uint64_t{1} << bucket);
    entry.next = free_;
    free_ = slot;
    --size_;
    return entry.pair;
  }

 private:
  static constexpr std::uint32_t none = 0xFFFFFFFFU;
  struct Entry {
    NodePair pair;
    std::uint32_t next = none;
  };
  [[nodiscard]] std::uint32_t highest() const noexcept {
    return 63U - static_cast<std::uint32_t>(std::countl_zero(mask_));
  }

  std::vector<Entry> entries_;
  std::array<std::uint32_t, bucket_count> heads_{};
  std::uint32_t used_ = 0;
  std::uint32_t free_ = none;
  std::uint64_t mask_ = 0;
  std::uint32_t size_ = 0;
};

}  // namespace odds::query
