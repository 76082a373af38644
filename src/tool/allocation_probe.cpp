// The allocator's entry points, each counted and passed on to glibc's own.
#include "tool/allocation_probe.hpp"

#include <cerrno>
#include <cstddef>

#if defined(__has_feature)
#define ODDS_HAS_FEATURE(x) __has_feature(x)
#else
#define ODDS_HAS_FEATURE(x) 0
#endif

// The sanitizers put their own allocator in this place.
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && \
    !ODDS_HAS_FEATURE(address_sanitizer) && !ODDS_HAS_FEATURE(thread_sanitizer) && !ODDS_HAS_FEATURE(memory_sanitizer)
#define ODDS_COUNT_ALLOCATIONS 1
#else
#define ODDS_COUNT_ALLOCATIONS 0
#endif

#if ODDS_COUNT_ALLOCATIONS

namespace {
// In the program's own block of thread-local memory: reaching it allocates nothing.
__attribute__((tls_model("initial-exec"))) thread_local std::uint64_t count = 0;
}  // namespace

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

// operator new of the standard library calls these, too. Memory is given back by glibc's free as ever.
void* malloc(std::size_t size) {
  ++count;
  return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) {
  ++count;
  return __libc_calloc(number, size);
}
void* realloc(void* memory, std::size_t size) {
  ++count;
  return __libc_realloc(memory, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  ++count;
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++count;
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  const bool power_of_two = alignment != 0 && (alignment & (alignment - 1)) == 0;
  if (!power_of_two || alignment % sizeof(void*) != 0) return EINVAL;
  ++count;
  *memory = __libc_memalign(alignment, size);
  return *memory != nullptr ? 0 : ENOMEM;
}
}

#endif

namespace odds::tool {

bool allocations_are_counted() noexcept { return ODDS_COUNT_ALLOCATIONS != 0; }

std::uint64_t allocations_of_this_thread() noexcept {
#if ODDS_COUNT_ALLOCATIONS
  return count;
#else
  return 0;
#endif
}

}  // namespace odds::tool
