// Frames in parts: what one call has no time for comes with the next, and nothing twice.
#include <gtest/gtest.h>

#include <algorithm>

#include "ode/frame_crowd.hpp"
#include "ode/frame_fixture.hpp"

namespace odds::test {
namespace {

constexpr unsigned long few_units = 500;  // for some of forty pairs

class FrameParts : public FrameTest {
 protected:
  /// How often the pair that was called most was.
  static int most_calls(const Crowd& crowd) {
    int most = 0;
    for (const CrowdPair& pair : crowd.pairs()) most = std::max(most, pair.served);
    return most;
  }
};

TEST_F(FrameParts, ALaterPartGoesOnWhereTheOneBeforeStopped) {
  Crowd crowd(space, 40);
  oddsFrameBudgetSetWork(budget, few_units);
  ASSERT_EQ(oddsFrameBudgetSetParts(budget, 4), 1);
  crowd.run(space, budget);
  const int first = summary().served;
  ASSERT_GT(first, 0);
  ASSERT_LT(first, 20);
  int before = first;
  for (int part = 1; part < 4; ++part) {
    crowd.run(space, budget);
    EXPECT_EQ(summary().pairs, 40);
    EXPECT_GT(summary().served, before) << part;
    EXPECT_LE(summary().work, few_units + 64) << part;
    EXPECT_EQ(most_calls(crowd), 1) << part;
    before = summary().served;
  }
  crowd.run(space, budget);  // the next frame
  EXPECT_LT(summary().served, before);
}

TEST_F(FrameParts, WithoutALimitTheFirstCallsAllAndTheOthersNobody) {
  Crowd crowd(space, 20);
  ASSERT_EQ(oddsFrameBudgetSetParts(budget, 3), 1);
  for (int part = 0; part < 3; ++part) {
    crowd.run(space, budget);
    EXPECT_EQ(summary().served, 20) << part;
    EXPECT_EQ(most_calls(crowd), 1) << part;
  }
}

TEST_F(FrameParts, WhatIsHeldComesWithTheLast) {
  Crowd crowd(space, 40);
  for (const CrowdPair& pair : crowd.pairs()) dGeomOddsMeshSetCarryMotion(pair.a, 0.0);  // each asks for a search
  crowd.run(space, budget);  // all are known, and what touches is held
  oddsFrameBudgetSetWork(budget, few_units / 10);
  ASSERT_EQ(oddsFrameBudgetSetParts(budget, 3), 1);
  for (int part = 0; part < 2; ++part) {
    crowd.run(space, budget);
    EXPECT_EQ(summary().held, 0) << part;
  }
  crowd.run(space, budget);
  EXPECT_GT(summary().held, 0);
  EXPECT_LE(most_calls(crowd), 2);  // with the first frame's
}

// A share is made of what all the parts have: with one part everybody is called in a hurry.
TEST_F(FrameParts, PairsGetMoreWhereThereAreMoreParts) {
  Crowd crowd(space, 10);
  const auto work_of_a_frame = [&](int parts) {
    oddsFrameBudgetSetWork(budget, 1500);
    oddsFrameBudgetSetParts(budget, parts);
    unsigned long work = 0;
    for (int frame = 0; frame < 8; ++frame) {
      work = 0;
      for (int part = 0; part < parts; ++part) {
        crowd.run(space, budget);
        work += summary().work;
      }
    }
    return work;
  };
  const unsigned long one = work_of_a_frame(1);
  EXPECT_GT(work_of_a_frame(5), 2 * one);
}

TEST_F(FrameParts, AFrameUnderWayCanBeLeft) {
  Crowd crowd(space, 20);
  ASSERT_EQ(oddsFrameBudgetSetParts(budget, 3), 1);
  crowd.run(space, budget);
  ASSERT_EQ(oddsFrameBudgetSetParts(budget, 3), 1);
  crowd.run(space, budget);
  EXPECT_EQ(most_calls(crowd), 2);
  for (const int bad : {0, -1, 1025}) EXPECT_EQ(oddsFrameBudgetSetParts(budget, bad), 0) << bad;
  EXPECT_EQ(oddsFrameBudgetSetParts(nullptr, 2), 0);
}

}  // namespace
}  // namespace odds::test
