// What answers without polygons state: see answer_odds_test.cpp for those with them.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "odds/math/random.hpp"
#include "odds/query/pair.hpp"
#include "support/all_kinds.hpp"
#include "support/shapes.hpp"

namespace odds::query {
namespace {

/// Poses of one body beside its copy, half of them hits: a part of their size deep or apart, 0 to 3 %.
struct Beside {
  math::Pose pose;
  bool hit;
};

std::vector<Beside> poses_near_touch(const std::shared_ptr<const Shape>& shape, int count) {
  math::Random random(7);
  Pair exact = Pair::make(shape, shape).value();
  const auto hits = [&](const math::Pose& pose) { return exact.run(pose, {}).verdict == Verdict::hit; };
  std::vector<Beside> poses;
  for (int i = 0; i < count; ++i) {
    const Vec3 way = random.direction();
    const Mat3 turned = random.rotation().toRotationMatrix();
    double inside = 0.0;
    double outside = 3.0;
    for (int half = 0; half < 40; ++half) {
      const double middle = 0.5 * (inside + outside);
      (hits({turned, middle * way}) ? inside : outside) = middle;
    }
    const double off = 0.06 * (random.uniform(0.0, 1.0) - 0.5);
    const math::Pose pose{turned, (inside + off) * way};
    poses.push_back({pose, hits(pose)});
  }
  return poses;
}

class PolygonFree : public ::testing::TestWithParam<volume::Kind> {};

TEST_P(PolygonFree, AnswersStateAboutHowManyOfThemAreHits) {
  ShapeOptions options;
  options.volume = GetParam();
  const auto mesh = testing::wavy_sphere(48);
  const auto poses = poses_near_touch(Shape::build(mesh).value(), 400);
  const auto without = Shape::build(mesh, options).value()->without_polygons();
  Pair pair = Pair::make(without, without).value();
  for (const EstimatorKind estimator : {EstimatorKind::cells, EstimatorKind::kinematic}) {
    for (const Budget& budget : {Budget::unlimited(), Budget::work(300)}) {
      double judged = 0.0;
      double stated = 0.0;
      double hits = 0.0;
      double squares = 0.0;
      for (const Beside& beside : poses) {
        Request request;
        request.estimator = estimator;
        request.budget = budget;
        const Answer& answer = pair.run(beside.pose, request);
        if (answer.basis == Basis::proved) {
          EXPECT_EQ(answer.verdict, Verdict::clear);
          EXPECT_FALSE(beside.hit);
          continue;
        }
        EXPECT_TRUE(answer.has_cell_pair);
        const double truth = beside.hit ? 1.0 : 0.0;
        judged += 1.0;
        stated += answer.probability;
        hits += truth;
        squares += (answer.probability - truth) * (answer.probability - truth);
      }
      ASSERT_GT(judged, 200.0);
      EXPECT_NEAR(stated / judged, hits / judged, 0.17) << static_cast<int>(estimator);
      EXPECT_LT(squares / judged, 0.28) << static_cast<int>(estimator);  // Brier score; even odds of all have .25
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllVolumes, PolygonFree, ::testing::ValuesIn(testing::all_kinds()),
                         [](const auto& tested) { return testing::name_of(tested.param); });

/// What a pair learns of itself, it learns of searches with polygons.
TEST(PolygonFreePairs, StateWhatTheyWouldHadTheyLearntNothing) {
  const auto shape = Shape::build(testing::wavy_sphere(40)).value();
  PairOptions options;
  options.calibration_poses = 48;
  Pair learnt = Pair::make(shape, shape, options).value();
  Pair plain = Pair::make(shape, shape).value();
  const math::Pose pose{Mat3::Identity(), {1.6, 0.8, 0.3}};
  Request request;
  request.budget = Budget::work(64);
  EXPECT_NE(learnt.run(pose, request).probability, plain.run(pose, request).probability);
  request.polygon_free = true;
  EXPECT_EQ(learnt.run(pose, request).probability, plain.run(pose, request).probability);
}

/// Volumes hold all of their surfaces: that none overlap is a proof, with polygons or without.
TEST(PolygonFreePairs, AreProvedApartWhereNoLeavesOverlap) {
  const auto shape = Shape::build(testing::wavy_sphere(24)).value()->without_polygons();
  Pair pair = Pair::make(shape, shape).value();
  const Answer& far = pair.run({Mat3::Identity(), {50.0, 0.0, 0.0}}, {});
  EXPECT_EQ(far.basis, Basis::proved);
  EXPECT_EQ(far.verdict, Verdict::clear);
  EXPECT_EQ(far.probability, 0.0);
  const Answer& same = pair.run({}, {});
  EXPECT_EQ(same.basis, Basis::estimated);
}

/// With the book's tau of 1 no cell of a smooth surface is well filled, so that two leaves that overlap meet with a
/// probability of 0: that is an estimate, and no proof.
TEST_P(PolygonFree, AreNotProvedApartWhereLeavesOverlapThatAreThoughtNotToMeet) {
  ShapeOptions options;
  options.volume = GetParam();
  options.tau = 1.0;
  const auto triangle = [](double side) {
    std::vector<Vec3> corners = {{0, 0, 0}, {side, 0, 0}, {side, side, 0}};
    return std::make_shared<const mesh::TriangleMesh>(
        mesh::TriangleMesh::make(std::move(corners), {{0, 1, 2}}).value());
  };
  const math::Pose across{Eigen::AngleAxisd(0.7, Vec3(1, 0.3, 0.2).normalized()).toRotationMatrix(), {0.1, 0.05, 0}};
  for (const auto& mesh : {testing::wavy_sphere(24), triangle(1.0)}) {
    const auto shape = Shape::build(mesh, options).value();
    Pair pair = Pair::make(shape, shape).value();
    Request request;
    request.method = Method::incremental;
    ASSERT_EQ(pair.run(across, request).verdict, Verdict::hit);
    request.polygon_free = true;
    for (const EstimatorKind estimator : {EstimatorKind::cells, EstimatorKind::kinematic}) {
      request.estimator = estimator;
      const Answer& met = pair.run(across, request);
      EXPECT_EQ(met.basis, Basis::estimated);
      EXPECT_GT(met.probability, 0.0);
      EXPECT_TRUE(met.has_cell_pair);
      if (GetParam() == volume::Kind::sphere) continue;
      // Within the balls about both, but not within the boxes.
      const math::Pose beside{Mat3::Identity(), {0.0, 1.3 * (mesh->upper() - mesh->lower()).y(), 0.0}};
      EXPECT_EQ(pair.run(beside, request).basis, Basis::proved);
    }
  }
}

}  // namespace
}  // namespace odds::query
