// Counts allocations of the calling thread while armed, so that tests can show that a hot path makes none.
#pragma once

#include <cstddef>

#include "support/sanitizer.hpp"

namespace odds::support {

/// Linking allocation_counter.cpp replaces malloc, calloc, realloc, free's counterparts for aligned memory, and thereby
/// operator new, for the whole test program (glibc only). Under a sanitizer nothing is replaced and nothing is counted.
inline constexpr bool counts_allocations = !under_sanitizer;

/// Counts calls that take memory (malloc, calloc, realloc, aligned forms, operator new) by the thread that made this
/// object, while it lives. One may live per thread at a time; the innermost counts. Reading the count does not
/// allocate.
class AllocationCounter {
 public:
  AllocationCounter() noexcept;
  ~AllocationCounter();
  AllocationCounter(const AllocationCounter&) = delete;
  AllocationCounter& operator=(const AllocationCounter&) = delete;

  [[nodiscard]] std::size_t allocations() const noexcept;  ///< 0 for ever where !counts_allocations
  [[nodiscard]] std::size_t frees() const noexcept;        ///< calls of free with a pointer that is not null

 private:
  std::size_t allocations_before_;
  std::size_t frees_before_;
  bool armed_before_;
};

}  // namespace odds::support
