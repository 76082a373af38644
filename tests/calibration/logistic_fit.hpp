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

/// Weights w for which 1 / (1 + exp(-w . x)) has the greatest likelihood, less half of the squares of the weights, each
/// times its `ridge`. Not empty; a ridge for each number, > 0.
[[nodiscard]] std::vector<double> fit_logistic(std::span<const Case> cases, std::span<const double> ridge);
/// The same with one `ridge` for all weights but the first, which belongs to the constant.
[[nodiscard]] std::vector<double> fit_logistic(std::span<const Case> cases, double ridge);

/// -w . x through the logistic function.
[[nodiscard]] double forecast(std::span<const double> weights, std::span<const double> x) noexcept;

}  // namespace odds::calibration
