// Counts this program's calls of the memory allocator, thread by thread: what lets a report say "zero allocations".
#pragma once

#include <cstdint>

namespace odds::tool {

/// Whether the allocator of this build can be watched (glibc, no sanitizer).
[[nodiscard]] bool allocations_are_counted() noexcept;

/// Calls of malloc, calloc, realloc, free-less kin and operator new by the calling thread since it began, in this
/// program and in every library that it uses. 0 where they are not counted.
[[nodiscard]] std::uint64_t allocations_of_this_thread() noexcept;

}  // namespace odds::tool
