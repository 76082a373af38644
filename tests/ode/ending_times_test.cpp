// How long collisions take after their time is up is learnt.
#include "ode/geom/ending_times.hpp"

#include <gtest/gtest.h>

#include <cstdint>

#include "odds/math/random.hpp"

namespace odds::ode {
namespace {

TEST(EndingTimes, AreKnownByPartner) {
  EndingTimes times;
  const std::int64_t first = times.of(dBoxClass);
  for (int i = 0; i < 100; ++i) times.note(dSphereClass, 3000);
  EXPECT_EQ(times.of(dBoxClass), first);
  EXPECT_GT(times.of(dSphereClass), first);
  EXPECT_NEAR(static_cast<double>(times.of(dSphereClass)), 3000.0, 100.0);
  for (int i = 0; i < 10; ++i) times.note(dTriMeshClass, 3000);  // some other class
  EXPECT_GT(times.of(dHeightfieldClass), first);
  EXPECT_EQ(times.of(dBoxClass), first);
}

/// The share of those that take longer than what is kept for them by more than so much, once it is learnt.
template <class Took>
double share_longer(std::int64_t by_ns, const Took& took_ns) {
  EndingTimes times;
  int longer = 0;
  constexpr int rounds = 200000;
  for (int i = 0; i < 2 * rounds; ++i) {
    const auto took = static_cast<std::int64_t>(took_ns());
    if (i >= rounds) longer += took > times.of(dBoxClass) + by_ns ? 1 : 0;
    times.note(dBoxClass, took);
  }
  return static_cast<double>(longer) / rounds;
}

TEST(EndingTimes, AboutOneInTwentyIsLonger) {
  math::Random random(4, 1);
  const double share = share_longer(0, [&] { return 500.0 + 1000.0 * random.uniform(); });
  EXPECT_GT(share, 0.02);
  EXPECT_LT(share, 0.2);
}

TEST(EndingTimes, AFewInAThousandAreLaterByAMicrosecond) {
  math::Random random(4, 2);
  const auto rarely_long = [&] {
    const bool is_long = random.uniform() < 0.03;
    return 500.0 + (is_long ? 2000.0 : 200.0) * random.uniform();
  };
  const double share = share_longer(1000, rarely_long);
  EXPECT_GT(share, 0.0);
  EXPECT_LT(share, 0.0067) << "0.012 would be, by what is usual";
}

TEST(EndingTimes, WhatIsUsualAtFirstIsNotLate) {
  EndingTimes times;
  for (int i = 0; i < 64; ++i) times.note(dBoxClass, 3500);
  for (int i = 0; i < 1000; ++i) times.note(dBoxClass, 1000);
  EXPECT_LT(times.of(dBoxClass), 1200);
}

TEST(EndingTimes, AreShortAgainWhereEndingsAre) {
  EndingTimes times;
  for (int i = 0; i < 100; ++i) times.note(dBoxClass, 3000);
  for (int i = 0; i < 2000; ++i) times.note(dBoxClass, -5000);  // it ended before its time was up
  EXPECT_LT(times.of(dBoxClass), 500);
  EXPECT_GT(times.of(dBoxClass), 0);
}

TEST(EndingTimes, StallsTeachNothing) {
  EndingTimes times;
  const std::int64_t first = times.of(dBoxClass);
  for (int i = 0; i < 100; ++i) times.note(dBoxClass, 50000);
  EXPECT_EQ(times.of(dBoxClass), first);
  for (int i = 0; i < 1000; ++i) times.note(dBoxClass, 19000);
  EXPECT_LE(times.of(dBoxClass), 5000) << "no budget of some microseconds would be left";
}

}  // namespace
}  // namespace odds::ode
