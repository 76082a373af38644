#include "calibration/logistic_fit.hpp"

#include <cmath>

#include <Eigen/Dense>

namespace odds::calibration {

double forecast(std::span<const double> weights, std::span<const double> x) noexcept {
  double z = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) z += weights[i] * x[i];
  return 1.0 / (1.0 + std::exp(-z));
}

std::vector<double> fit_logistic(std::span<const Case> cases, std::span<const double> ridge) {
  const auto n = static_cast<Eigen::Index>(cases.front().x.size());
  std::vector<double> weights(cases.front().x.size(), 0.0);
  constexpr int most_steps = 50;
  for (int step = 0; step < most_steps; ++step) {
    const Eigen::Map<const Eigen::VectorXd> held(ridge.data(), n);
    Eigen::MatrixXd curvature = held.asDiagonal();
    Eigen::VectorXd slope = -held.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(weights.data(), n));
    for (const Case& one : cases) {
      const double p = forecast(weights, one.x);
      const Eigen::Map<const Eigen::VectorXd> x(one.x.data(), n);
      slope += one.weight * ((one.happened ? 1.0 : 0.0) - p) * x;
      curvature.selfadjointView<Eigen::Lower>().rankUpdate(x, one.weight * std::max(p * (1.0 - p), 1e-6));
    }
    const Eigen::VectorXd change = curvature.selfadjointView<Eigen::Lower>().ldlt().solve(slope);
    for (Eigen::Index i = 0; i < n; ++i) weights[static_cast<std::size_t>(i)] += change[i];
    if (change.norm() < 1e-8) break;
  }
  return weights;
}

std::vector<double> fit_logistic(std::span<const Case> cases, double ridge) {
  std::vector<double> of_each(cases.front().x.size(), ridge);
  of_each.front() = 1e-9;
  return fit_logistic(cases, of_each);
}

}  // namespace odds::calibration
