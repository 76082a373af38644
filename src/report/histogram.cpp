// The arithmetic of the buckets.
#include "odds/report/histogram.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

namespace odds::report {
namespace {

constexpr std::int64_t largest_supported = INT64_MAX / 4;  // keeps the bucket arithmetic below free of overflow

int floor_log2(std::int64_t value) noexcept {
  return static_cast<int>(std::bit_width(static_cast<std::uint64_t>(value))) - 1;
}

}  // namespace

Histogram::Histogram(const HistogramRange& range) : range_(range) {
  double resolution = 2.0;
  for (int i = 0; i < range.digits; ++i) resolution *= 10.0;
  unit_magnitude_ = floor_log2(range.lowest);
  half_magnitude_ = std::max(static_cast<int>(std::ceil(std::log2(resolution))), 1) - 1;
  // The first bucket covers [0, sub_buckets << unit_magnitude); each further one doubles the end.
  std::int64_t end = std::int64_t{2} << (half_magnitude_ + unit_magnitude_);
  buckets_ = 1;
  while (end <= range.highest) {
    end *= 2;
    ++buckets_;
  }
  counters_.assign((static_cast<std::size_t>(buckets_) + 1) << half_magnitude_, 0);
}

Result<Histogram> Histogram::make(const HistogramRange& range) {
  if (range.digits < 0 || range.digits > 5) {
    return Error{"", "", "a histogram of " + std::to_string(range.digits) + " significant digits", "use 0 to 5"};
  }
  if (range.lowest < 1 || range.lowest > (std::int64_t{1} << 40)) {
    return Error{"", "", "lowest value " + std::to_string(range.lowest), "use 1 to 2^40"};
  }
  if (range.highest / 2 < range.lowest || range.highest > largest_supported) {
    return Error{"", "", "highest value " + std::to_string(range.highest),
                 "use at least twice the lowest and at most 2^61"};
  }
  return Histogram(range);
}

std::size_t Histogram::counter_of(std::int64_t value) const noexcept {
  const std::int64_t first_bucket_mask = ((std::int64_t{2} << half_magnitude_) - 1) << unit_magnitude_;
  const int bucket = floor_log2(value | first_bucket_mask) - unit_magnitude_ - half_magnitude_;
  const auto sub_bucket = static_cast<std::size_t>(value >> (bucket + unit_magnitude_));
  const std::size_t half = std::size_t{1} << half_magnitude_;
  return ((static_cast<std::size_t>(bucket) + 1) << half_magnitude_) + sub_bucket - half;
}

std::int64_t Histogram::lowest_of(std::size_t counter) const noexcept {
  const std::size_t half = std::size_t{1} << half_magnitude_;
  // Counters below `half` are the lower half of bucket 0; from there on each bucket has only an upper half.
  if (counter < half) return static_cast<std::int64_t>(counter) << unit_magnitude_;
  const int bucket = static_cast<int>(counter >> half_magnitude_) - 1;
  return static_cast<std::int64_t>((counter & (half - 1)) + half) << (bucket + unit_magnitude_);
}

std::int64_t Histogram::highest_of(std::size_t counter) const noexcept { return lowest_of(counter + 1) - 1; }

std::int64_t Histogram::middle_of(std::size_t counter) const noexcept {
  const std::int64_t low = lowest_of(counter);
  return low + (lowest_of(counter + 1) - low) / 2;
}

void Histogram::record(std::int64_t value, std::uint64_t times) noexcept {
  if (times == 0) return;
  const std::int64_t kept = std::clamp<std::int64_t>(value, 0, range_.highest);
  if (value < 0) below_ += times;
  if (value > range_.highest) above_ += times;
  counters_[counter_of(kept)] += times;
  total_ += times;
  max_ = std::max(max_, value);
  min_ = std::min(min_, std::max<std::int64_t>(value, 0));
}

void Histogram::add_to_counter(std::size_t counter, std::uint64_t times) noexcept {
  if (times == 0) return;
  counters_[counter] += times;
  total_ += times;
  max_ = std::max(max_, highest_of(counter));
  min_ = std::min(min_, lowest_of(counter));
}

void Histogram::merge(const Histogram& other) noexcept {
  if (other.total_ == 0) return;
  std::uint64_t beyond = 0;  // what the other held, and this one cannot
  for (std::size_t i = 0; i < other.counters_.size(); ++i) {
    const std::uint64_t times = other.counters_[i];
    if (times == 0) continue;
    counters_[other.range_ == range_ ? i : counter_of(std::min(other.middle_of(i), range_.highest))] += times;
    if (other.lowest_of(i) > range_.highest) beyond += times;
  }
  total_ += other.total_;
  below_ += other.below_;
  above_ += std::max(beyond, other.above_);  // the other's own, kept as its highest, are among them
  max_ = std::max(max_, other.max_);
  min_ = std::min(min_, other.min_);
}

double Histogram::mean() const noexcept {
  if (total_ == 0) return 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < counters_.size(); ++i) {
    if (counters_[i] > 0) sum += static_cast<double>(middle_of(i)) * static_cast<double>(counters_[i]);
  }
  return sum / static_cast<double>(total_);
}

double Histogram::standard_deviation() const noexcept {
  if (total_ == 0) return 0.0;
  const double average = mean();
  double sum = 0.0;
  for (std::size_t i = 0; i < counters_.size(); ++i) {
    const double deviation = static_cast<double>(middle_of(i)) - average;
    if (counters_[i] > 0) sum += deviation * deviation * static_cast<double>(counters_[i]);
  }
  return std::sqrt(sum / static_cast<double>(total_));
}

std::int64_t Histogram::value_at_percentile(double percentile) const noexcept {
  if (total_ == 0) return 0;
  // A percentile a rounding error above k/n must not ask for count k+1 (HdrHistogram's own care).
  const double asked = std::nextafter(std::clamp(percentile, 0.0, 100.0), -1.0);
  const auto wanted = static_cast<std::uint64_t>(std::ceil(std::max(asked, 0.0) / 100.0 * static_cast<double>(total_)));
  const std::uint64_t needed = std::max<std::uint64_t>(wanted, 1);
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < counters_.size(); ++i) {
    seen += counters_[i];
    if (seen >= needed) return std::min(highest_of(i), max_);
  }
  return max_;
}

std::uint64_t Histogram::count_above(std::int64_t value) const noexcept {
  if (value < 0) return total_;
  std::uint64_t above = 0;
  for (std::size_t i = counter_of(std::min(value, range_.highest)) + 1; i < counters_.size(); ++i)
    above += counters_[i];
  return above;
}

}  // namespace odds::report
