// Where a table of pairs looks for a pair.
#pragma once

#include <cstdint>

namespace odds::ode {

/// Of an ordered pair of numbers or addresses. Mixed after splitmix64, so that neighbours spread over all places,
/// whether a table takes the lowest bits or a remainder.
[[nodiscard]] inline std::uint64_t hash_of_pair(std::uint64_t first, std::uint64_t second) noexcept {
  std::uint64_t key = first * 0x9e3779b97f4a7c15U ^ second * 0xc2b2ae3d27d4eb4fU;
  key ^= key >> 31U;
  key *= 0xbf58476d1ce4e5b9U;
  return key ^ (key >> 29U);
}
/// Of one number: another one for each, 0 for 0.
[[nodiscard]] inline std::uint64_t mixed(std::uint64_t number) noexcept { return hash_of_pair(number, 0); }
[[nodiscard]] inline std::uint64_t hash_of_pair(const void* first, const void* second) noexcept {
  return hash_of_pair(reinterpret_cast<std::uintptr_t>(first), reinterpret_cast<std::uintptr_t>(second));
}

}  // namespace odds::ode
