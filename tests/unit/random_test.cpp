#include "odds/math/random.hpp"

#include <gtest/gtest.h>

#include <set>

namespace odds::math {
namespace {

TEST(Random, GivesTheNumbersThatRecordingsAndPosesRelyOn) {
  Random random(7, 3);
  EXPECT_EQ(random.bits(), Random(7, 3).bits_at(0));
  EXPECT_EQ(random.bits(), Random(7, 3).bits_at(1));
  static_assert(scramble(0) == 0);
  static_assert(scramble(0x9e3779b97f4a7c15ULL) == 0xe220a8397b1dcdafULL);  // first output of SplitMix64 for seed 0
}

TEST(Random, SeedsAndStreamsDiffer) {
  std::set<std::uint64_t> seen;
  for (std::uint64_t seed = 0; seed < 32; ++seed) {
    for (std::uint64_t stream = 0; stream < 32; ++stream) seen.insert(Random(seed, stream).bits_at(0));
  }
  EXPECT_EQ(seen.size(), 1024u);
}

TEST(Random, UniformHasTheMomentsOfAUniform) {
  Random random(1);
  double sum = 0.0;
  double squares = 0.0;
  constexpr int count = 100000;
  for (int i = 0; i < count; ++i) {
    const double u = random.uniform();
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
    squares += u * u;
  }
  EXPECT_NEAR(sum / count, 0.5, 0.005);
  EXPECT_NEAR(squares / count, 1.0 / 3.0, 0.005);
}

TEST(Random, DirectionsAndRotationsAreUnitAndCentred) {
  Random random(2);
  Vec3 mean = Vec3::Zero();
  Mat3 moment = Mat3::Zero();
  constexpr int count = 50000;
  for (int i = 0; i < count; ++i) {
    const Vec3 direction = random.direction();
    ASSERT_NEAR(direction.norm(), 1.0, 1e-12);
    const Quat rotation = random.rotation();
    ASSERT_NEAR(rotation.norm(), 1.0, 1e-12);
    const Vec3 turned = rotation * Vec3(0.6, 0.0, 0.8);
    mean += turned / count;
    moment += turned * turned.transpose() / count;
  }
  EXPECT_LT(mean.norm(), 0.02);
  EXPECT_LT((moment - Mat3::Identity() / 3.0).norm(), 0.02);
}

TEST(Random, BelowStaysBelow) {
  Random random(3);
  int counts[3] = {0, 0, 0};
  for (int i = 0; i < 3000; ++i) ++counts[random.below(3)];
  for (const int count : counts) EXPECT_NEAR(count, 1000, 150);
}

}  // namespace
}  // namespace odds::math
