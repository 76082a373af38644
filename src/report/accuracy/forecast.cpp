// Scores of stated probabilities.
#include "odds/report/accuracy/forecast.hpp"

#include <algorithm>
#include <cmath>

namespace odds::report {
namespace {

constexpr double quantile = 1.959963984540054;  ///< of the normal distribution at 97.5 %

std::size_t bin_of(double probability) noexcept {
  constexpr std::size_t last = 9;
  return std::min(last, static_cast<std::size_t>(std::max(0.0, probability) * 10.0));
}

double outcome(const Forecast& forecast) noexcept { return forecast.happened ? 1.0 : 0.0; }

}  // namespace

Interval wilson(std::uint64_t count, std::uint64_t total) noexcept {
  if (total == 0) return {};
  const auto n = static_cast<double>(total);
  const double share = static_cast<double>(count) / n;
  const double squared = quantile * quantile;
  const double middle = (share + squared / (2.0 * n)) / (1.0 + squared / n);
  const double half = quantile * std::sqrt(share * (1.0 - share) / n + squared / (4.0 * n * n)) / (1.0 + squared / n);
  // The ends that the formula gives as 0 and 1 are so exactly, not up to rounding.
  return {count == 0 ? 0.0 : std::max(0.0, middle - half), count == total ? 1.0 : std::min(1.0, middle + half)};
}

ForecastQuality judge_forecasts(std::span<const Forecast> forecasts) noexcept {
  ForecastQuality q;
  if (forecasts.empty()) return q;
  q.count = forecasts.size();
  const auto n = static_cast<double>(q.count);
  for (const Forecast& forecast : forecasts) {
    ForecastBin& bin = q.bins[bin_of(forecast.probability)];
    ++bin.count;
    bin.happened += forecast.happened ? 1 : 0;
    bin.probability_sum += forecast.probability;
    q.happened += forecast.happened ? 1 : 0;
    q.mean_probability += forecast.probability / n;
    q.brier += (forecast.probability - outcome(forecast)) * (forecast.probability - outcome(forecast)) / n;
  }
  const double share = q.observed();
  q.uncertainty = share * (1.0 - share);
  for (const ForecastBin& bin : q.bins) {
    const double weight = static_cast<double>(bin.count) / n;
    const double apart = bin.mean_probability() - bin.observed();
    q.calibration_error += weight * std::abs(apart);
    q.reliability += weight * apart * apart;
    q.resolution += weight * (bin.observed() - share) * (bin.observed() - share);
  }
  for (const Forecast& forecast : forecasts) {
    const ForecastBin& bin = q.bins[bin_of(forecast.probability)];
    const double off = forecast.probability - bin.mean_probability();
    q.within_bins += off * (off - 2.0 * (outcome(forecast) - bin.observed())) / n;
  }
  return q;
}

}  // namespace odds::report
