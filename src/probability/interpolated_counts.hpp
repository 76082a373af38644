// Fractional counts as mixtures of whole ones, and the collision probability from tails: shared by formula and table.
#pragma once

#include <algorithm>
#include <cmath>

#include "odds/probability/balls_into_bins.hpp"

namespace odds::probability {

[[nodiscard]] inline double mix(double at_0, double at_1, double fraction) noexcept {
  return at_0 + fraction * (at_1 - at_0);
}
[[nodiscard]] inline SharedCellTails mix(const SharedCellTails& at_0, const SharedCellTails& at_1,
                                         double fraction) noexcept {
  SharedCellTails mixed;
  for (int x = 0; x <= max_shared_cells; ++x) mixed.at_least[x] = mix(at_0.at_least[x], at_1.at_least[x], fraction);
  return mixed;
}

/// at_whole(cells, a, b) interpolated between the whole numbers about counts.filled_a and counts.filled_b; NaN counts
/// as 0 (as 1 cell). Asks only for the neighbours that matter.
template <class AtWhole>
[[nodiscard]] auto interpolate(const CellCounts& counts, const AtWhole& at_whole) noexcept {
  const int cells = counts.cells >= 1.0 ? static_cast<int>(std::lround(std::fmin(counts.cells, max_cells))) : 1;
  const auto clamped = [cells](double filled) { return filled > 0.0 ? std::fmin(filled, cells) : 0.0; };
  const double a = clamped(counts.filled_a);
  const double b = clamped(counts.filled_b);
  const auto whole_a = static_cast<int>(a);
  const auto whole_b = static_cast<int>(b);
  const auto along_b = [&](int filled_a) {
    const auto at_floor = at_whole(cells, filled_a, whole_b);
    return b > whole_b ? mix(at_floor, at_whole(cells, filled_a, whole_b + 1), b - whole_b) : at_floor;
  };
  const auto at_floor = along_b(whole_a);
  return a > whole_a ? mix(at_floor, along_b(whole_a + 1), a - whole_a) : at_floor;
}

/// max over x of P[c >= x] (1 - (1 - LB)^x). Tails that are 0 take care of x > min(s_A, s_B).
[[nodiscard]] inline double likeliest_collision(const SharedCellTails& tails, double lower_bound) noexcept {
  const double miss = lower_bound > 0.0 ? 1.0 - std::fmin(lower_bound, 1.0) : 1.0;
  double all_miss = 1.0;
  double likeliest = 0.0;
  for (int x = 1; x <= max_shared_cells; ++x) {
    all_miss *= miss;
    likeliest = std::max(likeliest, tails.at_least[x] * (1.0 - all_miss));
  }
  return likeliest;
}

}  // namespace odds::probability
