// Where a body that comes along a line first touches another.
#pragma once

#include <optional>

namespace odds::query {

/// Goes from `begin` down to `end` by `step` (> 0) until `collides(place)`, then halves the last step until it is no
/// longer than `precision` (> 0). Returns the last place known to be clear; nothing where it collides at `begin`
/// already, or never. Features thinner than a step may be passed over.
template <class Collides>
[[nodiscard]] std::optional<double> first_touch(double begin, double end, double step, double precision,
                                                const Collides& collides) {
  double clear = begin;
  double hit = begin;
  while (hit > end && !collides(hit)) {
    clear = hit;
    hit -= step;
  }
  if (hit <= end || hit == begin) return std::nullopt;
  while (clear - hit > precision) {
    const double middle = 0.5 * (clear + hit);
    if (middle <= hit || middle >= clear) break;  // neighbouring doubles
    (collides(middle) ? hit : clear) = middle;
  }
  return clear;
}

}  // namespace odds::query
