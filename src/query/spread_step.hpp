// An order in which every beginning is a sample of all.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace odds::query {

/// A step through 0 .. count-1 that visits all, spread out from the start, so that what a short budget leaves is a
/// sample: the golden section, made coprime. At least 1.
[[nodiscard]] inline std::size_t spread_step(std::size_t count) noexcept {
  auto step = static_cast<std::size_t>(0.618 * static_cast<double>(count));
  while (step > 1 && std::gcd(step, count) != 1) --step;
  return std::max<std::size_t>(step, 1);
}

}  // namespace odds::query
