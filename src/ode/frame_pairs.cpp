// Open addressing within a short reach.
#include "ode/frame_pairs.hpp"

#include <bit>
#include <functional>
#include <utility>

namespace odds::ode {
namespace {

constexpr std::size_t reach = 32;

std::size_t mix(dGeomID a, dGeomID b) noexcept {
  std::uint64_t key = reinterpret_cast<std::uintptr_t>(a) * 0x9e3779b97f4a7c15U ^
                      reinterpret_cast<std::uintptr_t>(b) * 0xc2b2ae3d27d4eb4fU;
  key ^= key >> 29;
  key *= 0xbf58476d1ce4e5b9U;
  return static_cast<std::size_t>(key ^ (key >> 32));
}

}  // namespace

FramePairs::FramePairs(std::size_t most_pairs) : slots_(std::bit_ceil(4 * most_pairs + reach)) {}

FramePair* FramePairs::at(dGeomID a, dGeomID b, std::uint64_t frame) noexcept {
  if (std::less<>()(b, a)) std::swap(a, b);
  const std::size_t mask = slots_.size() - 1;
  const std::size_t first = mix(a, b);
  FramePair* free = nullptr;
  for (std::size_t i = 0; i < reach; ++i) {
    FramePair& slot = slots_[(first + i) & mask];
    if (slot.a == a && slot.b == b) return &slot;
    if (free == nullptr && (slot.a == nullptr || slot.seen + 1 < frame)) free = &slot;
  }
  if (free != nullptr) {
    *free = FramePair{};
    free->a = a;
    free->b = b;
    free->served = frame - 1;
  }
  return free;
}

}  // namespace odds::ode
