// Isotonic regression: shares of what happened that ascend with what was said.
#pragma once

#include <vector>

#include "calibration/logistic_fit.hpp"

namespace odds::calibration {

/// Cases of about the same forecast: their means.
struct Level {
  double said = 0.0;
  double seen = 0.0;
};

/// Sorts cases by x[0], parts them into `most` groups of one weight, and pools neighbours until the shares ascend.
[[nodiscard]] std::vector<Level> ascending_levels(std::vector<Case> cases, int most);

/// On the line through the levels; beyond its ends, as at them. Precondition: not empty, ascending.
[[nodiscard]] double level_at(const std::vector<Level>& levels, double said) noexcept;

}  // namespace odds::calibration
