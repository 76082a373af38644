// Arrays of one body side by side in memory of large pages.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>

#include "odds/mesh/shared_array.hpp"

namespace odds::mesh {

/// Memory in large pages, of 2 MiB on Linux.
class LargePages {
 public:
  /// Fewer bytes would leave too much of a page empty.
  static constexpr std::size_t least_bytes = std::size_t{3} << 19U;

  /// Null if the system knows no such pages or has no room, or for fewer than `least_bytes`. The first byte stands at a
  /// multiple of 64; up to half a mebibyte at the end is empty. What does not fill a page to three quarters is in small
  /// ones, as is all of it where the system gives no large ones. May throw bad_alloc. Any thread.
  [[nodiscard]] static std::shared_ptr<std::byte> make(std::size_t bytes);
  /// Once it is filled: small pages are not made large ones later, for whoever reads them would wait meanwhile.
  static void settle(const std::shared_ptr<std::byte>& memory, std::size_t bytes) noexcept;
};

namespace detail {
constexpr std::size_t line = 64;
constexpr std::size_t in_lines(std::size_t bytes) noexcept { return (bytes + line - 1) / line * line; }

template <class T>
void copy_to(std::byte* place, const std::shared_ptr<std::byte>& keeper, SharedArray<T>& array) {
  static_assert(std::is_trivially_destructible_v<T> && alignof(T) <= line);
  T* const first = reinterpret_cast<T*>(place);
  std::uninitialized_copy(array.span().begin(), array.span().end(), first);
  array = SharedArray<T>(std::span<const T>(first, array.size()), keeper);
}
}  // namespace detail

/// Moves arrays that are read together into one block of large pages, those that are read most first; the old elements
/// go one array after the other, unless other copies keep them. A search jumps about in a tree, and in pages of 4 KiB
/// the processor has to look up again where a node is, in the tables of a hypervisor, too. Arrays stay where they are
/// if there are no such pages, or they are too short. May throw bad_alloc, before any is moved.
template <class... T>
void put_side_by_side(SharedArray<T>&... arrays) {
  const std::size_t bytes = (std::size_t{0} + ... + detail::in_lines(arrays.bytes()));
  const std::shared_ptr<std::byte> memory = LargePages::make(bytes);
  if (!memory) return;
  std::byte* place = memory.get();
  const auto move = [&](auto& array) {
    const std::size_t length = detail::in_lines(array.bytes());
    detail::copy_to(place, memory, array);
    place += length;
  };
  (move(arrays), ...);
  LargePages::settle(memory, bytes);
}

}  // namespace odds::mesh
