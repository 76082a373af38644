// No pair gets a share that buys nothing: what pairs need is learned, and where a frame cannot pay it, they take turns.
// The pairs here only say what they need, and move the frame's clock by what they take of their shares.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

#include "odds/math/random.hpp"
#include "odds/query/pair.hpp"
#include "odds/realtime/clock.hpp"
#include "ode/budget_clock.hpp"
#include "ode/frame/frame_budget.hpp"
#include "ode/frame/frame_need.hpp"
#include "ode/frame/frame_share.hpp"
#include "ode/frame_crowd.hpp"
#include "ode/frame_fixture.hpp"

namespace odds::test {
namespace {

using ode::FrameNeed;
using ode::Outcome;

TEST(FrameNeed, DoublesUntilAShareIsOfUse) {
  FrameNeed need;
  EXPECT_EQ(need.least_share(5.0, 100.0), 5.0);
  EXPECT_FALSE(need.learn(5.0, 5.0, Outcome::starved, 100.0));
  EXPECT_EQ(need.least_share(5.0, 100.0), 10.0);
  EXPECT_FALSE(need.learn(3.0, 3.0, Outcome::starved, 100.0));  // had less than it needs: nothing new
  EXPECT_EQ(need.least_share(5.0, 100.0), 10.0);
  EXPECT_TRUE(need.is_hungry());
  EXPECT_TRUE(need.learn(10.0, 9.0, Outcome::finished, 100.0));
  EXPECT_FALSE(need.is_hungry());
  EXPECT_LT(need.least_share(5.0, 100.0), 10.0);
  EXPECT_GE(need.least_share(5.0, 100.0), 9.0);
  EXPECT_TRUE(need.learn(30.0, 30.0, Outcome::finished, 100.0));
  EXPECT_EQ(need.least_share(5.0, 100.0), 30.0);
}

TEST(FrameNeed, WhatWasMoreThanEnoughIsLearnedDownToWhatIsNot) {
  for (const Outcome outcome : {Outcome::enough, Outcome::plenty}) {
    FrameNeed need;
    EXPECT_TRUE(need.learn(80.0, 80.0, outcome, 100.0));
    EXPECT_EQ(need.is_hungry(), outcome == Outcome::enough);
    int starved = 0;
    for (int turn = 0; turn < 200; ++turn) {
      const double share = need.least_share(5.0, 100.0);
      EXPECT_LE(share, 80.0);
      const bool is_too_little = share < 20.0;
      EXPECT_EQ(need.learn(share, is_too_little ? share : 80.0, is_too_little ? Outcome::starved : outcome, 100.0),
                !is_too_little);
      starved += is_too_little ? 1 : 0;
    }
    EXPECT_GE(starved, 1);
    EXPECT_LE(starved, 6);  // of 200
    EXPECT_LT(need.least_share(5.0, 100.0), 40.0);
  }
}

TEST(FrameNeed, GivesUpOnceThereWasAllThatThereIs) {
  FrameNeed need;
  int in_a_row = 0;
  for (double share = need.least_share(5.0, 100.0); in_a_row < 20; share = need.least_share(5.0, 100.0)) {
    ++in_a_row;
    EXPECT_LE(share, 100.0);
    if (need.learn(share, share, Outcome::starved, 100.0)) break;
  }
  EXPECT_EQ(in_a_row, 6);  // 5, 10, 20, 40, 80, 100
  EXPECT_EQ(need.least_share(5.0, 100.0), 5.0);
}

// A search does not begin what does not fit: of 8 units it spends none.
TEST(FrameNeed, GrowsThoughNothingOfTheShareWasSpent) {
  FrameNeed need;
  EXPECT_TRUE(need.learn(5.0, 0.0, Outcome::finished, 1000.0));  // far apart
  EXPECT_EQ(need.least_share(5.0, 1000.0), 0.0);
  EXPECT_FALSE(need.learn(8.0, 0.0, Outcome::starved, 1000.0));
  EXPECT_EQ(need.least_share(5.0, 1000.0), 16.0);
  EXPECT_FALSE(need.learn(16.0, 0.0, Outcome::starved, 1000.0));
  EXPECT_EQ(need.least_share(5.0, 1000.0), 32.0);
}

TEST(FrameNeed, BodiesThatRestStillNeedWhatASearchNeeds) {
  FrameNeed need;
  EXPECT_TRUE(need.learn(50.0, 50.0, Outcome::finished, 100.0));
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(need.learn(50.0, 1.0, Outcome::carried, 100.0));
  EXPECT_EQ(need.least_share(5.0, 100.0), 50.0);
  EXPECT_FALSE(need.is_hungry());
}

TEST(FrameNeed, OnlyWhatTheFrameEndedIsStarved) {
  ode::Settings own;
  own.budget_us = 100.0;
  ode::Settings shared = own;
  shared.work_units = 8000;
  EXPECT_FALSE(ode::is_ended_by_share(own, shared, 2000)) << "its own 100 us were up";
  EXPECT_TRUE(ode::is_ended_by_share(own, shared, 7990));
  shared = own;
  shared.budget_us = 50.0;
  EXPECT_TRUE(ode::is_ended_by_share(own, shared, 2000));
  own.work_units = shared.work_units = 200;
  EXPECT_FALSE(ode::is_ended_by_share(own, shared, 199)) << "its own units were spent";
  EXPECT_TRUE(ode::is_ended_by_share(own, shared, 100));
}

/// Pairs of spheres in the place of pairs of meshes.
struct Actor {
  double need = 0.0;
  int of_use = 0;
  int starved = 0;
  int last_of_use = 0;  // frame
};

class FrameActors : public FrameTest {
 protected:
  void SetUp() override {
    FrameTest::SetUp();
    budget->use_clock(clock.clock());
  }

  /// In the order of `needs`; pair i lies 10 i metres from the first.
  void add(const std::vector<double>& needs) {
    for (const double need : needs) {
      const double x = 10.0 * static_cast<double>(actors.size());
      const dGeomID a = dCreateSphere(space, 1.0);
      for (const dGeomID geom : {a, dCreateSphere(space, 1.0)}) dGeomSetPosition(geom, x, 0.0, 0.0);
      const std::size_t place = actors.size();
      actors.push_back({need});
      places[a] = place;
    }
  }

  void run(int frames) {
    for (int i = 0; i < frames; ++i) {
      ++frame;
      ASSERT_EQ(oddsSpaceCollide(space, this, &FrameActors::act, budget), 1);
      ASSERT_EQ(summary().overshoot_us, 0.0) << frame;
      ASSERT_LE(summary().work, budget->settings().work_units);
    }
  }

  static void act(void* self, dGeomID a, dGeomID b) {
    auto& test = *static_cast<FrameActors*>(self);
    Actor& actor = test.actors[test.places.at(test.places.contains(a) ? a : b)];
    ode::FrameShare& share = *ode::current_share;
    const bool in_units = share.work_units > 0;
    const double had = in_units ? static_cast<double>(share.work_units) : share.us;
    const double took = std::min(had, actor.need);
    if (in_units) {
      share.spent = static_cast<unsigned long>(took);
    } else {
      test.clock.advance(static_cast<std::int64_t>(1e3 * took) + test.call_ns);
    }
    share.outcome = took < actor.need ? Outcome::starved : Outcome::finished;
    ++(took < actor.need ? actor.starved : actor.of_use);
    if (took >= actor.need) actor.last_of_use = test.frame;
  }

  static void act_and_stall(void* self, dGeomID a, dGeomID b) {
    act(self, a, b);
    static_cast<FrameActors*>(self)->clock.advance(5'000'000);
    ode::current_share->stall_us = 5'000.0;
  }

  realtime::ManualClock clock;
  std::int64_t call_ns = 400;
  std::vector<Actor> actors;
  std::map<dGeomID, std::size_t> places;
  int frame = 0;
};

std::vector<double> random_needs(std::size_t count, std::uint64_t seed, double least, double most) {
  math::Random random(seed);
  std::vector<double> needs(count);
  for (double& need : needs) need = random.uniform(least, most);
  return needs;
}

TEST_F(FrameActors, EveryPairHasAnswersOfUseWhereEqualSharesWouldGiveNone) {
  add(std::vector<double>(100, 60.0));
  oddsFrameBudgetSetWork(budget, 1000);  // ten for each
  oddsFrameBudgetSetSharing(budget, ODDS_SHARE_EQUALLY);
  run(60);
  for (const Actor& actor : actors) EXPECT_EQ(actor.of_use, 0);
  EXPECT_EQ(summary().waiting_longest, 60);
  EXPECT_EQ(summary().starved, 100);
  oddsFrameBudgetSetSharing(budget, ODDS_SHARE_BY_IMPORTANCE);
  run(60);  // 16 of 100 in a frame
  for (const Actor& actor : actors) EXPECT_GE(actor.of_use, 7);
  EXPECT_LE(summary().waiting_longest, 8);
}

TEST_F(FrameActors, OnceLearnedNoShareBuysNothing) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    add(random_needs(40, seed, 1.0, 60.0));
  }
  oddsFrameBudgetSetTime(budget, 500.0);
  run(40);
  for (Actor& actor : actors) actor.starved = 0;
  run(100);
  for (const Actor& actor : actors) {
    EXPECT_EQ(actor.starved, 0);
    EXPECT_GE(actor.of_use, 8);  // all together need some eight frames
  }
}

TEST_F(FrameActors, WhatMattersHasMoreTurnsButNobodyFourTimesFewer) {
  add(std::vector<double>(60, 30.0));
  oddsFrameBudgetSetTime(budget, 250.0);
  const dReal here[3] = {0.0, 0.0, 0.0};
  oddsFrameBudgetSetAttention(budget, here, 5.0);
  run(50);
  for (Actor& actor : actors) actor.of_use = 0;
  run(400);
  EXPECT_GT(actors.front().of_use, 2 * actors.back().of_use);
  const auto [least, most] =
      std::minmax_element(actors.begin(), actors.end(), [](auto& x, auto& y) { return x.of_use < y.of_use; });
  EXPECT_LE(most->of_use, 4 * least->of_use + 4);
}

TEST_F(FrameActors, APairThatNothingSatisfiesTakesNoMoreThanSomeTurns) {
  add(std::vector<double>(20, 20.0));
  add({1e9, 1e9});
  oddsFrameBudgetSetTime(budget, 250.0);
  run(300);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_GE(actors[i].of_use, 60) << i;  // alone: 150
  EXPECT_GT(actors[20].starved, 20);
}

TEST_F(FrameActors, AGrowingNeedIsMetAgain) {
  add(random_needs(30, 5, 2.0, 12.0));
  oddsFrameBudgetSetTime(budget, 300.0);
  run(20);
  for (Actor& actor : actors) actor.need *= 4.0;
  run(30);
  const int before = frame;
  run(30);
  for (const Actor& actor : actors) EXPECT_GT(actor.last_of_use, before);
}

TEST_F(FrameActors, AFrameDoesNotOverrunHoweverLongItsCallsTakeBesideTheirSearches) {
  add(random_needs(80, 9, 1.0, 90.0));
  for (const double frame_us : {20.0, 100.0, 500.0, 5000.0}) {
    oddsFrameBudgetSetTime(budget, frame_us);
    for (const std::int64_t around_ns : {0, 400, 1400}) {
      call_ns = around_ns;
      run(30);
      EXPECT_GT(summary().served, 0);
    }
  }
}

TEST_F(FrameActors, TheMachinesStallsAreNotTakenForNeeds) {
  add(std::vector<double>(10, 10.0));
  oddsFrameBudgetSetTime(budget, 200.0);
  run(5);
  for (int i = 0; i < 10; ++i) oddsSpaceCollide(space, this, &FrameActors::act_and_stall, budget);
  for (Actor& actor : actors) actor.of_use = 0;
  run(1);
  EXPECT_EQ(summary().served, 10);
}

class HeldInFrame : public FrameTest {};

TEST_F(HeldInFrame, WhatTouchesKeepsItsContactsInFramesWithoutATurn) {
  Crowd crowd(space, 60);
  crowd.run(space, budget);  // without a limit
  oddsFrameBudgetSetWork(budget, 400);
  int held = 0;
  for (int frame = 0; frame < 60; ++frame) {
    crowd.run(space, budget);
    held += summary().held;
    EXPECT_EQ(summary().pairs, 60);
    EXPECT_LT(summary().served, 40);
    for (const CrowdPair& pair : crowd.pairs()) {
      EXPECT_TRUE(pair.contacts > 0 || !pair.touches) << frame;
    }
  }
  EXPECT_GT(held, 60);
}

// Late contacts take some dozens of runs. They would be of long ago where a pair waits for its turns, and keep the
// memory that they are made in from other pairs meanwhile. They are told by their depth: until then, guesses are
// shallow.
TEST_F(HeldInFrame, PairsThatWaitForTheirTurnsMakeNoLateContacts) {
  realtime::ManualClock clock(150);
  ode::use_budget_clock(clock.clock());
  const auto deepest = [&](int frames_a_turn) {
    const dGeomID a = mesh_geom(sphere_shape(0.1), space);
    const dGeomID b = mesh_geom(sphere_shape(0.1), space);
    dGeomOddsMeshSetBudget(a, 5.0);
    double depth = 0.0;
    for (int frame = 0; frame < 60 * frames_a_turn; ++frame) {
      dGeomSetPosition(b, 0.0, 1e-5 * frame / frames_a_turn, 0.19);
      ode::FrameShare share;
      share.only_held = frame % frames_a_turn != 0;
      ode::current_share = &share;
      for (const dContactGeom& contact : collide(a, b)) depth = std::max(depth, contact.depth);
      ode::current_share = nullptr;
    }
    dGeomDestroy(a);
    dGeomDestroy(b);
    return depth;
  };
  const double guessed = 2e-4;
  EXPECT_GT(deepest(1), 2.0 * guessed);
  EXPECT_LT(deepest(3), guessed);
  ode::use_budget_clock({});
}

TEST_F(HeldInFrame, HeldContactsFollowTheBodiesAndCostNoWork) {
  const auto shape = sphere_shape(0.1);
  const dGeomID a = mesh_geom(shape, space);
  const dGeomID b = mesh_geom(shape, space);
  dGeomSetPosition(b, 0.0, 0.0, 0.19);
  ASSERT_FALSE(collide(a, b).empty());
  oddsAnswer before;
  ASSERT_EQ(oddsGetLastAnswer(a, b, &before), 1);
  dGeomSetPosition(b, 0.0, 0.0, 0.189);
  ode::FrameShare share;
  share.only_held = true;
  oddsStats counted;
  oddsGetStats(&counted);
  const auto queries = counted.queries;
  ode::current_share = &share;
  const auto contacts = collide(a, b);
  ode::current_share = nullptr;
  ASSERT_FALSE(contacts.empty());
  EXPECT_NEAR(contacts.front().depth, 0.011, 0.002);
  oddsAnswer answer;
  ASSERT_EQ(oddsGetLastAnswer(a, b, &answer), 1);
  EXPECT_EQ(answer.only_held, 1);
  EXPECT_EQ(answer.verdict, before.verdict);
  EXPECT_EQ(answer.contacts, static_cast<int>(contacts.size()));
  EXPECT_EQ(answer.node_pairs, 0U);
  EXPECT_EQ(share.spent, 0U);
  oddsGetStats(&counted);
  EXPECT_EQ(counted.queries, queries);
  dGeomSetPosition(b, 0.0, 0.0, 0.5);  // far away: nothing is left of it
  ode::current_share = &share;
  EXPECT_TRUE(collide(a, b).empty());
  ode::current_share = nullptr;
}

// Boxes and a capsule rest on ground of many triangles. A frame that pays for few of them gives what is kept of the
// others.
TEST_F(HeldInFrame, BodiesOfOdeKeepTheirContactsInFramesWithoutATurn) {
  mesh_geom(box_shape(2.0, 2.0, 0.1, 60), space);
  std::vector<dGeomID> bodies;
  for (int i = 0; i < 10; ++i) {
    bodies.push_back(i == 0 ? dCreateCapsule(space, 0.05, 0.1) : dCreateBox(space, 0.1, 0.1, 0.1));
    dGeomSetPosition(bodies.back(), 0.18 * i - 0.8, 0.013, 0.0999);
  }
  rotate(bodies[0], Vec3::UnitX(), 1.5707963267948966);
  using Contacts = std::map<dGeomID, std::vector<dContactGeom>>;
  const auto frame = [&] {
    Contacts all;
    const auto call = [](void* data, dGeomID a, dGeomID b) {
      const bool is_ground = dGeomGetClass(a) == oddsGetClass();
      if (!is_ground && dGeomGetClass(b) != oddsGetClass()) return;
      (*static_cast<Contacts*>(data))[is_ground ? b : a] = is_ground ? collide(a, b, 8) : collide(b, a, 8);
    };
    EXPECT_EQ(oddsSpaceCollide(space, &all, call, budget), 1);
    return all;
  };
  const Contacts first = frame();  // without a limit
  oddsFrameBudgetSetWork(budget, 300);
  int held = 0;
  for (int i = 0; i < 40; ++i) {
    for (dGeomID body : bodies) {  // they tremble, or what rests would be carried along
      const dReal* const at = dGeomGetPosition(body);
      dGeomSetPosition(body, at[0], at[1], 0.0999 + (i % 2 == 0 ? 1e-5 : -1e-5));
    }
    const Contacts now = frame();
    held += summary().held;
    for (const dGeomID body : bodies) {
      const auto known = now.find(body);
      ASSERT_TRUE(known != now.end()) << "not called in frame " << i;
      ASSERT_GE(known->second.size(), 2U) << i;
      for (const dContactGeom& contact : known->second) {
        EXPECT_NEAR(contact.depth, i % 2 == 0 ? 9e-5 : 1.1e-4, 3e-5);
        EXPECT_LT(contact.normal[2], -0.99);
      }
    }
  }
  EXPECT_GT(held, 40);
  EXPECT_EQ(first.size(), bodies.size());
}

TEST_F(HeldInFrame, ContactsThatAreAGuessAreNotWhatAPairNeeds) {
  const auto shape = sphere_shape(0.1, 16);
  const Vec3 above(0.0, 0.0, 0.19);
  int enough = 0;
  int too_few = 0;
  for (unsigned long units = 8; units <= 20'000; units += units / 8) {
    const dGeomID a = mesh_geom(shape, space);
    const dGeomID b = mesh_geom(shape, space);
    dGeomSetPosition(b, above.x(), above.y(), above.z());
    ode::FrameShare share;
    share.work_units = units;
    ode::current_share = &share;
    const bool touch = !collide(a, b).empty();
    ode::current_share = nullptr;
    dGeomDestroy(a);
    dGeomDestroy(b);
    auto same = std::move(query::Pair::make(shape, shape)).value();
    const query::Answer answer = same.run({Mat3::Identity(), above}, {.method = query::Method::incremental,
                                                                      .budget = query::Budget::work(units),
                                                                      .max_contacts = query::most_contacts});
    const bool guess = answer.contact_pairs < 8;
    enough += share.outcome == ode::Outcome::enough ? 1 : 0;
    too_few += touch && guess ? 1 : 0;
    if (guess) {
      EXPECT_EQ(share.outcome, ode::Outcome::starved) << units << " units";
    }
  }
  EXPECT_GT(enough, 5);
  EXPECT_GT(too_few, 5);
}

}  // namespace
}  // namespace odds::test
