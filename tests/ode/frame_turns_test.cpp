// Whose turn it is where a frame has time for few pairs: each pair's comes, beyond the budget's memory too.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "ode/frame/frame_share.hpp"
#include "ode/frame_fixture.hpp"

namespace odds::test {
namespace {

/// How often each pair was called.
using Calls = std::map<std::pair<dGeomID, dGeomID>, int>;

void count_call(void* calls, dGeomID a, dGeomID b) { ++(*static_cast<Calls*>(calls))[std::minmax(a, b)]; }

void count_and_collide(void* calls, dGeomID a, dGeomID b) {
  count_call(calls, a, b);
  dContactGeom contacts[8];
  dCollide(a, b, 8, contacts, sizeof(dContactGeom));
}

/// So short that it is over before the first pair: every frame calls one pair.
constexpr double no_time_us = 1e-3;

class FrameTurns : public FrameTest {
 protected:
  /// Pairs of spheres, each apart from the others.
  void add_pairs(int pairs) {
    for (int i = 0; i < pairs; ++i) {
      for (const double beside : {0.0, 0.5}) dGeomSetPosition(dCreateSphere(space, 1.0), 10.0 * i + beside, 0.0, 0.0);
    }
  }
  /// `count` meshes in one heap: each meets each.
  void add_heap(int count) {
    const auto shape = sphere_shape(0.1);
    for (int i = 0; i < count; ++i) dGeomSetPosition(mesh_geom(shape, space), 0.01 * i, 0.02 * (i % 3), 0.0);
  }
};

TEST_F(FrameTurns, EveryPairIsCalledInTimeWhereAFrameCallsOneInTwoHundred) {
  add_pairs(200);
  oddsFrameBudgetSetTime(budget, no_time_us);
  const dReal here[3] = {0.0, 0.0, 0.0};
  oddsFrameBudgetSetAttention(budget, here, 1.0);
  Calls calls;
  for (int frame = 0; frame < 700; ++frame) {
    ASSERT_EQ(oddsSpaceCollide(space, &calls, &count_call, budget), 1);
    ASSERT_EQ(summary().served, 1);
    ASSERT_LT(summary().waiting_longest, 230) << frame;
  }
  EXPECT_EQ(calls.size(), 200U);
}

TEST_F(FrameTurns, PairsBeyondTheMemoryAndThoseWithinAllComeToTheirTurn) {
  add_heap(8);
  const oddsFrameBudgetID small = oddsFrameBudgetCreate(4);
  Calls calls;
  for (const bool by_work : {true, false}) {
    calls.clear();
    oddsFrameBudgetSetWork(small, by_work ? 100 : 0);
    oddsFrameBudgetSetTime(small, by_work ? dInfinity : no_time_us);
    for (int frame = 0; frame < 200; ++frame) {
      oddsSpaceCollide(space, &calls, &count_and_collide, small);
      ASSERT_GT(summary_of(small).served, 0);
    }
    EXPECT_EQ(summary_of(small).beyond_memory, 24);
    EXPECT_EQ(calls.size(), 28U) << (by_work ? "work" : "time");
  }
  oddsFrameBudgetDestroy(small);
}

TEST_F(FrameTurns, PairsBeyondTheMemoryLeaveHalfOfTheFrame) {
  add_heap(10);
  const oddsFrameBudgetID small = oddsFrameBudgetCreate(1);
  oddsFrameBudgetSetWork(small, 200);
  std::vector<std::pair<dGeomID, dGeomID>> found;
  dSpaceCollide(space, &found, [](void* data, dGeomID a, dGeomID b) {
    static_cast<std::vector<std::pair<dGeomID, dGeomID>>*>(data)->emplace_back(a, b);
  });
  struct Spent {
    unsigned long before_the_last = 0;
    unsigned long all = 0;
    std::pair<dGeomID, dGeomID> last;
  };
  const auto note = [](void* data, dGeomID a, dGeomID b) {
    auto& spent = *static_cast<Spent*>(data);
    spent.before_the_last = spent.all;
    spent.last = {a, b};
    dContactGeom contacts[8];
    dCollide(a, b, 8, contacts, sizeof(dContactGeom));
    spent.all += ode::current_share->spent;
  };
  for (int frame = 0; frame < 20; ++frame) {
    Spent spent;
    oddsSpaceCollide(space, &spent, note, small);
    EXPECT_LE(spent.before_the_last, 100U + 64U) << frame;
    EXPECT_EQ(spent.last, found.front()) << frame;  // the one in memory
  }
  oddsFrameBudgetDestroy(small);
}

TEST_F(FrameTurns, EqualSharesDoNotHideWhoWaits) {
  add_pairs(5);
  oddsFrameBudgetSetTime(budget, no_time_us);
  oddsFrameBudgetSetSharing(budget, ODDS_SHARE_EQUALLY);
  Calls calls;
  for (int frame = 0; frame < 30; ++frame) oddsSpaceCollide(space, &calls, &count_call, budget);
  EXPECT_EQ(calls.size(), 1U);
  EXPECT_EQ(summary().waiting_longest, 30);
}

/// Shares of work in a frame: the first, and the greatest.
struct Shares {
  unsigned long first = 0;
  unsigned long most = 0;
};

void note_share(void* data, dGeomID, dGeomID) {
  auto& shares = *static_cast<Shares*>(data);
  if (shares.first == 0) shares.first = ode::current_share->work_units;
  shares.most = std::max(shares.most, ode::current_share->work_units);
}

TEST_F(FrameTurns, NoShareIsGreaterThanWhatTheFrameHasLeft) {
  add_pairs(3);
  for (const unsigned long units : {1UL, 4UL, 9UL}) {
    oddsFrameBudgetSetWork(budget, units);
    Shares shares;
    oddsSpaceCollide(space, &shares, &note_share, budget);
    EXPECT_LE(shares.most, units);
  }
}

TEST_F(FrameTurns, CostsInMicrosecondsAreNotTakenForWork) {
  add_pairs(20);
  oddsFrameBudgetSetTime(budget, 1e6);
  Shares shares;
  for (int frame = 0; frame < 3; ++frame) oddsSpaceCollide(space, &shares, &note_share, budget);
  oddsFrameBudgetSetWork(budget, 400);
  shares = {};
  oddsSpaceCollide(space, &shares, &note_share, budget);
  EXPECT_GE(shares.first, 90U);  // a pair whose work nobody knows yet gets far more than its part of 400
}

}  // namespace
}  // namespace odds::test
