// Percentiles over the ticks in which the exact run has a force.
#include "hard_cases/compare.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace odds::hard_cases {
namespace {

double length(const double* v) { return std::hypot(v[0], v[1], v[2]); }

double percentile_95(std::vector<double> values) {
  const auto rank = static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

int onset(const Figures& figures) {
  for (std::size_t i = 0; i < figures.samples.size(); ++i) {
    if (figures.samples[i].contacts > 0) return static_cast<int>(i);
  }
  return -1;
}

double noise_n(const std::vector<Sample>& samples) {
  double sum = 0.0;
  for (std::size_t i = 2; i < samples.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const double d = samples[i].force_n[k] - 2.0 * samples[i - 1].force_n[k] + samples[i - 2].force_n[k];
      sum += d * d / 6.0;
    }
  }
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(samples.size(), 3) - 2));
}

}  // namespace

void compare(const Figures& exact, double touching_n, Figures& figures) {
  if (exact.samples.size() != figures.samples.size() || exact.samples.empty()) return;
  std::vector<double> sizes;
  std::vector<double> angles;
  double mean_n = 0.0;
  for (std::size_t i = 0; i < exact.samples.size(); ++i) {
    const double* a = exact.samples[i].force_n;
    const double* b = figures.samples[i].force_n;
    const double size = length(a);
    if (size < touching_n) continue;
    mean_n += size;
    sizes.push_back(std::abs(length(b) - size) / size);
    const double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    const double product = size * length(b);
    angles.push_back(product > 0.0 ? std::acos(std::clamp(dot / product, -1.0, 1.0)) * 180.0 / std::numbers::pi
                                   : 180.0);
  }
  if (sizes.size() < 20) return;
  mean_n /= static_cast<double>(sizes.size());
  figures.force_error_p95 = percentile_95(sizes);
  figures.angle_error_p95_deg = percentile_95(angles);
  if (onset(exact) >= 0 && onset(figures) >= 0) figures.onset_ticks = onset(figures) - onset(exact);
  figures.noise_share = std::max(0.0, noise_n(figures.samples) - noise_n(exact.samples)) / mean_n;
}

}  // namespace odds::hard_cases
