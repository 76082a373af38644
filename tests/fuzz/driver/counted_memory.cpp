// The replaced operators. One thread at a time, as in the programs that use them.
#include "counted_memory.hpp"

#include <malloc.h>

#include <algorithm>
#include <cstdlib>
#include <new>

namespace odds::fuzz {
namespace {

std::size_t held = 0;
std::size_t peak = 0;
std::size_t held_at_restart = 0;
std::size_t count = 0;

void* taken(void* memory) noexcept {
  if (memory == nullptr) return nullptr;
  held += ::malloc_usable_size(memory);
  peak = std::max(peak, held);
  ++count;
  return memory;
}

void* take(std::size_t size) {
  void* const memory = taken(std::malloc(size == 0 ? 1 : size));
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

void* take_aligned(std::size_t size, std::align_val_t alignment) {
  const auto step = static_cast<std::size_t>(alignment);
  void* const memory = taken(std::aligned_alloc(step, (size + step - 1) / step * step));
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

void give_back(void* memory) noexcept {
  if (memory == nullptr) return;
  held -= ::malloc_usable_size(memory);
  std::free(memory);
}

}  // namespace

void restart_peak() noexcept {
  peak = held;
  held_at_restart = held;
}
std::size_t peak_bytes() noexcept { return peak - held_at_restart; }
std::size_t allocation_count() noexcept { return count; }

}  // namespace odds::fuzz

void* operator new(std::size_t size) { return odds::fuzz::take(size); }
void* operator new[](std::size_t size) { return odds::fuzz::take(size); }
void* operator new(std::size_t size, std::align_val_t alignment) { return odds::fuzz::take_aligned(size, alignment); }
void* operator new[](std::size_t size, std::align_val_t alignment) { return odds::fuzz::take_aligned(size, alignment); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return odds::fuzz::taken(std::malloc(size == 0 ? 1 : size));
}
void operator delete(void* memory) noexcept { odds::fuzz::give_back(memory); }
void operator delete[](void* memory) noexcept { odds::fuzz::give_back(memory); }
void operator delete(void* memory, std::size_t) noexcept { odds::fuzz::give_back(memory); }
void operator delete[](void* memory, std::size_t) noexcept { odds::fuzz::give_back(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { odds::fuzz::give_back(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { odds::fuzz::give_back(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { odds::fuzz::give_back(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { odds::fuzz::give_back(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { odds::fuzz::give_back(memory); }
