// Odds for one pair of bodies: what a pair learns about how true the general ones are for it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "odds/math/tolerances.hpp"
#include "odds/query/pair.hpp"

namespace odds::query {

/// log(p' / (1 - p')) = slope log(p / (1 - p)) + shift. As it is made it changes nothing.
struct Recalibration {
  double slope = 1.0;
  double shift = 0.0;

  /// `p` in [0, 1]; the result is in (0, 1) unless nothing changes.
  [[nodiscard]] double operator()(double p) const noexcept {
    if (slope == 1.0 && shift == 0.0) return p;
    const double q = std::clamp(p, tolerances::least_uncertainty, 1.0 - tolerances::least_uncertainty);
    return 1.0 / (1.0 + std::exp(-(slope * std::log(q / (1.0 - q)) + shift)));
  }
};

/// Learns from `poses` random poses about first touch, each proved once and answered within 64 to 1,024 work units.
/// Nothing is learnt from bodies that never meet, or whose answers are all proved. Deterministic.
[[nodiscard]] Recalibration learn_recalibration(Pair& pair, std::uint32_t poses);

}  // namespace odds::query
