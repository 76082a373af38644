// Arithmetic with twice the digits of a double: not exact, but with a known error, and much cheaper than expansions.
#pragma once

#include "odds/math/exact.hpp"

namespace odds::math {

/// a * b with an error below 2^-100 |a b|, unless it underflows.
[[nodiscard]] inline TwoDoubles product(TwoDoubles a, TwoDoubles b) noexcept {
  const TwoDoubles high = two_product(a.high, b.high);
  return fast_two_sum(high.high, high.low + (a.high * b.low + a.low * b.high));
}

/// a + b with an error below 2^-100 (|a| + |b|).
[[nodiscard]] inline TwoDoubles sum(TwoDoubles a, TwoDoubles b) noexcept {
  const TwoDoubles high = two_sum(a.high, b.high);
  return fast_two_sum(high.high, high.low + (a.low + b.low));
}

[[nodiscard]] inline TwoDoubles difference(TwoDoubles a, TwoDoubles b) noexcept { return sum(a, {-b.high, -b.low}); }

}  // namespace odds::math
