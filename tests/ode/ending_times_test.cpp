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

TEST(EndingTimes, AboutOneInTwentyIsLonger) {
  EndingTimes times;
  math::Random random(4, 1);
  int longer = 0;
  constexpr int rounds = 40000;
  for (int i = 0; i < 2 * rounds; ++i) {
    const auto took = static_cast<std::int64_t>(500.0 + 1000.0 * random.uniform());
    if (i >= rounds) longer += took > times.of(dBoxClass) ? 1 : 0;
    times.note(dBoxClass, took);
  }
  EXPECT_GT(longer, rounds / 50);
  EXPECT_LT(longer, rounds / 5);
}

TEST(EndingTimes, AFewInAThousandAreLaterByAMicrosecond) {
  EndingTimes times;
  math::Random random(4, 2);
  int later = 0;
  constexpr int rounds = 200000;
  for (int i = 0; i < 2 * rounds; ++i) {
    const bool is_rare = random.uniform() < 0.03;
    const auto took = static_cast<std::int64_t>(500.0 + (is_rare ? 2000.0 : 200.0) * random.uniform());
    if (i >= rounds) later += took > times.of(dBoxClass) + 1000 ? 1 : 0;
    times.note(dBoxClass, took);
  }
  EXPECT_GT(later, 0);
  EXPECT_LT(later, rounds / 150) << "of which a hundredth would be, by what is usual";
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
