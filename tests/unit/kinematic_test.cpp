// The kinematic estimator: limits, symmetry, and the formula itself.
#include "odds/probability/kinematic.hpp"

#include "odds/tree/hierarchy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace odds::probability {
namespace {

// As a hierarchy's build does it.
tree::NodeStatistics plate(const Vec3f& normal, float area, double volume) {
  tree::NodeStatistics node;
  node.area = area;
  tree::relate_area(node, volume);
  const float packed[6] = {normal[0] * normal[0], normal[1] * normal[1], normal[2] * normal[2],
                           normal[0] * normal[1], normal[0] * normal[2], normal[1] * normal[2]};
  std::copy(packed, packed + 6, node.normal_moment);
  return node;
}

TEST(MeanSquareSine, IsTheSquaredSineOfTwoPlanes) {
  std::mt19937 generator(5);
  std::normal_distribution<float> normal;
  for (int i = 0; i < 500; ++i) {
    const Vec3f na = Vec3f(normal(generator), normal(generator), normal(generator)).normalized();
    const Vec3f nb = Vec3f(normal(generator), normal(generator), normal(generator)).normalized();
    const Mat3f rotation =
        Eigen::Quaternionf(normal(generator), normal(generator), normal(generator), normal(generator))
            .normalized()
            .toRotationMatrix();
    const float expected = na.cross(rotation * nb).squaredNorm();
    EXPECT_NEAR(mean_square_sine(plate(na, 1, 1), plate(nb, 1, 1), rotation), expected, 2e-6F);
  }
}

TEST(MeanSquareSine, IsTwoThirdsForIsotropicNormals) {
  EXPECT_NEAR(mean_square_sine({}, {}, Mat3f::Identity()), 2.0F / 3.0F, 1e-6F);
}

TEST(Kinematic, IsTheFormula) {
  const double volume_a = 2.0;
  const double volume_b = 0.5;
  const double common = 0.125;
  const auto a = plate(Vec3f::UnitX(), 3.0F, volume_a);
  const auto b = plate(Vec3f::UnitY(), 0.7F, volume_b);
  const double lambda = 3.0 / volume_a * 0.7 / volume_b * std::sqrt(1.0 + 1e-4) * std::pow(common, 2.0 / 3.0);
  EXPECT_NEAR(static_cast<double>(kinematic(a, b, Mat3f::Identity(), volume_a, volume_b, common)),
              1.0 - std::exp(-lambda), 1e-5);
}

TEST(Kinematic, GrowsWithTheCommonVolumeAndKeepsItsLimits) {
  const auto a = plate(Vec3f::UnitX(), 4.0F, 1.0);
  const auto b = plate(Vec3f::UnitY(), 4.0F, 1.0);
  EXPECT_EQ(kinematic(a, b, Mat3f::Identity(), 1.0, 1.0, 0.0), 0.0F);
  EXPECT_EQ(kinematic(a, b, Mat3f::Identity(), 1.0, 1.0, NAN), 0.0F);
  float last = 0.0F;
  for (double common = 1e-9; common <= 1.0; common *= 2.0) {
    const float p = kinematic(a, b, Mat3f::Identity(), 1.0, 1.0, common);
    EXPECT_GE(p, last);
    EXPECT_LE(p, 1.0F);
    last = p;
  }
  EXPECT_GT(last, 0.99F);
}

TEST(Kinematic, ItsLogarithmicRateIsTheSameFormula) {
  std::mt19937 generator(9);
  std::uniform_real_distribution<double> uniform;
  for (int i = 0; i < 2000; ++i) {
    const double volume_a = std::pow(10.0, 8.0 * uniform(generator) - 6.0);
    const double volume_b = std::pow(10.0, 8.0 * uniform(generator) - 6.0);
    const double common = std::min(volume_a, volume_b) * uniform(generator);
    const auto a =
        plate(Vec3f::UnitX(), static_cast<float>(std::pow(volume_a, 2.0 / 3.0) * uniform(generator)), volume_a);
    const auto b = plate(Vec3f(0.6F, 0.8F, 0.0F), static_cast<float>(std::pow(volume_b, 2.0 / 3.0)), volume_b);
    const double p = static_cast<double>(kinematic(a, b, Mat3f::Identity(), volume_a, volume_b, common));
    const double rate = std::exp2(static_cast<double>(log_kinematic_rate(a, b, Mat3f::Identity(), common)));
    EXPECT_NEAR(-std::expm1(-rate), p, 0.02) << i;
  }
}

TEST(Kinematic, ParallelSheetsAreUnlikely) {
  const auto a = plate(Vec3f::UnitX(), 1.0F, 1.0);
  const float parallel = kinematic(a, a, Mat3f::Identity(), 1.0, 1.0, 1.0);
  const float crossing = kinematic(a, plate(Vec3f::UnitY(), 1.0F, 1.0), Mat3f::Identity(), 1.0, 1.0, 1.0);
  EXPECT_LT(parallel, 0.02F);
  EXPECT_GT(crossing, 0.5F);
}

TEST(Kinematic, DoesNotDependOnTheUnitOfLength) {
  for (const double unit : {1e-9, 1.0, 1e6}) {
    const double volume = unit * unit * unit;
    const auto a = plate(Vec3f::UnitX(), static_cast<float>(2.0 * unit * unit), volume);
    const auto b = plate(Vec3f::UnitZ(), static_cast<float>(3.0 * unit * unit), volume);
    EXPECT_NEAR(kinematic(a, b, Mat3f::Identity(), volume, volume, 0.3 * volume), 0.93218F, 1e-3F) << unit;
  }
}

}  // namespace
}  // namespace odds::probability
