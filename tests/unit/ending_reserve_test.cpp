// What of a budget is kept for the answer.
#include "query/ending_reserve.hpp"

#include <gtest/gtest.h>

#include <cstdint>

#include "odds/math/random.hpp"

namespace odds::query {
namespace {

TEST(EndingReserve, SettlesWhereFewEndingsAreLate) {
  // Endings that take 0.5 to 1.5 us.
  EndingReserve reserve = EndingReserves{}.search;
  math::Random random(3);
  int late = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto took_ns = static_cast<std::int64_t>(random.uniform(500.0, 1500.0));
    if (i >= 1000 && took_ns > reserve.ns()) ++late;
    reserve.note(took_ns);
  }
  EXPECT_GT(late, 19000 / 200);
  EXPECT_LT(late, 19000 / 10);
}

TEST(EndingReserve, WhatDidNotFitByFarStaysAwayForLong) {
  // One ending that took 4 us more than expected, then others that say nothing.
  EndingReserve reserve = EndingReserves{}.patch;
  for (int i = 0; i < 40; ++i) reserve.note(reserve.ns() - 1);
  const std::int64_t expected_ns = reserve.ns();
  reserve.note(expected_ns + 4000);
  for (int i = 0; i < 2000; ++i) reserve.note(0);
  EXPECT_GT(reserve.ns(), expected_ns);
}

TEST(EndingReserve, StaysWithinBoundsWhateverHappens) {
  constexpr EndingReserve::Range range{600, 200, 2000, 100, 100, 4};
  EndingReserve reserve(range);
  for (int i = 0; i < 100; ++i) reserve.note(1'000'000'000);
  EXPECT_EQ(reserve.ns(), range.most_ns);
  for (int i = 0; i < 1000; ++i) reserve.note(1);
  EXPECT_EQ(reserve.ns(), range.least_ns);
}

// Who is never let in because the reserve is too great would never learn that it is.
TEST(EndingReserve, EasesSoonWhenItLeavesNoTime) {
  EndingReserve reserve({1500, 300, 5000, 150, 3000, 1});
  for (int i = 0; i < 10; ++i) reserve.note(6000);
  ASSERT_EQ(reserve.ns(), 5000);
  int runs = 0;
  for (; reserve.ns() > 4000 && runs < 1000; ++runs) reserve.ease();
  EXPECT_LT(runs, 20);
  for (int i = 0; i < 1000; ++i) reserve.ease();
  EXPECT_EQ(reserve.ns(), 300);
}

}  // namespace
}  // namespace odds::query
