// The histogram against sorted data.
#include "odds/report/histogram.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace odds::report {
namespace {

/// The smallest value that at least `percentile` of the sorted data do not exceed.
std::int64_t exact_percentile(const std::vector<std::int64_t>& sorted, double percentile) {
  const double rank = std::ceil(percentile / 100.0 * static_cast<double>(sorted.size()) - 1e-9);
  return sorted[static_cast<std::size_t>(std::clamp(rank, 1.0, static_cast<double>(sorted.size()))) - 1];
}

rc::Gen<std::int64_t> any_latency() {
  return rc::gen::map(
      rc::gen::pair(rc::gen::inRange(0, 41), rc::gen::arbitrary<std::uint64_t>()),
      [](const auto& pair) { return static_cast<std::int64_t>(pair.second & ((std::uint64_t{1} << pair.first) - 1)); });
}

RC_GTEST_PROP(Histogram, keeps_every_percentile_to_three_digits, ()) {
  auto values = *rc::gen::nonEmpty(rc::gen::container<std::vector<std::int64_t>>(any_latency()));
  Histogram histogram;
  for (const std::int64_t value : values) histogram.record(value);
  std::sort(values.begin(), values.end());
  for (const double percentile : {0.0, 1.0, 25.0, 50.0, 90.0, 99.0, 99.9, 100.0}) {
    const std::int64_t exact = exact_percentile(values, percentile);
    const std::int64_t got = histogram.value_at_percentile(percentile);
    RC_ASSERT(got >= exact);
    RC_ASSERT(static_cast<double>(got - exact) <= 1e-3 * static_cast<double>(exact));
  }
  RC_ASSERT(histogram.max() == values.back());
  RC_ASSERT(histogram.min() == values.front());
  RC_ASSERT(histogram.count() == values.size());
}

RC_GTEST_PROP(Histogram, counters_tile_the_range_without_gaps, ()) {
  const HistogramRange range{*rc::gen::inRange<std::int64_t>(1, 5'000),
                             *rc::gen::inRange<std::int64_t>(20'000, 1'000'000'000), *rc::gen::inRange(0, 6)};
  const Histogram histogram(range);
  const std::int64_t value = *rc::gen::inRange<std::int64_t>(0, range.highest + 1);
  const std::size_t counter = histogram.counter_of(value);
  RC_ASSERT(counter < histogram.counters().size());
  RC_ASSERT(histogram.lowest_of(counter) <= value);
  RC_ASSERT(value <= histogram.highest_of(counter));
  RC_ASSERT(histogram.counter_of(histogram.highest_of(counter) + 1) == counter + 1);
}

RC_GTEST_PROP(Histogram, merging_equals_recording_together, ()) {
  const auto first = *rc::gen::container<std::vector<std::int64_t>>(any_latency());
  const auto second = *rc::gen::container<std::vector<std::int64_t>>(any_latency());
  Histogram a;
  Histogram b;
  Histogram both;
  for (const std::int64_t value : first) a.record(value), both.record(value);
  for (const std::int64_t value : second) b.record(value), both.record(value);
  a.merge(b);
  RC_ASSERT(a.count() == both.count());
  RC_ASSERT(a.max() == both.max());
  RC_ASSERT(a.min() == both.min());
  RC_ASSERT(std::equal(a.counters().begin(), a.counters().end(), both.counters().begin()));
}

TEST(Histogram, merging_a_coarser_one_keeps_counts_and_its_precision) {
  Histogram coarse({1, 1'000'000'000, 2});
  for (std::int64_t value = 1'000; value <= 100'000; value += 1'000) coarse.record(value);
  Histogram fine;
  fine.record(50);
  fine.merge(coarse);
  EXPECT_EQ(fine.count(), 101u);
  EXPECT_NEAR(static_cast<double>(fine.value_at_percentile(50.0)), 50'000.0, 1'000.0);
  EXPECT_EQ(fine.max(), 100'000);
}

TEST(Histogram, values_outside_its_range_are_counted_and_said) {
  Histogram histogram({1, 1'000'000, 3});
  histogram.record(-5);
  histogram.record(2'000'000, 2);
  histogram.record(10);
  EXPECT_EQ(histogram.count(), 4u);
  EXPECT_EQ(histogram.outside(), 3u);
  EXPECT_EQ(histogram.min(), 0);
  EXPECT_EQ(histogram.max(), 2'000'000) << "the largest value is never hidden";
}

// The middle of a coarse counter may lie beyond the range though no value did; what lay beyond both ranges counted
// twice.
TEST(Histogram, merging_counts_what_is_outside_once) {
  Histogram coarse({1, 1'000, 1});
  coarse.record(1'000);
  Histogram fine({1, 1'000, 3});
  fine.merge(coarse);
  EXPECT_EQ(fine.outside(), 0u);
  EXPECT_EQ(fine.max(), 1'000);
  Histogram wide({1, 2'000, 3});
  wide.record(-1);
  wide.record(500);
  wide.record(1'500);
  wide.record(5'000);
  fine.merge(wide);
  EXPECT_EQ(fine.count(), 5u);
  EXPECT_EQ(fine.outside(), 3u);
  EXPECT_EQ(fine.max(), 5'000);
  EXPECT_EQ(fine.min(), 0);
  wide.merge(fine);
  EXPECT_EQ(wide.count(), 9u);
  EXPECT_EQ(wide.outside(), 5u) << "-1 and 5000, and what the other held as -1, 1500 and 5000";
}

TEST(Histogram, empty_gives_zeros) {
  const Histogram histogram;
  EXPECT_EQ(histogram.value_at_percentile(99.0), 0);
  EXPECT_EQ(histogram.max(), 0);
  EXPECT_EQ(histogram.mean(), 0.0);
  EXPECT_EQ(histogram.standard_deviation(), 0.0);
  EXPECT_EQ(histogram.count_above(0), 0u);
}

TEST(Histogram, counts_what_lies_above_a_limit) {
  Histogram histogram;
  for (std::int64_t value = 1; value <= 1'000; ++value) histogram.record(value);
  EXPECT_EQ(histogram.count_above(900), 100u);
  EXPECT_EQ(histogram.count_above(-1), 1'000u);
  EXPECT_EQ(histogram.count_above(INT64_MAX), 0u);
}

TEST(Histogram, ranges_that_make_no_sense_are_refused) {
  EXPECT_FALSE(Histogram::make({0, 1'000, 3}));
  EXPECT_FALSE(Histogram::make({1, 1, 3}));
  EXPECT_FALSE(Histogram::make({1, 1'000, 6}));
  EXPECT_FALSE(Histogram::make({1, 1'000, -1}));
  EXPECT_FALSE(Histogram::make({1, INT64_MAX, 3}));
  EXPECT_FALSE(Histogram::make({INT64_MIN, 1'000, 3}));
  EXPECT_TRUE(Histogram::make({1, 2, 0}));
}

}  // namespace
}  // namespace odds::report
