// How good stated probabilities were, once it is known what happened.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace odds::report {

/// Bounds of a share.
struct Interval {
  double low = 0.0;
  double high = 1.0;
};

/// 95 % confidence interval of a share of which `count` of `total` were seen (Wilson 1927, without continuity
/// correction): sensible for small samples and for none or all seen. [0, 1] for total = 0. Precondition: count <=
/// total.
[[nodiscard]] Interval wilson(std::uint64_t count, std::uint64_t total) noexcept;

/// A stated probability and what happened.
struct Forecast {
  double probability = 0.0;  ///< in [0, 1]
  bool happened = false;
};

/// Forecasts whose probability lies in one tenth of [0, 1]; 1 belongs to the last.
struct ForecastBin {
  std::uint64_t count = 0;
  std::uint64_t happened = 0;
  double probability_sum = 0.0;
  [[nodiscard]] double mean_probability() const noexcept {
    return count > 0 ? probability_sum / static_cast<double>(count) : 0.0;
  }
  [[nodiscard]] double observed() const noexcept {
    return count > 0 ? static_cast<double>(happened) / static_cast<double>(count) : 0.0;
  }
};

/// All NaN-free; zeros if there was no forecast. brier = reliability - resolution + uncertainty + within_bins, exactly
/// (Murphy 1973; the last part, which bins leave over, after Stephenson, Coelho and Jolliffe 2008).
struct ForecastQuality {
  std::uint64_t count = 0;
  std::uint64_t happened = 0;
  double mean_probability = 0.0;
  std::array<ForecastBin, 10> bins{};
  double calibration_error = 0.0;  ///< mean over forecasts of |stated - observed| of their bin ("ECE")
  double brier = 0.0;              ///< mean squared difference of probability and what happened (0 or 1)
  double reliability = 0.0;        ///< squared distance of stated from observed, 0 is best
  double resolution = 0.0;         ///< how far bins differ from the overall share, more is better
  double uncertainty = 0.0;        ///< of what happened itself: share * (1 - share)
  double within_bins = 0.0;        ///< variance within the bins less twice its covariance with what happened

  [[nodiscard]] double observed() const noexcept {
    return count > 0 ? static_cast<double>(happened) / static_cast<double>(count) : 0.0;
  }
};

/// The sums run in the order given, so that the same forecasts in the same order give the same bits.
[[nodiscard]] ForecastQuality judge_forecasts(std::span<const Forecast> forecasts) noexcept;

}  // namespace odds::report
