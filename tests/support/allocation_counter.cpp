// Interposes glibc's allocation functions; operator new calls malloc, and so is counted too.
#include "support/allocation_counter.hpp"

#include <cerrno>
#include <cstdlib>

namespace odds::support {
namespace {

// Initial-exec storage: reading it never allocates, unlike the dynamic models.
__attribute__((tls_model("initial-exec"))) thread_local bool armed = false;
__attribute__((tls_model("initial-exec"))) thread_local std::size_t allocation_count = 0;
__attribute__((tls_model("initial-exec"))) thread_local std::size_t free_count = 0;

[[maybe_unused]] void count_allocation() noexcept {
  if (armed) ++allocation_count;
}

[[maybe_unused]] void count_free(const void* pointer) noexcept {
  if (armed && pointer != nullptr) ++free_count;
}

}  // namespace

AllocationCounter::AllocationCounter() noexcept
    : allocations_before_(allocation_count), frees_before_(free_count), armed_before_(armed) {
  armed = true;
}

AllocationCounter::~AllocationCounter() { armed = armed_before_; }

std::size_t AllocationCounter::allocations() const noexcept { return allocation_count - allocations_before_; }
std::size_t AllocationCounter::frees() const noexcept { return free_count - frees_before_; }

}  // namespace odds::support

#if defined(__GLIBC__)
// The sanitizers bring their own malloc. The same test as in support/sanitizer.hpp, for the preprocessor.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define ODDS_OWN_MALLOC 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define ODDS_OWN_MALLOC 0
#endif
#endif
#ifndef ODDS_OWN_MALLOC
#define ODDS_OWN_MALLOC 1
#endif

#if ODDS_OWN_MALLOC
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t size) {
  odds::support::count_allocation();
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) {
  odds::support::count_allocation();
  return __libc_calloc(count, size);
}

void* realloc(void* pointer, std::size_t size) {
  odds::support::count_allocation();
  return __libc_realloc(pointer, size);
}

void* memalign(std::size_t alignment, std::size_t size) {
  odds::support::count_allocation();
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  odds::support::count_allocation();
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** result, std::size_t alignment, std::size_t size) {
  odds::support::count_allocation();
  void* memory = __libc_memalign(alignment, size);
  if (memory == nullptr) return ENOMEM;
  *result = memory;
  return 0;
}

void free(void* pointer) {
  odds::support::count_free(pointer);
  __libc_free(pointer);
}
}
#endif
#endif
