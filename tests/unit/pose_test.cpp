// What counts as a pose of a rigid body.
#include "odds/math/pose.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace odds::math {
namespace {

constexpr double orthonormality = 1e-6;

TEST(Pose, IsRigidHoweverFarAway) {
  Pose pose;
  EXPECT_TRUE(pose.is_rigid(orthonormality));
  pose.translation = Vec3::Constant(1e308);  // whose sum is not finite
  EXPECT_TRUE(pose.is_rigid(orthonormality));
}

TEST(Pose, IsNotRigidIfAnyNumberIsNotFinite) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity()}) {
    for (int i = 0; i < 9; ++i) {
      Pose pose;
      pose.rotation(i / 3, i % 3) = bad;
      EXPECT_FALSE(pose.is_rigid(orthonormality)) << i;
    }
    for (int i = 0; i < 3; ++i) {
      Pose pose;
      pose.translation[i] = bad;
      EXPECT_FALSE(pose.is_rigid(orthonormality)) << i;
    }
  }
}

TEST(Pose, IsNotRigidIfItMirrorsStretchesOrShears) {
  Pose pose;
  pose.rotation(2, 2) = -1.0;
  EXPECT_FALSE(pose.is_rigid(orthonormality));
  pose.rotation(2, 2) = 1.0 + orthonormality;
  EXPECT_FALSE(pose.is_rigid(orthonormality));
  pose.rotation(2, 2) = 1.0;
  pose.rotation(0, 1) = 2.0 * orthonormality;
  EXPECT_FALSE(pose.is_rigid(orthonormality));
  pose.rotation(0, 1) = 0.5 * orthonormality;
  EXPECT_TRUE(pose.is_rigid(orthonormality));
}

}  // namespace
}  // namespace odds::math
