// Distances against every triangle with every triangle.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "odds/math/random.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/primitive/triangle_distance.hpp"
#include "odds/query/pair.hpp"
#include "support/shapes.hpp"

namespace odds::query {
namespace {

using Mesh = std::shared_ptr<const mesh::TriangleMesh>;

double brute_force(const mesh::TriangleMesh& a, const mesh::TriangleMesh& b, const math::Pose& pose) {
  double least = std::numeric_limits<double>::infinity();
  for (const mesh::Triangle& tb : b.triangles()) {
    const Vec3 on_b[3] = {pose * b.vertices()[tb[0]], pose * b.vertices()[tb[1]], pose * b.vertices()[tb[2]]};
    for (const mesh::Triangle& ta : a.triangles()) {
      const Vec3 on_a[3] = {a.vertices()[ta[0]], a.vertices()[ta[1]], a.vertices()[ta[2]]};
      least = std::min(least, primitive::closest_points(on_a, on_b).squared_distance);
    }
  }
  return std::sqrt(least);
}

class Distance : public ::testing::Test {
 protected:
  static Mesh made(const std::string& name) {
    return std::make_shared<const mesh::TriangleMesh>(std::move(mesh::made::make_shape(name)).value());
  }
  math::Pose random_pose(double least, double most) {
    return {random_.rotation().toRotationMatrix(), random_.uniform(least, most) * random_.direction()};
  }

  math::Random random_{17};
  Mesh a_ = testing::wavy_sphere(8, 0.3);
  Mesh b_ = testing::wavy_sphere(6, 0.2);
  Pair pair_ = std::move(Pair::make(Shape::build(a_).value(), Shape::build(b_).value())).value();
};

TEST_F(Distance, IsThatOfTheNearestTriangles) {
  for (int i = 0; i < 60; ++i) {
    const math::Pose pose = random_pose(0.5, i % 2 == 0 ? 2.5 : 20.0);
    const double expected = brute_force(*a_, *b_, pose);
    const DistanceAnswer answer = pair_.distance(pose);
    ASSERT_TRUE(answer.proved);
    ASSERT_NEAR(answer.upper, expected, 1e-12 * (1.0 + pose.translation.norm()));
    ASSERT_EQ(answer.lower, answer.upper);
    ASSERT_NEAR((answer.on_a - answer.on_b).norm(), answer.upper, 1e-12 * (1.0 + pose.translation.norm()));
    ASSERT_EQ(answer.upper == 0.0,
              pair_.run(pose, {.method = Method::exact, .max_contacts = 0}).verdict == Verdict::hit);
  }
}

TEST_F(Distance, TheNearestPointsLieOnTheirTriangles) {
  const math::Pose pose = random_pose(2.2, 3.0);
  const DistanceAnswer answer = pair_.distance(pose);
  ASSERT_LT(answer.triangle_a, a_->triangles().size());
  ASSERT_LT(answer.triangle_b, b_->triangles().size());
  const mesh::Triangle& ta = a_->triangles()[answer.triangle_a];
  const Vec3 a[3] = {a_->vertices()[ta[0]], a_->vertices()[ta[1]], a_->vertices()[ta[2]]};
  EXPECT_LT((primitive::closest_point_on_triangle(answer.on_a, a) - answer.on_a).norm(), 1e-12);
  const mesh::Triangle& tb = b_->triangles()[answer.triangle_b];
  const Vec3 b[3] = {pose * b_->vertices()[tb[0]], pose * b_->vertices()[tb[1]], pose * b_->vertices()[tb[2]]};
  EXPECT_LT((primitive::closest_point_on_triangle(answer.on_b, b) - answer.on_b).norm(), 1e-12);
}

TEST_F(Distance, WithinAMarginSaysSoOrThatNothingIs) {
  for (int i = 0; i < 40; ++i) {
    const math::Pose pose = random_pose(1.8, 2.6);
    const double distance = pair_.distance(pose).upper;
    const DistanceAnswer wide = pair_.distance(pose, {.within = distance + 1e-3});
    ASSERT_TRUE(wide.proved);
    ASSERT_EQ(wide.upper, distance);
    if (distance < 2e-3) continue;
    const DistanceAnswer narrow = pair_.distance(pose, {.within = distance - 1e-3});
    ASSERT_TRUE(narrow.proved);
    ASSERT_TRUE(std::isinf(narrow.upper));
    ASSERT_EQ(narrow.lower, distance - 1e-3);
    ASSERT_EQ(narrow.triangle_a, no_feature);
    ASSERT_LE(narrow.cost.node_pairs, wide.cost.node_pairs);
  }
}

TEST_F(Distance, WithinNothingIsWhatMeets) {
  int met = 0;
  for (int i = 0; i < 40; ++i) {
    const math::Pose pose = random_pose(1.0, 2.6);
    const DistanceAnswer distance = pair_.distance(pose);
    const DistanceAnswer touch = pair_.distance(pose, {.within = 0.0});
    ASSERT_TRUE(touch.proved);
    ASSERT_EQ(touch.lower, 0.0);
    ASSERT_EQ(touch.upper == 0.0, distance.upper == 0.0);
    ASSERT_EQ(std::isinf(touch.upper), distance.upper > 0.0);
    ASSERT_EQ(touch.triangle_a != no_feature, distance.upper == 0.0);
    met += distance.upper == 0.0 ? 1 : 0;
  }
  EXPECT_GT(met, 5);
  EXPECT_LT(met, 35);
}

TEST_F(Distance, WhatMeetsEndsTheSearch) {
  const math::Pose pose = random_pose(1.0, 1.1);
  const DistanceAnswer whole = pair_.distance(pose);
  ASSERT_TRUE(whole.proved);
  ASSERT_EQ(whole.upper, 0.0);
  for (std::uint64_t units = 8; units < 3000; units += 8) {
    const DistanceAnswer answer = pair_.distance(pose, {.budget = Budget::work(units)});
    ASSERT_EQ(answer.proved, answer.upper == 0.0) << units << ": no two points are nearer than those that meet";
  }
}

TEST_F(Distance, BoundsHoldUnderEveryWorkBudget) {
  const math::Pose pose = random_pose(2.2, 2.4);
  const double exact = pair_.distance(pose).upper;
  double last_upper = std::numeric_limits<double>::infinity();
  for (std::uint64_t units = 8; units < 3000; units += 40) {
    const DistanceAnswer answer = pair_.distance(pose, {.budget = Budget::work(units)});
    ASSERT_LE(answer.lower, exact);
    ASSERT_GE(answer.upper, exact);
    ASSERT_LE(answer.upper, last_upper) << "more work never loses what less had found";
    ASSERT_LE(answer.cost.node_pairs + answer.cost.triangle_pairs, units);
    last_upper = answer.upper;
  }
  EXPECT_EQ(last_upper, exact);
}

TEST_F(Distance, BadQuestionsAndFarBodiesGetBoundsThatAreTrue) {
  math::Pose bad;
  bad.translation.x() = std::numeric_limits<double>::quiet_NaN();
  for (const DistanceAnswer& answer : {pair_.distance(bad), pair_.distance({}, {.within = -1.0})}) {
    EXPECT_FALSE(answer.proved);
    EXPECT_EQ(answer.lower, 0.0);
    EXPECT_TRUE(std::isinf(answer.upper));
  }
  const DistanceAnswer far = pair_.distance({Mat3::Identity(), {1e6, 0, 0}});
  EXPECT_FALSE(far.proved);
  EXPECT_GT(far.lower, 1e6 - 4.0);
  EXPECT_LT(far.lower, 1e6);
  EXPECT_TRUE(pair_.distance({Mat3::Identity(), {1e6, 0, 0}}, {.within = 1.0}).proved);
  EXPECT_LE(pair_.distance({Mat3::Identity(), {1e160, 0, 0}}).lower, 1e160) << "whose square is infinite";
}

TEST_F(Distance, NestedShellsAreApartByTheirGap) {
  const auto outer = made("made:bumpy_sphere:height=0");
  const auto shape = Shape::build(outer);
  ASSERT_TRUE(shape.ok());
  std::vector<Vec3> vertices(outer->vertices().begin(), outer->vertices().end());
  for (Vec3& vertex : vertices) vertex *= 0.99;
  const auto inner = std::make_shared<const mesh::TriangleMesh>(
      std::move(mesh::TriangleMesh::make(std::move(vertices), {outer->triangles().begin(), outer->triangles().end()}))
          .value());
  auto pair = std::move(Pair::make(shape.value(), Shape::build(inner).value())).value();
  const DistanceAnswer answer = pair.distance({});
  ASSERT_TRUE(answer.proved);
  const double radius = outer->vertices()[0].norm();
  EXPECT_LE(answer.upper, 0.01 * radius * (1.0 + 1e-9));
  EXPECT_GE(answer.upper, 0.009 * radius);
}

}  // namespace
}  // namespace odds::query
