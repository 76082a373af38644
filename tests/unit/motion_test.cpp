// How far a motion carries a body at most.
#include "odds/math/motion.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "odds/math/random.hpp"

namespace odds::math {
namespace {

/// A rotation and a little more: its product with its own transpose is off by up to `off` in every entry.
Mat3 nearly(const Mat3& rotation, Random& random, double off) {
  Mat3 more = Mat3::Zero();
  if (random.uniform() < 0.5) {  // along one axis only
    const Vec3 along = random.direction();
    more = along * along.transpose();
  } else {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j <= i; ++j) more(i, j) = more(j, i) = random.uniform() - 0.5;
    }
  }
  const double sign = random.uniform() < 0.5 ? -1.0 : 1.0;
  return rotation * (Mat3::Identity() + sign * (0.49 * off / more.cwiseAbs().maxCoeff()) * more);
}

double spectral_norm(const Mat3& matrix) {
  return std::sqrt(std::max(Eigen::SelfAdjointEigenSolver<Mat3>(matrix.transpose() * matrix).eigenvalues()[2], 0.0));
}

TEST(Motion, BoundsPosesThatAreOnlyJustRigidToo) {
  Random random(7, 1);
  for (int i = 0; i < 20000; ++i) {
    const Mat3 rotation = random.rotation().toRotationMatrix();
    const double angle = std::pow(10.0, -9.0 + 9.0 * random.uniform()) * (i % 3 == 0 ? 0.0 : 1.0);
    const Mat3 turned = Eigen::AngleAxisd(angle, random.direction()).toRotationMatrix() * rotation;
    const double off = i % 2 == 0 ? tolerances::pose_orthonormality : 1e-15;
    const Pose from{nearly(rotation, random, off), Vec3::Zero()};
    const Pose to{nearly(turned, random, off), Vec3::Zero()};
    ASSERT_TRUE(from.is_rigid(tolerances::pose_orthonormality) && to.is_rigid(tolerances::pose_orthonormality));
    EXPECT_GE(turn_bound(from, to) * (1.0 + 1e-9) + 1e-15, spectral_norm(to.rotation - from.rotation)) << angle;
    EXPECT_LE(turn_bound(from, to), 1.42 * angle + 1e-5) << "it is of no use";
  }
}

// Corners of a small body and of a large one, along paths of many poses that are only just rigid.
TEST(Motion, BoundsHowMuchNearerBodiesComeWhicheverIsLarge) {
  Random random(7, 2);
  for (int i = 0; i < 2000; ++i) {
    const Reaches reaches{std::pow(10.0, random.uniform(-3.0, 3.0)), 1.0};
    const Vec3 on_a = reaches.a * random.direction();
    const Vec3 on_b = reaches.b * random.direction();
    const double off = i % 2 == 0 ? tolerances::pose_orthonormality : 1e-15;
    const double step = std::pow(10.0, random.uniform(-9.0, -2.0));
    Mat3 rotation = random.rotation().toRotationMatrix();
    Pose pose{nearly(rotation, random, off), random.direction() * (reaches.a + reaches.b)};
    const double before = (pose * on_b - on_a).norm();
    double travelled = 0.0;
    for (int k = 0; k < 5; ++k) {
      rotation = Eigen::AngleAxisd(step, random.direction()).toRotationMatrix() * rotation;
      const Pose next{nearly(rotation, random, off), pose.translation + step * random.direction() * random.uniform()};
      travelled += approach_bound(pose, next, reaches);
      pose = next;
      const double now = (pose * on_b - on_a).norm();
      EXPECT_GE(travelled, before * (1.0 - 4.0 * off) - now * (1.0 + 4.0 * off) - 1e-15 * before) << reaches.a;
    }
  }
}

TEST(Motion, OfASmallBodyIsItsOwnInWhoseeverFrameItIsSeen) {
  const Reaches small_first{1.0, 1000.0};
  Pose before;
  before.translation = Vec3(300.0, 400.0, 0.0);  // of the ground in the frame of a crate
  const Mat3 turn = Eigen::AngleAxisd(1e-3, Vec3::UnitY()).toRotationMatrix();
  const Pose after{turn, turn * before.translation};
  EXPECT_NEAR(approach_bound(before, after, small_first), 1e-3, 1e-5) << "the crate turns about its middle";
  EXPECT_GT(motion_bound(before, after, small_first.b), 1.0);
  EXPECT_NEAR(approach_bound(before.inverse(), after.inverse(), {1000.0, 1.0}), 1e-3, 1e-5);
  EXPECT_EQ(approach_bound(before, before, small_first), 0.0);
}

TEST(Motion, IsThatOfTheAngleWhereBodiesMoveFast) {
  for (const double angle : {1e-3, 1e-2, 0.1, 1.0, 3.0}) {
    const Pose turned{Eigen::AngleAxisd(angle, Vec3(1, 2, 3).normalized()).toRotationMatrix(), Vec3::Zero()};
    EXPECT_NEAR(turn_bound({}, turned), 2.0 * std::sin(0.5 * angle), 1e-5);
    EXPECT_NEAR(turn_between({}, turned), 2.0 * std::sin(0.5 * angle), 1e-12);
  }
  EXPECT_EQ(turn_bound({}, {}), 0.0);
}

}  // namespace
}  // namespace odds::math
