// A histogram of fixed relative precision after Gil Tene's HdrHistogram: fixed memory, constant time, no allocation.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "odds/math/error.hpp"

namespace odds::report {

/// What a histogram can tell apart. The defaults take 264 KiB.
struct HistogramRange {
  std::int64_t lowest = 1;                   ///< smallest value told apart from 0; >= 1
  std::int64_t highest = 3'600'000'000'000;  ///< one hour in nanoseconds; >= 2 * lowest
  int digits = 3;                            ///< significant decimal digits kept everywhere, 0 to 5

  friend bool operator==(const HistogramRange&, const HistogramRange&) = default;
};

/// Counts of non-negative integers (here nanoseconds), bucketed so that each is kept to `digits` significant digits.
/// The layout of the counters is HdrHistogram's, so that its file formats can be written and read counter by counter.
/// `record` is noexcept, allocates nothing and takes some nanoseconds. Not thread-safe.
class Histogram {
 public:
  /// Precondition: a valid range; make() checks one that comes from outside.
  explicit Histogram(const HistogramRange& range = {});
  /// An error for a range that is out of bounds.
  [[nodiscard]] static Result<Histogram> make(const HistogramRange& range);

  /// Values below 0 count as 0, values above the range as its highest; outside() counts both kinds.
  void record(std::int64_t value, std::uint64_t times = 1) noexcept;
  /// Adds all of `other`. Ranges may differ: then each value is taken over with the coarser of the two precisions.
  void merge(const Histogram& other) noexcept;

  [[nodiscard]] std::uint64_t count() const noexcept { return total_; }
  [[nodiscard]] std::uint64_t outside() const noexcept { return below_ + above_; }
  /// Exact where values were recorded; of the outermost occupied counters where counts were read from a file.
  /// 0 if empty. A value above the range shows here as it was.
  [[nodiscard]] std::int64_t max() const noexcept { return total_ == 0 ? 0 : max_; }
  [[nodiscard]] std::int64_t min() const noexcept { return total_ == 0 ? 0 : min_; }
  /// Of the counters' middle values, as HdrHistogram computes them. 0 if empty.
  [[nodiscard]] double mean() const noexcept;
  [[nodiscard]] double standard_deviation() const noexcept;
  /// The largest value that `percentile` (0 to 100) of the counts do not exceed, to the precision of the histogram, and
  /// never above max(). 0 if empty.
  [[nodiscard]] std::int64_t value_at_percentile(double percentile) const noexcept;
  /// How many counts lie above `value`, to the precision of the histogram.
  [[nodiscard]] std::uint64_t count_above(std::int64_t value) const noexcept;

  // The layout, for the file formats.
  [[nodiscard]] const HistogramRange& range() const noexcept { return range_; }
  [[nodiscard]] std::span<const std::uint64_t> counters() const noexcept { return counters_; }
  [[nodiscard]] int buckets() const noexcept { return buckets_; }
  [[nodiscard]] int sub_buckets() const noexcept { return 2 << half_magnitude_; }
  [[nodiscard]] std::size_t counter_of(std::int64_t value) const noexcept;    ///< precondition: 0 <= value <= highest
  [[nodiscard]] std::int64_t lowest_of(std::size_t counter) const noexcept;   ///< smallest value in a counter
  [[nodiscard]] std::int64_t highest_of(std::size_t counter) const noexcept;  ///< largest value in a counter
  [[nodiscard]] std::int64_t middle_of(std::size_t counter) const noexcept;
  /// Adds to one counter, as a file says. Precondition: counter < counters().size().
  void add_to_counter(std::size_t counter, std::uint64_t times) noexcept;

 private:
  HistogramRange range_;
  int unit_magnitude_ = 0;
  int half_magnitude_ = 0;  ///< sub-buckets: 2^(half_magnitude + 1)
  int buckets_ = 0;
  std::vector<std::uint64_t> counters_;
  std::uint64_t total_ = 0;
  std::uint64_t below_ = 0;  ///< of values below 0, and above the range
  std::uint64_t above_ = 0;
  std::int64_t max_ = 0;
  std::int64_t min_ = INT64_MAX;
};

}  // namespace odds::report
