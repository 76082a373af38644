// A ring of fixed size between exactly one writing and one reading thread, without locks.
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace odds::realtime {

/// Lamport's single-producer single-consumer ring with each side's index on a cache line of its own, and a remembered
/// copy of the other side's so that it is read only when the ring looks full or empty. All memory is allocated and
/// written at construction. Synchronised by acquire and release on the indices alone: a thread sanitizer can follow it.
template <class Record>
requires std::is_trivially_copyable_v<Record>
class SpscRing {
 public:
  /// Holds at least `capacity` records, rounded up to a power of two.
  explicit SpscRing(std::size_t capacity)
      : slots_(std::bit_ceil(capacity > 0 ? capacity : 1)), mask_(slots_.size() - 1) {}

  [[nodiscard]] std::size_t capacity() const noexcept { return slots_.size(); }

  /// By the writing thread. False if the ring is full. Wait-free; neither allocates nor makes a system call.
  bool try_push(const Record& record) noexcept {
    const std::size_t at = written_.index.load(std::memory_order_relaxed);
    if (at - written_.seen_of_other == slots_.size()) {
      written_.seen_of_other = read_.index.load(std::memory_order_acquire);
      if (at - written_.seen_of_other == slots_.size()) return false;
    }
    slots_[at & mask_] = record;
    written_.index.store(at + 1, std::memory_order_release);
    return true;
  }

  /// By the reading thread. False if the ring is empty. Wait-free.
  bool try_pop(Record& record) noexcept {
    const std::size_t at = read_.index.load(std::memory_order_relaxed);
    if (at == read_.seen_of_other) {
      read_.seen_of_other = written_.index.load(std::memory_order_acquire);
      if (at == read_.seen_of_other) return false;
    }
    record = slots_[at & mask_];
    read_.index.store(at + 1, std::memory_order_release);
    return true;
  }

 private:
  /// One thread's side: only that thread writes it.
  struct alignas(64) Side {
    std::atomic<std::size_t> index{0};  ///< counts up for ever; wraps with the type
    std::size_t seen_of_other = 0;
  };

  std::vector<Record> slots_;
  std::size_t mask_;
  Side written_;
  Side read_;
};

}  // namespace odds::realtime
