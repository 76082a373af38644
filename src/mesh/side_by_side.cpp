// Large pages of Linux, asked for by advice.
#include "odds/mesh/side_by_side.hpp"

#include <sys/mman.h>

#include <cstdint>
#include <utility>

namespace odds::mesh {
namespace {

constexpr std::size_t large_page = std::size_t{2} << 20U;
// What a last page may leave empty, so that it is a large one, too.
constexpr std::size_t most_empty = large_page / 4;

std::size_t with_last_page(std::size_t bytes) noexcept {
  const std::size_t beyond = bytes % large_page;
  return beyond >= large_page - most_empty ? bytes - beyond + large_page : bytes;
}

}  // namespace

std::shared_ptr<std::byte> LargePages::make(std::size_t bytes) {
#if defined(MADV_HUGEPAGE)
  if (bytes < least_bytes) return nullptr;
  // Room for a first byte at a multiple of a large page; what is beside the block takes addresses, no memory.
  const std::size_t length = with_last_page(bytes);
  const std::size_t mapped = length + large_page;
  void* const memory = ::mmap(nullptr, mapped, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return nullptr;
  std::shared_ptr<void> keeper(memory, [mapped](void* first) { ::munmap(first, mapped); });
  const auto before = reinterpret_cast<std::uintptr_t>(memory) % large_page;
  std::byte* const first = static_cast<std::byte*>(memory) + (before == 0 ? 0 : large_page - before);
  if (::madvise(first, length, MADV_HUGEPAGE) != 0) return nullptr;
  return {std::move(keeper), first};
#else
  static_cast<void>(bytes);
  return nullptr;
#endif
}

void LargePages::settle(const std::shared_ptr<std::byte>& memory, std::size_t bytes) noexcept {
#if defined(MADV_NOHUGEPAGE)
  ::madvise(memory.get(), with_last_page(bytes), MADV_NOHUGEPAGE);
#else
  static_cast<void>(memory);
  static_cast<void>(bytes);
#endif
}

}  // namespace odds::mesh
