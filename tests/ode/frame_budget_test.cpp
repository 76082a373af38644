// A frame's budget shared over many pairs: nobody starves, what matters comes first, nothing overruns, nothing
// allocates.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "ode/frame/frame_pairs.hpp"
#include "ode/frame/importance.hpp"
#include "ode/frame_crowd.hpp"
#include "ode/frame_fixture.hpp"
#include "support/allocation_counter.hpp"

namespace odds::test {
namespace {

using ode::FramePairs;
using ode::importance;
using ode::PairSigns;
using ode::share_of;

using FrameBudget = FrameTest;

TEST_F(FrameBudget, WithoutALimitEveryPairIsAnsweredAsByDSpaceCollide) {
  Crowd crowd(space, 20);
  crowd.run(space, budget);
  for (const CrowdPair& pair : crowd.pairs()) {
    EXPECT_EQ(pair.served, 1);
    EXPECT_TRUE(pair.right);
  }
  EXPECT_EQ(summary().pairs, 20);
  EXPECT_EQ(summary().served, 20);
  EXPECT_EQ(summary().waiting_longest, 0);
}

TEST_F(FrameBudget, WorkIsNeverExceededByMoreThanTheLastQuerysOwnStep) {
  Crowd crowd(space, 40);
  for (const unsigned long units : {1UL, 50UL, 500UL, 5000UL, 50000UL}) {
    oddsFrameBudgetSetWork(budget, units);
    for (int frame = 0; frame < 10; ++frame) {
      crowd.run(space, budget);
      EXPECT_LE(summary().work, units + 64) << units;  // one step of a query opens a few pairs at once
    }
  }
}

TEST_F(FrameBudget, NoPairStarvesEvenWhereAFrameServesOneInTwenty) {
  Crowd crowd(space, 60);
  oddsFrameBudgetSetWork(budget, 100);
  for (int frame = 0; frame < 200; ++frame) {
    crowd.run(space, budget);
    ASSERT_GT(summary().served, 0);
  }
  for (const CrowdPair& pair : crowd.pairs()) EXPECT_GT(pair.served, 2);
  EXPECT_LT(summary().waiting_longest, 120);  // turns of use
}

TEST_F(FrameBudget, WhatTouchesIsServedFirstAndIsRight) {
  Crowd crowd(space, 50);
  oddsFrameBudgetSetWork(budget, 1'000'000);
  for (int frame = 0; frame < 3; ++frame) {  // learns
    crowd.begin_frame();
    crowd.run(space, budget);
  }
  const auto touching =
      std::count_if(crowd.pairs().begin(), crowd.pairs().end(), [](const CrowdPair& p) { return p.touches; });
  ASSERT_GT(touching, 5);
  for (std::ptrdiff_t i = 0; i < touching; ++i) {
    EXPECT_TRUE(crowd.pairs()[crowd.order()[static_cast<std::size_t>(i)]].touches) << "place " << i;
  }
  // A quarter of what all of them need.
  const unsigned long all = summary().work;
  int right_by_importance = 0;
  int right_by_equal_shares = 0;
  for (const int sharing : {ODDS_SHARE_BY_IMPORTANCE, ODDS_SHARE_EQUALLY}) {
    oddsFrameBudgetSetSharing(budget, sharing);
    oddsFrameBudgetSetWork(budget, all / 4);
    int& right = sharing == ODDS_SHARE_EQUALLY ? right_by_equal_shares : right_by_importance;
    for (int frame = 0; frame < 20; ++frame) {
      crowd.run(space, budget);
      for (const CrowdPair& pair : crowd.pairs()) right += pair.touches && pair.contacts > 0 ? 1 : 0;
    }
  }
  EXPECT_GE(right_by_importance, right_by_equal_shares);
  EXPECT_GE(right_by_importance, 19 * static_cast<int>(touching));
}

TEST_F(FrameBudget, AttentionBringsAPairForward) {
  Crowd crowd(space, 30);
  oddsFrameBudgetSetWork(budget, 1'000'000);
  crowd.run(space, budget);
  const auto touching =
      std::count_if(crowd.pairs().begin(), crowd.pairs().end(), [](const CrowdPair& p) { return p.touches; });
  ASSERT_LT(touching, 25);
  for (const std::size_t watched : {7UL, 23UL}) {
    const dReal* place = dGeomGetPosition(crowd.pairs()[watched].a);
    const dReal at[3] = {place[0], place[1], place[2]};
    ASSERT_EQ(oddsFrameBudgetSetAttention(budget, at, 0.05), 1);
    crowd.begin_frame();
    crowd.run(space, budget);
    const auto position = std::find(crowd.order().begin(), crowd.order().end(), watched) - crowd.order().begin();
    EXPECT_LE(position, touching) << watched;  // behind nothing but what touches
  }
}

TEST_F(FrameBudget, PairsBeyondItsMemoryAreServedToo) {
  const oddsFrameBudgetID small = oddsFrameBudgetCreate(5);
  Crowd crowd(space, 12);
  crowd.run(space, small);
  oddsFrameSummary summary;
  oddsFrameBudgetGetSummary(small, &summary);
  EXPECT_EQ(summary.pairs, 12);
  EXPECT_EQ(summary.beyond_memory, 7);
  EXPECT_EQ(summary.served, 12);
  oddsFrameBudgetDestroy(small);
}

// They were given half a microsecond each, which is for frames that have no more.
TEST_F(FrameBudget, WithoutALimitPairsBeyondItsMemoryHaveNoneEither) {
  const SlowLooks looks(250);
  const oddsFrameBudgetID small = oddsFrameBudgetCreate(5);
  Crowd crowd(space, 12);
  for (int frame = 0; frame < 3; ++frame) {
    crowd.run(space, small);
    EXPECT_EQ(summary_of(small).starved, 0);
    for (const CrowdPair& pair : crowd.pairs()) EXPECT_TRUE(pair.right);
  }
  oddsFrameBudgetDestroy(small);
}

TEST_F(FrameBudget, AllocatesNothing) {
  Crowd crowd(space, 30);
  oddsFrameBudgetSetWork(budget, 3000);
  crowd.run(space, budget);
  const auto callback = [](void*, dGeomID a, dGeomID b) {
    dContactGeom contacts[8];
    dCollide(a, b, 8, contacts, sizeof(dContactGeom));
  };
  const support::AllocationCounter counter;
  for (int frame = 0; frame < 50; ++frame) oddsSpaceCollide(space, nullptr, callback, budget);
  EXPECT_EQ(counter.allocations(), 0U);
}

TEST_F(FrameBudget, TheShareEndsWithTheFrame) {
  Crowd crowd(space, 10);
  oddsFrameBudgetSetWork(budget, 1);
  crowd.run(space, budget);
  for (const CrowdPair& pair : crowd.pairs()) EXPECT_EQ(!collide(pair.a, pair.b).empty(), pair.touches);
}

TEST_F(FrameBudget, SameWorkSameBits) {
  std::vector<std::vector<std::size_t>> orders;
  for (int round = 0; round < 2; ++round) {
    // New bodies, too: what pairs hold and know of a round says which come first in the next.
    const dSpaceID fresh_space = dHashSpaceCreate(nullptr);
    Crowd crowd(fresh_space, 40);
    const oddsFrameBudgetID fresh = oddsFrameBudgetCreate(64);
    oddsFrameBudgetSetWork(fresh, 2000);
    for (int frame = 0; frame < 20; ++frame) crowd.run(fresh_space, fresh);
    orders.push_back(crowd.order());
    oddsFrameBudgetDestroy(fresh);
    dSpaceDestroy(fresh_space);
  }
  EXPECT_EQ(orders[0], orders[1]);
}

TEST_F(FrameBudget, RefusesWhatMakesNoSense) {
  const auto callback = [](void*, dGeomID, dGeomID) {};
  EXPECT_EQ(oddsFrameBudgetCreate(0), nullptr);
  EXPECT_EQ(oddsFrameBudgetCreate(1048577), nullptr);
  EXPECT_EQ(oddsFrameBudgetSetTime(budget, 0.0), 0);
  EXPECT_EQ(oddsFrameBudgetSetTime(budget, std::nan("")), 0);
  EXPECT_EQ(oddsFrameBudgetSetTime(nullptr, 1.0), 0);
  EXPECT_EQ(oddsFrameBudgetSetWork(nullptr, 1), 0);
  EXPECT_EQ(oddsFrameBudgetSetSharing(budget, 2), 0);
  const dReal bad[3] = {0.0, std::nan(""), 0.0};
  const dReal good[3] = {0.0, 0.0, 0.0};
  EXPECT_EQ(oddsFrameBudgetSetAttention(budget, bad, 1.0), 0);
  EXPECT_EQ(oddsFrameBudgetSetAttention(budget, good, 0.0), 0);
  EXPECT_EQ(oddsFrameBudgetSetAttention(budget, nullptr, 0.0), 1);
  EXPECT_EQ(oddsSpaceCollide(nullptr, nullptr, callback, budget), 0);
  EXPECT_EQ(oddsSpaceCollide(space, nullptr, nullptr, budget), 0);
  EXPECT_EQ(oddsSpaceCollide(reinterpret_cast<dSpaceID>(dCreateSphere(space, 1)), nullptr, callback, budget), 0)
      << "no space";
  EXPECT_EQ(oddsSpaceCollide(space, nullptr, callback, nullptr), 0);
  EXPECT_EQ(oddsFrameBudgetGetSummary(budget, nullptr), 0);
  EXPECT_NE(std::string(oddsGetLastError()), "");
  oddsFrameBudgetDestroy(nullptr);
}

TEST(Importance, TouchingComesBeforeApart) {
  PairSigns touching;
  touching.hit_probability = 1.0;
  touching.proved = true;
  touching.ever_contact = true;
  PairSigns apart;
  apart.hit_probability = 0.0;
  apart.proved = true;
  EXPECT_GT(importance(touching), importance(apart) + std::log2(10.0));
  PairSigns moving = apart;
  moving.way_share = 0.5;
  EXPECT_GT(importance(moving), importance(apart));
  PairSigns doubtful = apart;
  doubtful.proved = false;
  doubtful.hit_probability = 0.5;
  EXPECT_GT(importance(doubtful), importance(apart));
}

TEST(Importance, TurnsGoByImportanceTimesTheSquareOfTheWait) {
  EXPECT_DOUBLE_EQ(ode::turn(1.0, 1.0, 0), 0.0);
  EXPECT_DOUBLE_EQ(ode::turn(-1.0, 1.0, 0), -2.0);
  EXPECT_DOUBLE_EQ(ode::turn(-1.0, 1.0, 1), ode::turn(1.0, 1.0, 0));   // a quarter, waited for twice as long
  EXPECT_DOUBLE_EQ(ode::turn(-20.0, 1.0, 3), ode::turn(1.0, 1.0, 0));  // however unimportant: four times
  EXPECT_TRUE(std::isfinite(ode::turn(-20.0, 1.0, 4'000'000'000'000U)));
}

TEST(Share, IsAtLeastTheNeedAndLeavesTheOthersTheirs) {
  EXPECT_DOUBLE_EQ(share_of({100.0, 10.0, 0.0, 1.0}), 100.0);   // the last gets the rest
  EXPECT_DOUBLE_EQ(share_of({100.0, 10.0, 40.0, 1e-9}), 15.0);  // half as much again
  EXPECT_DOUBLE_EQ(share_of({100.0, 10.0, 40.0, 0.5}), 35.0);   // and half of what no need takes
  EXPECT_DOUBLE_EQ(share_of({100.0, 10.0, 88.0, 0.5}), 12.0);   // the others' needs come before that
  EXPECT_DOUBLE_EQ(share_of({100.0, 10.0, 95.0, 0.5}), 5.0);    // less than the need: not to be given
  EXPECT_DOUBLE_EQ(share_of({100.0, 10.0, 200.0, 0.5}), 0.0);
}

dGeomID geom_at(std::uintptr_t i) { return reinterpret_cast<dGeomID>(64 * (i + 1)); }

TEST(FramePairsTable, EveryPairOfAFrameHasAnEntryOfItsOwnAndFindsItInTheNext) {
  constexpr std::uintptr_t count = 1000;
  FramePairs pairs(count);
  for (int frame = 0; frame < 5; ++frame) {
    pairs.begin_frame();
    std::set<const ode::FramePair*> entries;
    for (std::uintptr_t i = 0; i < count; ++i) {
      ode::FramePair& pair = pairs.at(geom_at(i), geom_at(i + 7));
      EXPECT_EQ(pair.probability, frame == 0 ? 0.5 : static_cast<double>(i + 1)) << i;
      pair.probability = static_cast<double>(i + 1);
      EXPECT_EQ(&pairs.at(geom_at(i + 7), geom_at(i)), &pair);
      entries.insert(&pair);
    }
    EXPECT_EQ(entries.size(), count);
  }
}

TEST(FramePairsTable, ForgetsWhatAFrameDidNotMeet) {
  FramePairs pairs(100);
  for (std::uintptr_t i = 0; i < 100'000; ++i) {
    if (i % 100 == 0) pairs.begin_frame();
    ode::FramePair& pair = pairs.at(geom_at(i), geom_at(i + 7));
    ASSERT_EQ(pair.probability, 0.5);
    pair.probability = 7.0;
  }
  pairs.begin_frame();
  EXPECT_EQ(pairs.at(geom_at(99'999), geom_at(100'006)).probability, 7.0);
  pairs.begin_frame();
  pairs.begin_frame();
  EXPECT_EQ(pairs.at(geom_at(99'999), geom_at(100'006)).probability, 0.5);
}

}  // namespace
}  // namespace odds::test
