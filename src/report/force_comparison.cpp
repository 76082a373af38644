// Figures of two runs of one scene.
#include "odds/report/force_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace odds::report {
namespace {

constexpr double noise_from_hz = 50.0;
constexpr double highest_share_of_rate = 0.49;  // of the filter's frequency; at half the rate nothing would pass
constexpr std::size_t quiet_ticks = 5;
constexpr std::ptrdiff_t onset_within = 20;

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(share * static_cast<double>(values.size()))) - 1;
  const auto at = values.begin() + std::clamp<std::ptrdiff_t>(rank, 0, std::ssize(values) - 1);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Second-order Butterworth high-pass by the bilinear transform: 3 dB at its frequency, 12 dB an octave below.
class HighPass {
 public:
  HighPass(double frequency_hz, double rate_hz) {
    const double k = std::tan(std::numbers::pi * std::min(frequency_hz / rate_hz, highest_share_of_rate));
    const double norm = 1.0 / (1.0 + std::numbers::sqrt2 * k + k * k);
    gain_ = norm;
    a1_ = 2.0 * (k * k - 1.0) * norm;
    a2_ = (1.0 - std::numbers::sqrt2 * k + k * k) * norm;
  }
  Vec3 operator()(const Vec3& x) {
    const Vec3 y = gain_ * (x - 2.0 * x1_ + x2_) - a1_ * y1_ - a2_ * y2_;
    x2_ = x1_;
    x1_ = x;
    y2_ = y1_;
    y1_ = y;
    return y;
  }

 private:
  double gain_ = 1.0;
  double a1_ = 0.0;
  double a2_ = 0.0;
  Vec3 x1_ = Vec3::Zero();
  Vec3 x2_ = Vec3::Zero();
  Vec3 y1_ = Vec3::Zero();
  Vec3 y2_ = Vec3::Zero();
};

// Squares of the force's fast part, tick by tick.
std::vector<double> fast_power(std::span<const ForceSample> samples, double rate_hz) {
  HighPass filter(noise_from_hz, rate_hz);
  std::vector<double> power;
  power.reserve(samples.size());
  for (const ForceSample& sample : samples) power.push_back(filter(sample.force_n).squaredNorm());
  return power;
}

double angle_deg(const Vec3& a, const Vec3& b) {
  if (!(a.norm() > 0.0) || !(b.norm() > 0.0)) return 180.0;
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / std::numbers::pi;
}

std::vector<std::ptrdiff_t> onsets(std::span<const ForceSample> samples) {
  std::vector<std::ptrdiff_t> found;
  std::size_t quiet = quiet_ticks;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples[i].contacts == 0) {
      ++quiet;
      continue;
    }
    if (quiet >= quiet_ticks) found.push_back(static_cast<std::ptrdiff_t>(i));
    quiet = 0;
  }
  return found;
}

// Each onset of the exact run against the nearest first contact of the other, quiet before or not.
void compare_onsets(std::span<const ForceSample> exact, std::span<const ForceSample> run, ForceDifference& figures) {
  std::vector<double> apart;
  for (const std::ptrdiff_t at : onsets(exact)) {
    ++figures.onsets;
    std::optional<std::ptrdiff_t> nearest;
    for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, at - onset_within);
         i <= std::min(std::ssize(run) - 1, at + onset_within); ++i) {
      const auto here = static_cast<std::size_t>(i);
      const bool begins = run[here].contacts > 0 && (i == 0 || run[here - 1].contacts == 0);
      if (begins && (!nearest || std::abs(i - at) < std::abs(*nearest - at))) nearest = i;
    }
    if (nearest) {
      apart.push_back(static_cast<double>(std::abs(*nearest - at)));
    } else {
      ++figures.onsets_missed;
    }
  }
  if (!apart.empty()) figures.onset_p99_ticks = percentile(std::move(apart), 0.99);
}

}  // namespace

std::string noise_band(double rate_hz) {
  return fmt::format("{:.3g}-{:.4g} Hz", std::min(noise_from_hz, highest_share_of_rate * rate_hz), 0.5 * rate_hz);
}

std::vector<ForceSample> force_samples(std::span<const haptics::TickRecord> ticks, std::int64_t period_ns) {
  std::vector<ForceSample> samples;
  samples.reserve(ticks.size());
  for (const haptics::TickRecord& tick : ticks) {
    samples.push_back({1e-9 * static_cast<double>(tick.tick) * static_cast<double>(period_ns),
                       Vec3(tick.force_n[0], tick.force_n[1], tick.force_n[2]), tick.contacts});
  }
  return samples;
}

ForceDifference compare_forces(std::span<const ForceSample> exact, std::span<const ForceSample> run, double touching_n,
                               double rate_hz) {
  ForceDifference figures;
  const std::size_t count = std::min(exact.size(), run.size());
  exact = exact.first(count);
  run = run.first(count);
  const std::vector<double> exact_power = fast_power(exact, rate_hz);
  const std::vector<double> run_power = fast_power(run, rate_hz);
  std::vector<double> errors;
  std::vector<double> angles;
  double exact_sum = 0.0;
  double run_sum = 0.0;
  bool missed = false;
  for (std::size_t i = 0; i < count; ++i) {
    const double size = exact[i].force_n.norm();
    // A hand feels its tool's weight and drag also where nothing touches.
    const bool touches = size >= touching_n && exact[i].contacts > 0;
    const bool missed_before = std::exchange(missed, touches && run[i].contacts == 0);
    if (missed && missed_before) ++figures.missed_in_row;
    if (!(size >= touching_n)) {
      figures.largest_false_n = std::max(figures.largest_false_n, (run[i].force_n - exact[i].force_n).norm());
      continue;
    }
    errors.push_back(std::abs(run[i].force_n.norm() - size) / size);
    angles.push_back(angle_deg(exact[i].force_n, run[i].force_n));
    figures.mean_force_n += size;
    exact_sum += exact_power[i];
    run_sum += run_power[i];
  }
  compare_onsets(exact, run, figures);
  figures.ticks = errors.size();
  if (errors.empty()) return figures;
  const auto ticks = static_cast<double>(errors.size());
  figures.mean_force_n /= ticks;
  figures.noise_share = std::sqrt(run_sum / ticks) / figures.mean_force_n;
  figures.added_noise_share = std::sqrt(std::max(0.0, run_sum - exact_sum) / ticks) / figures.mean_force_n;
  figures.error_p50 = percentile(errors, 0.5);
  figures.error_p95 = percentile(std::move(errors), 0.95);
  figures.angle_p50_deg = percentile(angles, 0.5);
  figures.angle_p95_deg = percentile(std::move(angles), 0.95);
  return figures;
}

}  // namespace odds::report
