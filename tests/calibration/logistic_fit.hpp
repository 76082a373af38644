// Logistic regression by Newton's method.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace odds::calibration {

/// One forecast to be learnt from: numbers, what happened, and how much it counts.
struct Case {
  std::vector<double> x;  ///< of every case as many
  bool happened = false;
  double weight = 1.0;
};

/// Weights w for which 1 / (1 + exp(-w . x)) has the greatest likelihood, less `ridge` / 2 times the squares of all but
/// the first weight (which belongs to the constant). Not empty, and `ridge` > 0.
[[nodiscard]] std::vector<double> fit_logistic(std::span<const Case> cases, double ridge);

/// -w . x through the logistic function.
[[nodiscard]] double forecast(std::span<const double> weights, std::span<const double> x) noexcept;

}  // namespace odds::calibration
