// Open addressing in two tables that change places with each frame, so that nothing is ever removed from either.
#include "ode/frame/frame_pairs.hpp"

#include <bit>
#include <functional>
#include <utility>

#include "ode/pair_hash.hpp"

namespace odds::ode {
namespace {

// The entry of that pair and frame, or the free one where it belongs.
FramePair& find(std::vector<FramePair>& slots, dGeomID a, dGeomID b, std::uint64_t frame) noexcept {
  const std::size_t mask = slots.size() - 1;
  std::size_t i = hash_of_pair(a, b) & mask;
  while (slots[i].seen == frame && (slots[i].a != a || slots[i].b != b)) i = (i + 1) & mask;
  return slots[i];
}

}  // namespace

FramePairs::FramePairs(std::size_t most_pairs)
    : now_(std::bit_ceil(2 * most_pairs)), before_(std::bit_ceil(2 * most_pairs)) {}

void FramePairs::begin_frame() noexcept {
  ++frame_;
  now_.swap(before_);
}

FramePair& FramePairs::at(dGeomID a, dGeomID b) noexcept {
  if (std::less<>()(b, a)) std::swap(a, b);
  FramePair& entry = find(now_, a, b, frame_);
  if (entry.seen == frame_) return entry;
  const FramePair& known = find(before_, a, b, frame_ - 1);
  if (known.seen == frame_ - 1) {
    entry = known;
  } else {
    entry = FramePair{};
    entry.a = a;
    entry.b = b;
    entry.served = frame_ - 1;
  }
  entry.seen = frame_;
  return entry;
}

void FramePairs::forget_needs() noexcept {
  for (FramePair& entry : now_) entry.need = FrameNeed();
}

}  // namespace odds::ode
