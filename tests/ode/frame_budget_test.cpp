// A frame's budget shared over many pairs: nobody starves, what matters comes first, nothing overruns, nothing
// allocates.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ode/frame_crowd.hpp"
#include "ode/frame_pairs.hpp"
#include "ode/importance.hpp"
#include "support/allocation_counter.hpp"

namespace odds::test {
namespace {

using ode::FramePairs;
using ode::importance;
using ode::PairSigns;
using ode::share_of;

class FrameBudget : public OdeTest {
 protected:
  void SetUp() override {
    OdeTest::SetUp();
    budget = oddsFrameBudgetCreate(512);
    ASSERT_NE(budget, nullptr);
  }
  void TearDown() override {
    oddsFrameBudgetDestroy(budget);
    OdeTest::TearDown();
  }
  oddsFrameSummary summary() const {
    oddsFrameSummary summary;
    EXPECT_EQ(oddsFrameBudgetGetSummary(budget, &summary), 1);
    return summary;
  }
  oddsFrameBudgetID budget = nullptr;
};

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
  EXPECT_LT(summary().waiting_longest, 60);
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
  // A tenth of what all of them need.
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

TEST_F(FrameBudget, SpacesInsideOfSpacesAreSearched) {
  const dSpaceID inner = dSimpleSpaceCreate(space);
  const auto shape = sphere_shape(0.1);
  const dGeomID outer = mesh_geom(shape, space);
  const dGeomID first = mesh_geom(shape, inner);
  const dGeomID second = mesh_geom(shape, inner);
  dGeomSetPosition(first, 0.15, 0.0, 0.0);
  dGeomSetPosition(second, 0.1, 0.1, 0.0);
  std::vector<std::pair<dGeomID, dGeomID>> met;
  const auto note = [](void* data, dGeomID a, dGeomID b) {
    static_cast<std::vector<std::pair<dGeomID, dGeomID>>*>(data)->emplace_back(a, b);
  };
  ASSERT_EQ(oddsSpaceCollide(space, &met, note, budget), 1);
  EXPECT_EQ(met.size(), 3U);
  (void)outer;
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
  Crowd crowd(space, 40);
  std::vector<std::vector<std::size_t>> orders;
  for (int round = 0; round < 2; ++round) {
    const oddsFrameBudgetID fresh = oddsFrameBudgetCreate(64);
    oddsFrameBudgetSetWork(fresh, 2000);
    crowd.begin_frame();
    for (int frame = 0; frame < 20; ++frame) crowd.run(space, fresh);
    orders.push_back(crowd.order());
    oddsFrameBudgetDestroy(fresh);
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
  EXPECT_EQ(oddsSpaceCollide(space, nullptr, callback, nullptr), 0);
  EXPECT_EQ(oddsFrameBudgetGetSummary(budget, nullptr), 0);
  EXPECT_NE(std::string(oddsGetLastError()), "");
  oddsFrameBudgetDestroy(nullptr);
}

TEST(Importance, TouchingComesBeforeApartAndWaitingBeatsEverythingInTime) {
  PairSigns touching;
  touching.hit_probability = 1.0;
  touching.proved = true;
  touching.ever_contact = true;
  PairSigns apart;
  apart.hit_probability = 0.0;
  apart.proved = true;
  EXPECT_GT(importance(touching), 10.0 * importance(apart));
  PairSigns moving = apart;
  moving.way_share = 0.5;
  EXPECT_GT(importance(moving), importance(apart));
  PairSigns doubtful = apart;
  doubtful.proved = false;
  doubtful.hit_probability = 0.5;
  EXPECT_GT(importance(doubtful), importance(apart));
  touching.relative_speed = 1.0;
  apart.attention = 0.1;
  apart.waited = 12;
  EXPECT_GT(importance(apart), importance(touching));
  apart.waited = 4'000'000'000U;
  EXPECT_TRUE(std::isfinite(importance(apart)));
}

TEST(Share, KeepsAFloorForThoseThatComeLaterAndGivesNoMoreThanThereIs) {
  EXPECT_DOUBLE_EQ(share_of({100.0, 1000.0, 1.0, 1.0, 0.0, 1.0}), 100.0);  // the last gets the rest
  EXPECT_DOUBLE_EQ(share_of({100.0, 1000.0, 1.0, 1e9, 20.0, 1.0}), 40.0);  // half of what no floor needs
  EXPECT_DOUBLE_EQ(share_of({100.0, 5.0, 1.0, 1e9, 20.0, 1.0}), 5.0);
  EXPECT_DOUBLE_EQ(share_of({10.0, 5.0, 1.0, 1e9, 20.0, 1.0}), 1.0);
  EXPECT_DOUBLE_EQ(share_of({0.5, 5.0, 1.0, 2.0, 20.0, 1.0}), 0.5);
  EXPECT_DOUBLE_EQ(share_of({100.0, 0.0, 1.0, 2.0, 0.0, 1.0}), 50.0);
}

TEST(FramePairsTable, FindsWhatItKnowsAndForgetsWhatIsGone) {
  FramePairs pairs(100);
  const auto id = [](std::uintptr_t i) { return reinterpret_cast<dGeomID>(64 * (i + 1)); };
  ode::FramePair* first = pairs.at(id(1), id(2), 2);
  ASSERT_NE(first, nullptr);
  first->cost = 7.0;
  first->seen = 2;
  EXPECT_EQ(pairs.at(id(2), id(1), 3), first);
  EXPECT_EQ(first->cost, 7.0);
  for (std::uintptr_t i = 0; i < 10'000; ++i) {
    const std::uint64_t frame = 10 + i / 100;
    ode::FramePair* pair = pairs.at(id(i), id(i + 7), frame);
    ASSERT_NE(pair, nullptr) << i;  // a hundred live ones at a time always find room
    pair->seen = frame;
  }
}

}  // namespace
}  // namespace odds::test
