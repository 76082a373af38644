// Looking for faults by all processors.
#pragma once

#include <atomic>
#include <cstddef>

#include "odds/tree/for_parts.hpp"

namespace odds::tree {

/// The first index in [0, count) that `is_bad`, or `count` if none is. Processors take `part` indices at a time.
template <class IsBad>
[[nodiscard]] std::size_t first_bad(std::size_t count, std::size_t part, const IsBad& is_bad) {
  std::atomic<std::size_t> first{count};
  for_parts(count, part, [&](std::size_t begin, std::size_t end) {
    std::size_t at = begin;
    while (at != end && !is_bad(at)) ++at;
    if (at == end) return;
    for (std::size_t seen = first; at < seen && !first.compare_exchange_weak(seen, at);) continue;
  });
  return first;
}

}  // namespace odds::tree
