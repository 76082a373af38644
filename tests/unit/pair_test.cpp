// Answers of query::Pair on shapes that can be judged by hand.
#include "odds/query/pair.hpp"

#include "odds/math/tolerances.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "odds/mesh/made/by_name.hpp"
#include "support/all_kinds.hpp"
#include "support/brute_force.hpp"
#include "support/by_queue.hpp"
#include "support/shapes.hpp"
#include "support/slabs.hpp"

namespace odds::query {
namespace {

std::shared_ptr<const mesh::TriangleMesh> made_mesh(const std::string& name) {
  auto mesh = mesh::made::make_shape(name);
  if (!mesh.ok()) throw std::runtime_error(mesh.error().message());
  return std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value());
}

class PairOfSpheres : public ::testing::TestWithParam<std::tuple<volume::Kind, Method>> {
 protected:
  void SetUp() override {
    auto shape = Shape::build(testing::wavy_sphere(24), {.volume = std::get<0>(GetParam())});
    ASSERT_TRUE(shape.ok());
    auto pair = Pair::make(shape.value(), shape.value());
    ASSERT_TRUE(pair.ok());
    pair_ = std::make_unique<Pair>(std::move(pair).value());
    request_.method = std::get<1>(GetParam());
  }
  const Answer& at(double x) { return pair_->run({Mat3::Identity(), {x, 0, 0}}, request_); }

  std::unique_ptr<Pair> pair_;
  Request request_;
};

TEST_P(PairOfSpheres, ProvesAHitWhereTheyOverlap) {
  const Answer& answer = at(1.5);
  EXPECT_EQ(answer.verdict, Verdict::hit);
  EXPECT_EQ(answer.basis, Basis::proved);
  EXPECT_EQ(answer.probability, 1.0);
  ASSERT_EQ(answer.contacts.size(), 1u);
  EXPECT_NEAR(answer.contacts[0].normal.norm(), 1.0, 1e-12);
  EXPECT_GE(answer.contacts[0].depth, 0.0);
}

TEST_P(PairOfSpheres, ProvesThatTheyAreClear) {
  for (const double x : {2.5, 4.0, 1e6, 1e12}) {
    const Answer& answer = at(x);
    EXPECT_EQ(answer.verdict, Verdict::clear) << x;
    EXPECT_EQ(answer.basis, Basis::proved) << x;
    EXPECT_EQ(answer.probability, 0.0) << x;
    EXPECT_TRUE(answer.contacts.empty()) << x;
  }
}

TEST_P(PairOfSpheres, NeverSpendsMoreThanItsWorkBudget) {
  for (std::uint64_t units = 1; units < 200; units += 7) {
    request_.budget = Budget::work(units);
    const Answer& answer = at(1.9);
    EXPECT_LE(answer.cost.node_pairs + answer.cost.triangle_pairs, units);
    EXPECT_TRUE(answer.probability >= 0.0 && answer.probability <= 1.0);
  }
}

TEST_P(PairOfSpheres, NeitherWhereItLooksFirstAtWhatMet) {
  request_.method = Method::incremental;
  for (const int contacts : {1, 4}) {
    request_.max_contacts = contacts;
    request_.carry_motion = 1.0;
    for (std::uint64_t units = 1; units < 12; ++units) {
      request_.budget = {};
      ASSERT_EQ(at(1.9).verdict, Verdict::hit);
      request_.budget = Budget::work(units);
      const Answer& answer = at(1.999);
      EXPECT_LE(answer.cost.node_pairs + answer.cost.triangle_pairs, units) << contacts << " contacts";
    }
  }
}

TEST_P(PairOfSpheres, GivesTheSameBitsForTheSameWorkBudget) {
  request_.budget = Budget::work(60);
  const Answer first = at(1.93);
  const Answer second = at(1.93);
  EXPECT_EQ(first.probability, second.probability);
  EXPECT_EQ(first.cell_pair.position, second.cell_pair.position);
  EXPECT_EQ(first.cost.node_pairs, second.cost.node_pairs);
}

TEST_P(PairOfSpheres, OnlyProofsAreCertain) {
  for (std::uint64_t units = 1; units < 400; units += 3) {
    request_.budget = Budget::work(units);
    const Answer& answer = at(1.97);
    if (answer.basis == Basis::proved) continue;
    EXPECT_GT(answer.probability, 0.0);
    EXPECT_LT(answer.probability, 1.0);
    EXPECT_EQ(answer.verdict == Verdict::hit, answer.probability >= 0.5);
    ASSERT_TRUE(answer.has_cell_pair);
    EXPECT_TRUE(answer.cell_pair.position.allFinite());
    EXPECT_NEAR(answer.cell_pair.normal.norm(), 1.0, 1e-9);
    EXPECT_GE(answer.cell_pair.depth, 0.0);
  }
}

// Otherwise the lower the threshold, the fewer hits: the first pairs that a search meets are the least likely.
TEST_P(PairOfSpheres, WhatPassesALowThresholdIsAHit) {
  int passed = 0;
  request_.max_contacts = 0;
  for (const EstimatorKind estimator : {EstimatorKind::cells, EstimatorKind::kinematic}) {
    request_.estimator = estimator;
    for (const double p_min : {0.05, 0.3}) {
      request_.p_min = p_min;
      for (const std::uint32_t k_min : {1U, 10U}) {
        request_.k_min = k_min;
        for (const double x : {1.0, 1.5, 1.9}) {
          const Answer& answer = at(x);
          if (answer.basis != Basis::estimated) continue;
          ++passed;
          EXPECT_EQ(answer.verdict, Verdict::hit) << p_min << " " << k_min << " " << x;
          EXPECT_GE(answer.probability, 0.5);
          EXPECT_LT(answer.probability, 1.0);
        }
      }
    }
  }
  if (request_.method != Method::exact) {
    EXPECT_GT(passed, 6);
  }
}

TEST_P(PairOfSpheres, RefusesAPoseThatIsNotRigid) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1.01}) {
    math::Pose pose;
    pose.rotation(0, 0) = bad;
    const Answer& answer = pair_->run(pose, request_);
    EXPECT_EQ(answer.basis, Basis::budget);
    EXPECT_EQ(answer.probability, 0.5);
    EXPECT_TRUE(answer.contacts.empty());
  }
}

TEST_P(PairOfSpheres, StopsAtAnInjectedDeadline) {
  // Every reading of this clock takes 1 us: a budget of 12 us must end after 12 readings at most, plus the closing one.
  realtime::ManualClock clock(1000);
  request_.budget = Budget::time(12.0);
  request_.budget.clock = clock.clock();
  const Answer& answer = at(1.99);
  EXPECT_LE(clock.readings(), 14);
  EXPECT_LE(answer.cost.overshoot_us, 1.0);
  // The wide engine tests 8 boxes or up to 64 pairs of triangles at once, each in a tenth of the time.
  const std::uint32_t most = std::get<0>(GetParam()) == volume::Kind::wide ? 112 : 16;
  EXPECT_LE(answer.cost.longest_unpolled_units, most);
}

TEST_P(PairOfSpheres, ReadsNoClockIfNothingAsksForTheTime) {
  realtime::ManualClock clock(1000);
  request_.budget.clock = clock.clock();
  request_.max_contacts = 8;
  request_.timed = false;
  for (const double distance : {1.9, 2.1, 9.0}) {
    const Answer& answer = at(distance);
    EXPECT_EQ(answer.verdict, distance < 2.0 ? Verdict::hit : Verdict::clear);
    EXPECT_EQ(answer.cost.gross_us, 0.0);
  }
  EXPECT_EQ(clock.readings(), 0);
  request_.timed = true;
  EXPECT_EQ(at(2.1).cost.gross_us, 1.0);
  EXPECT_EQ(clock.readings(), 2);
  request_.timed = false;
  request_.budget.microseconds = 1e6;
  EXPECT_GT(at(2.1).cost.gross_us, 0.0) << "a limit of time is kept all the same";
}

// A pair of hulls takes as long as dozens of boxes.
class PairOfHulls : public PairOfSpheres {};

TEST_P(PairOfHulls, LooksAtTheClockBeforeEachPiece) {
  realtime::ManualClock clock(100);
  request_.budget = Budget::time(12.0);
  request_.budget.clock = clock.clock();
  const Answer& answer = at(1.99);
  EXPECT_GT(answer.cost.node_pairs, 20u);
  EXPECT_LE(answer.cost.node_pairs, static_cast<std::uint64_t>(clock.readings()));
  // Neither the first pair of all, where the answer alone needs the time.
  pair_->reset();
  realtime::ManualClock late(300);
  request_.budget = Budget::time(1.0);
  request_.budget.clock = late.clock();
  const Answer& guess = at(1.99);
  EXPECT_EQ(guess.cost.node_pairs, 0u);
  EXPECT_EQ(guess.basis, Basis::budget);
  EXPECT_TRUE(guess.has_cell_pair);
  EXPECT_LE(guess.cost.overshoot_us, 0.3);
}

INSTANTIATE_TEST_SUITE_P(AllMethods, PairOfHulls,
                         ::testing::Combine(::testing::Values(volume::Kind::hull),
                                            ::testing::Values(Method::exact, Method::time_critical,
                                                              Method::incremental)),
                         [](const auto& tested) {
                           const Method method = std::get<1>(tested.param);
                           return std::string(method == Method::exact           ? "exact"
                                              : method == Method::time_critical ? "time_critical"
                                                                                : "incremental");
                         });

INSTANTIATE_TEST_SUITE_P(AllVolumesAndMethods, PairOfSpheres,
                         ::testing::Combine(::testing::ValuesIn(testing::all_kinds()),
                                            ::testing::Values(Method::exact, Method::time_critical)),
                         [](const auto& tested) {
                           return std::string(volume::name(std::get<0>(tested.param))) +
                                  (std::get<1>(tested.param) == Method::exact ? "_exact" : "_time_critical");
                         });

TEST(Pair, RefusesUnlikeVolumes) {
  const auto a = Shape::build(testing::wavy_sphere(6), {.volume = volume::Kind::aabb});
  const auto b = Shape::build(testing::wavy_sphere(6), {.volume = volume::Kind::obb});
  const auto pair = Pair::make(a.value(), b.value());
  ASSERT_FALSE(pair.ok());
  EXPECT_NE(pair.error().message().find("same volume"), std::string::npos);
}

TEST(Shape, KnowsAClosedMeshFromASheet) {
  const auto closed = testing::wavy_sphere(6);
  EXPECT_TRUE(Shape::build(closed).value()->is_solid());
  const std::vector<Vec3> vertices(closed->vertices().begin(), closed->vertices().end());
  std::vector<mesh::Triangle> triangles(closed->triangles().begin(), closed->triangles().end());
  const auto build = [&](const std::vector<mesh::Triangle>& changed) {
    return Shape::build(std::make_shared<const mesh::TriangleMesh>(
                            std::move(mesh::TriangleMesh::make(vertices, changed)).value()))
        .value();
  };
  const std::vector<mesh::Triangle> open(triangles.begin() + 1, triangles.end());
  EXPECT_FALSE(build(open)->is_solid());
  for (mesh::Triangle& triangle : triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_FALSE(build(triangles)->is_solid()) << "it faces inwards";
}

TEST(Pair, BothEstimatorsLeadToTheSameProofsByDifferentWays) {
  // The wide engine is searched depth-first, without an estimate.
  const auto shape = Shape::build(testing::wavy_sphere(24), {.volume = volume::Kind::obb}).value();
  auto pair = std::move(Pair::make(shape, shape)).value();
  bool differ = false;
  for (double x = 1.7; x < 2.2; x += 0.05) {
    const math::Pose pose{Mat3::Identity(), {x, 0.1, 0.2}};
    const Answer cells = pair.run(pose, {.estimator = EstimatorKind::cells});
    const Answer kinematic = pair.run(pose, {.estimator = EstimatorKind::kinematic});
    EXPECT_EQ(cells.verdict, kinematic.verdict) << x;
    EXPECT_EQ(cells.basis, Basis::proved);
    differ = differ || cells.cost.node_pairs != kinematic.cost.node_pairs;
    for (const auto estimator : {EstimatorKind::cells, EstimatorKind::kinematic}) {
      const Answer short_of_time = pair.run(pose, {.estimator = estimator, .budget = Budget::work(30)});
      EXPECT_TRUE(short_of_time.probability >= 0.0 && short_of_time.probability <= 1.0);
    }
  }
  EXPECT_TRUE(differ) << "the order of the search must depend on the estimator";
}

TEST(Pair, AGlanceAtTheRootsNeverPushesDeep) {
  // With hardly any work the candidate is a pair of whole bodies: where they are is known, how deep they overlap is
  // not.
  const auto shape = Shape::build(testing::wavy_sphere(24)).value();
  auto pair = std::move(Pair::make(shape, shape)).value();
  for (std::uint64_t units = 1; units < 8; ++units) {
    const Answer& answer = pair.run({Mat3::Identity(), {1.2, 0.3, 0.1}}, {.budget = Budget::work(units)});
    ASSERT_TRUE(answer.has_cell_pair);
    EXPECT_LT(answer.cell_pair.depth, 0.05) << units << " units";
  }
}

TEST(Pair, ASearchCutShortHardlyPushesWhereNoDepthIsKnown) {
  // A bolt in its nut touches with hundreds of triangles; part of them may span anything, also across the bolt.
  const auto bolt = Shape::build(made_mesh("bolt"));
  const auto nut = Shape::build(made_mesh("nut"));
  ASSERT_TRUE(bolt.ok() && nut.ok());
  Request request;
  request.max_contacts = 8;
  const math::Pose beside{Mat3::Identity(), {1e-4, 0.0, -0.0025}};  // of the nut, whose clearance is 0.03 mm
  int cut_short = 0;
  for (const std::uint64_t units : {100U, 300U, 1000U, 3000U, 10000U}) {
    request.budget = Budget::work(units);
    auto pair = Pair::make(bolt.value(), nut.value());
    ASSERT_TRUE(pair.ok());
    const Answer& answer = pair.value().run(beside, request);
    if (answer.contacts.empty() || answer.contacts_complete) continue;
    ++cut_short;
    const double believed =
        tolerances::unmeasured_depth * std::min(bolt.value()->mesh().size(), nut.value()->mesh().size());
    for (const Contact& contact : answer.contacts) EXPECT_LE(contact.depth, believed) << units << " units";
  }
  EXPECT_GE(cut_short, 2);
}

TEST(Pair, AHitThatIsEnoughHasItsDepthThoughNoneIsKnown) {
  // One contact, or more triangles than are kept: the search ends before all is seen, but what was asked is done.
  const auto box = Shape::build(made_mesh("box:x=0.2,y=0.2,z=0.2")).value();
  auto boxes = std::move(Pair::make(box, box)).value();
  const math::Pose beside{Mat3::Identity(), {0.0, 0.01, 0.19}};
  const Answer& one = boxes.run(beside, {.max_contacts = 1});
  ASSERT_EQ(one.contacts.size(), 1U);
  EXPECT_TRUE(one.contacts_complete);
  EXPECT_GT(one.contacts[0].depth, 0.0);
  const auto ball = Shape::build(testing::wavy_sphere(24)).value();
  auto balls = std::move(Pair::make(ball, ball, {.hit_capacity = 16})).value();
  const Answer& many = balls.run({Mat3::Identity(), {1.2, 0.3, 0.1}}, {.max_contacts = 8});
  ASSERT_FALSE(many.contacts.empty());
  EXPECT_GT(many.contacts[0].depth, 0.0);
}

TEST(Pair, ALumpAtACornerOfFlushBricksIsNotPushedFromEndToEnd) {
  // Walls that coincide to 2 nm and 25 nrad: at one corner the rounding of the turn makes a rim of its own.
  const auto brick = Shape::build(made_mesh("box:x=0.2,y=0.5,z=0.248")).value();
  auto pair = std::move(Pair::make(brick, brick)).value();
  math::Pose pose;
  pose.rotation << 0.99999999999999989, 1.3504912776384688e-08, -7.4509883184334598e-09, -1.3504912672059829e-08,
      0.99999999999999978, 1.2171243966113742e-08, 7.4509885075222164e-09, -1.2171243850357446e-08, 0.99999999999999989;
  pose.translation = {2.3786570551535305e-09, -1.5867360871792951e-10, -0.24797026431371449};
  const Answer& answer = pair.run(pose, {.max_contacts = 8});
  ASSERT_GE(answer.contacts.size(), 4U);
  for (const Contact& contact : answer.contacts) {
    EXPECT_GT(contact.normal.z(), 0.99);
    EXPECT_LT(contact.depth, 1e-4);
  }
}

TEST(Pair, AnIncrementalRunWithoutTimeIsNotSureOfAnything) {
  const auto shape = Shape::build(testing::wavy_sphere(24)).value();
  auto pair = std::move(Pair::make(shape, shape)).value();
  const math::Pose overlapping{Mat3::Identity(), {1.2, 0.3, 0.1}};
  for (const std::uint64_t units : {1U, 4U, 8U, 16U}) {
    pair.reset();
    const Answer& answer = pair.run(overlapping, {.method = Method::incremental, .budget = Budget::work(units)});
    if (answer.basis == Basis::proved) continue;
    EXPECT_TRUE(answer.has_cell_pair) << units << " units";
    EXPECT_GT(answer.probability, 1e-3) << units << " units";
  }
}

// A queue proves less in the same time.
TEST(Pair, OnlyRequestsThatCountLikelyPairsAreSearchedInAnotherOrderThanExact) {
  const auto shape = Shape::build(testing::wavy_sphere(24)).value();
  auto pair = std::move(Pair::make(shape, shape)).value();
  const math::Pose overlapping{Mat3::Identity(), {1.2, 0.3, 0.1}};
  int undecided = 0;
  int in_another_order = 0;
  for (const std::uint64_t units : {8U, 16U, 24U, 32U, 48U, 64U}) {
    const Answer exact = pair.run(overlapping, {.method = Method::exact, .budget = Budget::work(units)});
    const Answer usual = pair.run(overlapping, {.budget = Budget::work(units)});
    EXPECT_EQ(usual.basis, exact.basis) << units << " units";
    EXPECT_EQ(usual.probability, exact.probability) << units << " units";
    EXPECT_EQ(usual.cell_pair.position, exact.cell_pair.position) << units << " units";
    const Answer counting = pair.run(overlapping, testing::by_queue({.budget = Budget::work(units)}));
    undecided += exact.basis == Basis::proved ? 0 : 1;
    in_another_order += counting.cell_pair.position == exact.cell_pair.position ? 0 : 1;
  }
  EXPECT_GE(undecided, 3);
  EXPECT_GE(in_another_order, 1);
}

// To ask how probable a pair is takes longer than to open one.
TEST(Pair, ReadsTheClockBetweenEstimates) {
  const auto outer = Shape::build(testing::wavy_sphere(48)).value();
  const auto inner =
      Shape::build(testing::changed(*testing::wavy_sphere(48), 0.995, {Mat3::Identity(), Vec3::Zero()}, 0)).value();
  auto pair = std::move(Pair::make(outer, inner)).value();
  for (const EstimatorKind estimator : {EstimatorKind::kinematic, EstimatorKind::cells}) {
    for (const bool polygon_free : {false, true}) {
      // Lanes are ordered by how deep they overlap, unless their cells are counted.
      if (polygon_free && estimator == EstimatorKind::kinematic) continue;
      realtime::ManualClock clock(0);
      Request request;
      request.estimator = estimator;
      request.polygon_free = polygon_free;
      request.p_min = 0.9999999;
      request.k_min = 1'000'000;
      request.max_contacts = 0;
      request.budget = Budget::time(1e6);
      request.budget.clock = clock.clock();
      const Answer& answer = pair.run({}, request);
      EXPECT_GT(clock.readings(), static_cast<std::int64_t>(answer.cost.node_pairs / 8)) << polygon_free;
    }
  }
}

TEST(Pair, SaysAQuickEstimatedHitOnlyIfAsked) {
  const auto shape = Shape::build(testing::wavy_sphere(96));
  auto pair = std::move(Pair::make(shape.value(), shape.value())).value();
  Request request;
  request.p_min = 0.5;
  request.k_min = 1;
  const Answer& answer = pair.run({Mat3::Identity(), {1.0, 0, 0}}, request);
  EXPECT_EQ(answer.basis, Basis::estimated);
  EXPECT_EQ(answer.verdict, Verdict::hit);
}

// Where the contact of the run before was one with the floor, the wall's is not measured there, through the floor.
TEST(Pair, AContactAtAWallIsNotAsDeepAsTheFloorIsLong) {
  using testing::made_mesh;
  const auto solid = [](mesh::TriangleMesh mesh) {
    return Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh))).value();
  };
  const auto room = solid(testing::joined(made_mesh("made:box:x=2,y=1,z=0.2,cells=4"),
                                          made_mesh("made:box:x=0.1,y=1,z=0.6,cells=4"), Vec3(0.6, 0, 0.405)));
  const auto crate = solid(made_mesh("made:box:x=0.2,y=0.2,z=0.2,cells=4"));
  for (const double depth : {6e-11, 1e-8, 1e-5, 1e-4}) {
    Pair pair = std::move(Pair::make(room, crate)).value();
    Request request;
    request.max_contacts = 8;
    const double yaw = 0.65;
    const double reach = 0.1 * (std::cos(yaw) + std::sin(yaw));
    math::Pose pose;
    pose.rotation = Eigen::AngleAxisd(yaw, Vec3::UnitZ()).toRotationMatrix();
    for (const double into_wall : {-1e-3, -4.5e-4, 1e-4}) {
      pose.translation = {0.55 - reach + into_wall, 0.1, 0.2 - depth};
      for (const Contact& contact : pair.run(pose, request).contacts) EXPECT_LT(contact.depth, 2e-4) << depth;
    }
  }
}

// A pair's first run, while it is made, was timed by the processor's clock, and what it took was remembered: starved
// scenes that make pairs as they go did not repeat, though their clock was counted.
TEST(Pair, HasLearntNothingOfTheMomentWhenItWasMade) {
  const auto hulls = [](const std::string& name) {  // whose overlaps take long enough for the time to be up
    return Shape::build(made_mesh(name), {.volume = volume::Kind::hull}).value();
  };
  const auto inner = hulls("made:icosphere:frequency=8,radius=1");
  const auto outer = hulls("made:icosphere:frequency=8,radius=1.03");
  std::vector<std::uint64_t> units;
  for (int i = 0; i < 200; ++i) {
    Pair pair = std::move(Pair::make(inner, outer)).value();
    realtime::ManualClock clock(10);
    Request request;
    request.method = Method::exact;
    request.budget = {.microseconds = 4.0, .clock = clock.clock()};
    const Answer& answer = pair.run({}, request);
    ASSERT_EQ(answer.basis, Basis::budget) << "it should use all of its time";
    units.push_back(answer.cost.node_pairs + answer.cost.triangle_pairs);
  }
  EXPECT_EQ(*std::min_element(units.begin(), units.end()), *std::max_element(units.begin(), units.end()));
}

}  // namespace
}  // namespace odds::query
