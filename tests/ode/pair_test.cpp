// Workspaces of pairs: prepared, made late, freed; answers; budgets and what an undecided query gives.
#include <atomic>
#include <cmath>
#include <thread>

#include "ode/frame/frame_share.hpp"
#include "ode/ode_fixture.hpp"

namespace odds::test {
namespace {

class PairTest : public OdeTest {
 protected:
  void SetUp() override {
    OdeTest::SetUp();
    shape = sphere_shape(1.0, 12);
    a = mesh_geom(shape, space);
    b = mesh_geom(shape, space);
    dGeomSetPosition(b, 1.9, 0.1, 0);
  }
  oddsAnswer answer_of(dGeomID g1, dGeomID g2) {
    oddsAnswer answer = {};
    EXPECT_EQ(oddsGetLastAnswer(g1, g2, &answer), 1) << oddsGetLastError();
    return answer;
  }
  std::shared_ptr<const query::Shape> shape;
  dGeomID a = nullptr;
  dGeomID b = nullptr;
};

TEST_F(PairTest, PreparedOnceInEitherOrder) {
  EXPECT_EQ(oddsPreparePair(a, b), 1);
  EXPECT_EQ(oddsPreparePair(b, a), 1);
  EXPECT_EQ(stats().live_pairs, 1u);
  EXPECT_FALSE(collide(b, a).empty());
  EXPECT_FALSE(collide(a, b).empty());
  EXPECT_EQ(stats().live_pairs, 1u);
  EXPECT_EQ(stats().lazy_pairs, 0u);
}

TEST_F(PairTest, AnUnpreparedPairIsMadeAtFirstContactAndCounted) {
  EXPECT_FALSE(collide(a, b).empty());
  EXPECT_FALSE(collide(b, a).empty());
  EXPECT_EQ(stats().lazy_pairs, 1u);
  EXPECT_EQ(stats().live_pairs, 1u);
}

TEST_F(PairTest, DestroyingAGeomFreesItsWorkspacesOnly) {
  const dGeomID c = mesh_geom(shape, space);
  ASSERT_EQ(oddsPreparePair(a, b), 1);
  ASSERT_EQ(oddsPreparePair(a, c), 1);
  ASSERT_EQ(oddsPreparePair(b, c), 1);
  dGeomDestroy(a);
  EXPECT_EQ(stats().live_pairs, 1u);
  collide(b, c);
  EXPECT_EQ(stats().lazy_pairs, 0u);
  // A new geom may get the address of the old one; it must not inherit its workspace.
  const dGeomID d = mesh_geom(shape, space);
  oddsAnswer answer;
  EXPECT_EQ(oddsGetLastAnswer(d, b, &answer), 0);
  collide(d, b);
  EXPECT_EQ(stats().lazy_pairs, 1u);
}

TEST_F(PairTest, ManyPairsAreFoundAndFreed) {
  std::vector<dGeomID> many;
  const auto small = box_shape(1, 1, 1);
  for (int i = 0; i < 40; ++i) many.push_back(mesh_geom(small, space));
  for (std::size_t i = 0; i < many.size(); ++i) {
    for (std::size_t j = i + 1; j < many.size(); ++j) ASSERT_EQ(oddsPreparePair(many[j], many[i]), 1);
  }
  EXPECT_EQ(stats().live_pairs, 780u);
  for (std::size_t i = 0; i < many.size(); ++i) {
    for (std::size_t j = i + 1; j < many.size(); ++j) collide(many[i], many[j], 1);
  }
  EXPECT_EQ(stats().lazy_pairs, 0u);
  for (std::size_t i = 0; i < many.size(); i += 2) dGeomDestroy(many[i]);
  EXPECT_EQ(stats().live_pairs, 190u);
}

TEST_F(PairTest, PreparingRefusesWhatCannotCollide) {
  const dGeomID sphere = dCreateSphere(space, 1);
  const dGeomID plane = dCreatePlane(space, 0, 0, 1, 0);
  EXPECT_EQ(oddsPreparePair(a, sphere), 1) << "needs no memory";
  EXPECT_EQ(oddsPreparePair(sphere, plane), 0);
  EXPECT_EQ(oddsPreparePair(a, a), 0);
  EXPECT_EQ(oddsPreparePair(a, nullptr), 0);
  EXPECT_EQ(oddsPreparePair(a, reinterpret_cast<dGeomID>(space)), 0);
  EXPECT_NE(std::string(oddsGetLastError()).find("space"), std::string::npos);
}

TEST_F(PairTest, UnlikeVolumesAreRefusedNotSilentlyMissed) {
  query::ShapeOptions spheres;
  spheres.volume = volume::Kind::sphere;
  auto unlike = query::Shape::build(std::make_shared<const mesh::TriangleMesh>(shape->mesh()), spheres);
  ASSERT_TRUE(unlike.ok());
  const dGeomID c = mesh_geom(unlike.value(), space);
  EXPECT_EQ(oddsPreparePair(a, c), 0);
  EXPECT_STRNE(oddsGetLastError(), "");
  EXPECT_TRUE(collide(a, c).empty());
  EXPECT_EQ(stats().failed_pairs, 1u);
}

TEST_F(PairTest, LastAnswerSaysWhatHappened) {
  oddsAnswer answer;
  EXPECT_EQ(oddsGetLastAnswer(a, b, &answer), 0) << "never collided";
  const auto contacts = collide(a, b);
  answer = answer_of(a, b);
  EXPECT_EQ(answer.verdict, ODDS_HIT);
  EXPECT_EQ(answer.basis, ODDS_PROVED);
  EXPECT_EQ(answer.probability, 1.0);
  EXPECT_EQ(answer.contacts, static_cast<int>(contacts.size()));
  EXPECT_GT(answer.node_pairs, 0u);
  EXPECT_GT(answer.triangle_pairs, 0u);
  EXPECT_GT(answer.gross_us, 0.0);
  EXPECT_EQ(answer.from_cell_pair, 0);
  dGeomSetPosition(b, 2.5, 0, 0);
  EXPECT_TRUE(collide(a, b).empty());
  answer = answer_of(b, a);
  EXPECT_EQ(answer.verdict, ODDS_CLEAR);
  EXPECT_EQ(answer.basis, ODDS_PROVED);
  EXPECT_EQ(answer.probability, 0.0);
  EXPECT_EQ(answer.contacts, 0);
}

TEST_F(PairTest, StatisticsAddUp) {
  collide(a, b);
  dGeomOddsMeshSetWorkBudget(a, 1);
  dGeomOddsMeshSetWorkBudget(b, 1);
  dGeomSetPosition(b, 1.99, 0, 0);
  collide(a, b);
  dGeomSetPosition(b, 5, 0, 0);
  collide(a, b);
  const oddsStats now = stats();
  EXPECT_EQ(now.queries, 3u);
  EXPECT_EQ(now.queries_proved + now.queries_estimated + now.queries_budget, now.queries);
  EXPECT_EQ(now.queries_budget, 1u);
}

// Of more pairs of triangles than are kept, a search that goes on from run to run was taken for cut off by its budget
// however long that was, and such an overlap was never more than a ten-thousandth deep.
TEST_F(PairTest, ADeepOverlapOfManyTrianglesIsAsDeepWithinTimeForAllAsWithoutALimit) {
  const auto fine = sphere_shape(1.0, 48);
  const dGeomID unlimited_a = mesh_geom(fine, space);
  const dGeomID unlimited_b = mesh_geom(fine, space);
  const dGeomID limited_a = mesh_geom(fine, space);
  const dGeomID limited_b = mesh_geom(fine, space);
  for (const dGeomID other : {unlimited_b, limited_b}) dGeomSetPosition(other, 1.3, 0.1, 0.05);
  dGeomOddsMeshSetBudget(limited_a, 1e6);
  const SlowLooks looks(100);  // the time is counted, a fraction of that budget whatever the machine
  const auto without = collide(unlimited_a, unlimited_b);
  const auto within = collide(limited_a, limited_b);
  ASSERT_FALSE(without.empty());
  ASSERT_FALSE(within.empty());
  EXPECT_GT(without[0].depth, 0.5);
  EXPECT_NEAR(within[0].depth, without[0].depth, 1e-6);
  EXPECT_LT(answer_of(limited_a, limited_b).overshoot_us, 1e-9);
}

// With one unit of work nothing can be proved of two overlapping spheres.
class UndecidedPair : public PairTest {
 protected:
  void SetUp() override {
    PairTest::SetUp();
    ASSERT_EQ(dGeomOddsMeshSetWorkBudget(a, 1), 1);
    dGeomSetPosition(b, 0.5, 0.1, 0);
  }
};

TEST_F(UndecidedPair, GivesTheMostProbableCellPairAsOneContact) {
  ASSERT_EQ(dGeomOddsMeshSetUndecidedPolicy(a, ODDS_UNDECIDED_HIT, 0.0), 1);
  ASSERT_EQ(dGeomOddsMeshSetUndecidedPolicy(b, ODDS_UNDECIDED_HIT, 0.0), 1);
  const auto contacts = collide(a, b);
  const oddsAnswer answer = answer_of(a, b);
  EXPECT_EQ(answer.basis, ODDS_BUDGET);
  ASSERT_GT(answer.probability, 0.0);
  EXPECT_LT(answer.probability, 1.0);
  ASSERT_EQ(contacts.size(), 1u);
  expect_sound(contacts, a, b);
  EXPECT_EQ(answer.from_cell_pair, 1);
  EXPECT_EQ(answer.has_cell_pair, 1);
  EXPECT_EQ(contacts[0].side1, -1);
  EXPECT_EQ(contacts[0].side2, -1);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(contacts[0].pos[axis], answer.cell_position[axis], 1e-12);
    EXPECT_NEAR(contacts[0].normal[axis], answer.cell_normal[axis], 1e-12);
  }
  const oddsAnswer swapped = answer_of(b, a);
  for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(swapped.cell_normal[axis], -answer.cell_normal[axis]);
  EXPECT_EQ(stats().cell_pair_contacts, 1u);
}

TEST_F(UndecidedPair, GivesNothingIfTheProbabilityIsTooLow) {
  dGeomOddsMeshSetUndecidedPolicy(b, ODDS_UNDECIDED_HIT, 0.999);  // one that touches would go on doing so
  EXPECT_TRUE(collide(a, b).empty());
  const double probability = answer_of(a, b).probability;
  ASSERT_LT(probability, 1.0);
  dGeomOddsMeshSetUndecidedPolicy(b, ODDS_UNDECIDED_HIT, probability);  // "exceeds p", so not at p itself
  EXPECT_TRUE(collide(a, b).empty());
  EXPECT_EQ(answer_of(a, b).from_cell_pair, 0);
  EXPECT_EQ(answer_of(a, b).basis, ODDS_BUDGET);
}

/// The probability of a short search swings about the threshold; a contact must not come and go with it.
TEST_F(UndecidedPair, GoesOnTouchingUntilTheOddsAreWellBelow) {
  collide(a, b);
  const double probability = answer_of(a, b).probability;
  const double odds = probability / (1.0 - probability);
  const auto touches_at = [&](double asked) {
    for (const dGeomID geom : {a, b}) {
      EXPECT_EQ(dGeomOddsMeshSetUndecidedPolicy(geom, ODDS_UNDECIDED_HIT, asked / (1.0 + asked)), 1);
    }
    const bool touches = !collide(a, b).empty();
    EXPECT_EQ(answer_of(a, b).basis, ODDS_BUDGET);
    EXPECT_EQ(answer_of(a, b).probability, probability);
    return touches;
  };
  EXPECT_FALSE(touches_at(odds / 0.55));
  EXPECT_FALSE(touches_at(odds / 0.65)) << "has not touched before";
  EXPECT_TRUE(touches_at(0.9 * odds));
  EXPECT_TRUE(touches_at(odds / 0.65)) << "0.6 of it are enough now";
  EXPECT_TRUE(touches_at(odds / 0.65)) << "and go on being enough";
  ode::FrameShare no_turn;
  no_turn.only_held = true;
  ode::current_share = &no_turn;
  collide(a, b);
  ode::current_share = nullptr;
  EXPECT_TRUE(touches_at(odds / 0.65)) << "also after a frame in which it was not this pair's turn";
  EXPECT_FALSE(touches_at(odds / 0.55));
  EXPECT_FALSE(touches_at(odds / 0.65));
}

TEST_F(UndecidedPair, HoldsOnToWhatMetAMomentAgo) {
  ASSERT_EQ(dGeomOddsMeshSetUndecidedPolicy(b, ODDS_UNDECIDED_HIT, 0.999), 1);
  // By an estimate, of which no contacts are held.
  const auto decided_at = [&](double x, double y, int basis, int verdict) {
    for (const dGeomID geom : {a, b}) {
      dGeomOddsMeshSetWorkBudget(geom, 0);
      dGeomOddsMeshSetPMin(geom, 0.5);
      dGeomOddsMeshSetKMin(geom, 1);
    }
    dGeomSetPosition(b, x, y, 0);
    collide(a, b);
    EXPECT_EQ(answer_of(a, b).basis, basis);
    EXPECT_EQ(answer_of(a, b).verdict, verdict);
    dGeomOddsMeshSetPMin(a, 1.0);
    dGeomOddsMeshSetWorkBudget(a, 1);
    dGeomSetPosition(b, 0.2, -1.5, 0);
  };
  decided_at(0.2, -1.5, ODDS_ESTIMATED, ODDS_HIT);
  for (int run = 0; run < 16; ++run) {
    const auto contacts = collide(a, b);
    ASSERT_EQ(contacts.size(), 1u) << run;
    EXPECT_EQ(contacts[0].depth, 0.0) << "nobody has measured it";
    EXPECT_EQ(answer_of(a, b).from_cell_pair, 1);
    EXPECT_EQ(answer_of(a, b).basis, ODDS_BUDGET);
  }
  EXPECT_TRUE(collide(a, b).empty()) << "that was not a moment ago";
  decided_at(0.2, -1.4, ODDS_ESTIMATED, ODDS_HIT);
  EXPECT_FALSE(collide(a, b).empty());
  decided_at(0.2, 1.4, ODDS_ESTIMATED, ODDS_HIT);
  EXPECT_TRUE(collide(a, b).empty()) << "that was elsewhere";
  decided_at(0.2, -1.4, ODDS_ESTIMATED, ODDS_HIT);
  decided_at(2.5, 0.0, ODDS_PROVED, ODDS_CLEAR);
  EXPECT_TRUE(collide(a, b).empty()) << "proved apart since";
}

TEST_F(UndecidedPair, GivesNothingIfEitherGeomSaysSo) {
  dGeomOddsMeshSetUndecidedPolicy(a, ODDS_UNDECIDED_HIT, 0.0);
  dGeomOddsMeshSetUndecidedPolicy(b, ODDS_UNDECIDED_NO_CONTACT, 0.0);
  EXPECT_TRUE(collide(a, b).empty());
  EXPECT_EQ(answer_of(a, b).has_cell_pair, 1);
}

TEST_F(UndecidedPair, TheSmallerBudgetOfBothHolds) {
  collide(a, b);
  EXPECT_EQ(answer_of(a, b).basis, ODDS_BUDGET) << "a allows one unit, b any number";
  dGeomOddsMeshSetWorkBudget(a, 0);
  dGeomOddsMeshSetWorkBudget(b, 1);
  collide(a, b);
  EXPECT_EQ(answer_of(a, b).basis, ODDS_BUDGET);
  dGeomOddsMeshSetWorkBudget(b, 0);
  collide(a, b);
  EXPECT_EQ(answer_of(a, b).basis, ODDS_PROVED);
}

TEST_F(UndecidedPair, WorkBudgetsRepeatBitForBit) {
  dGeomOddsMeshSetUndecidedPolicy(a, ODDS_UNDECIDED_HIT, 0.0);
  dGeomOddsMeshSetUndecidedPolicy(b, ODDS_UNDECIDED_HIT, 0.0);
  dGeomOddsMeshSetWorkBudget(a, 40);
  const dGeomID c = mesh_geom(shape, space);
  const dGeomID d = mesh_geom(shape, space);
  dGeomSetPosition(d, 0.5, 0.1, 0);
  dGeomOddsMeshSetWorkBudget(c, 40);
  dGeomOddsMeshSetUndecidedPolicy(c, ODDS_UNDECIDED_HIT, 0.0);
  dGeomOddsMeshSetUndecidedPolicy(d, ODDS_UNDECIDED_HIT, 0.0);
  const auto first = collide(a, b);
  const auto second = collide(c, d);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(position_of(first[i]), position_of(second[i]));
    EXPECT_EQ(normal_of(first[i]), normal_of(second[i]));
    EXPECT_EQ(first[i].depth, second[i].depth);
  }
  EXPECT_EQ(answer_of(a, b).probability, answer_of(c, d).probability);
  EXPECT_EQ(answer_of(a, b).node_pairs, answer_of(c, d).node_pairs);
}

TEST_F(PairTest, TwoThreadsOnTwoPairsGiveWhatOneThreadGives) {
  const dGeomID c = mesh_geom(shape, space);
  const dGeomID d = mesh_geom(shape, space);
  dGeomSetPosition(c, 0, 10, 0);
  dGeomSetPosition(d, 1.8, 10.1, 0.3);
  ASSERT_EQ(oddsPreparePair(a, b), 1);
  ASSERT_EQ(oddsPreparePair(c, d), 1);
  for (const dGeomID geom : {a, b, c, d}) dGeomOddsMeshSetMethod(geom, ODDS_METHOD_EXACT);
  dSpaceClean(space);
  const auto alone_ab = collide(a, b);
  const auto alone_cd = collide(c, d);
  ASSERT_FALSE(alone_ab.empty());
  ASSERT_FALSE(alone_cd.empty());
  std::atomic<int> different{0};
  const auto repeat = [&different](dGeomID g1, dGeomID g2, const std::vector<dContactGeom>& expected) {
    for (int i = 0; i < 200; ++i) {
      const auto now = collide(g1, g2);
      const bool same = now.size() == expected.size() && position_of(now[0]) == position_of(expected[0]);
      if (!same) ++different;
    }
  };
  std::thread other([&] { repeat(c, d, alone_cd); });
  repeat(a, b, alone_ab);
  other.join();
  EXPECT_EQ(different.load(), 0);
}

TEST_F(PairTest, OnePairInTwoThreadsIsRefusedOrAnsweredNeverTorn) {
  ASSERT_EQ(oddsPreparePair(a, b), 1);
  dSpaceClean(space);
  std::atomic<unsigned> answered{0};
  std::atomic<unsigned> empty{0};
  const auto repeat = [&] {
    for (int i = 0; i < 300; ++i) ++(collide(a, b, 4).empty() ? empty : answered);
  };
  std::thread other(repeat);
  repeat();
  other.join();
  EXPECT_EQ(answered + empty, 600u);
  EXPECT_EQ(stats().busy_pairs, empty.load());
  EXPECT_GT(answered.load(), 0u);
}

}  // namespace
}  // namespace odds::test
