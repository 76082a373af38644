#include "odds/math/elementary.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace odds::math {
namespace {

TEST(CubeRoot, IsCloseOverTheWholeRange) {
  for (double x = 1e-37; x < 1e38; x *= 1.37) {
    const double expected = std::cbrt(static_cast<double>(static_cast<float>(x)));
    EXPECT_NEAR(static_cast<double>(cube_root(static_cast<float>(x))) / expected, 1.0, 2e-6) << x;
  }
  EXPECT_EQ(cube_root(0.0F), 0.0F);
  EXPECT_EQ(cube_root(-1.0F), 0.0F);
  EXPECT_EQ(cube_root(NAN), 0.0F);
}

TEST(RoughLog2, IsCloseOverTheWholeRange) {
  for (double x = 1e-300; x < 1e300; x *= 1.013)
    EXPECT_NEAR(static_cast<double>(rough_log2(x)), std::log2(x), 0.01) << x;
  EXPECT_LT(rough_log2(0.0), -1000.0F);
  EXPECT_LT(rough_log2(-1.0), -1000.0F);
  EXPECT_LT(rough_log2(NAN), -1000.0F);
}

TEST(RoughExp2, IsCloseOverTheWholeRangeAndBoundedBeyond) {
  for (float x = -126.0F; x < 127.0F; x += 0.0137F) {
    const double exact = std::exp2(static_cast<double>(x));
    EXPECT_NEAR(static_cast<double>(rough_exp2(x)), exact, 0.004 * exact) << x;
  }
  EXPECT_EQ(rough_exp2(0.0F), 1.0F);
  EXPECT_EQ(rough_exp2(-1e30F), rough_exp2(-126.0F));
  EXPECT_EQ(rough_exp2(NAN), rough_exp2(-126.0F));
  EXPECT_TRUE(std::isfinite(rough_exp2(1e30F)));
}

TEST(ProbabilityOfRate, IsCloseAndMonotone) {
  float last = 0.0F;
  for (double x = 1e-8; x < 40.0; x *= 1.01) {
    const float p = probability_of_rate(static_cast<float>(x));
    EXPECT_NEAR(static_cast<double>(p), -std::expm1(-x), 4e-7) << x;
    EXPECT_GE(p, last - 4e-7F) << x;
    EXPECT_LE(p, 1.0F);
    last = p;
  }
  EXPECT_EQ(probability_of_rate(0.0F), 0.0F);
  EXPECT_EQ(probability_of_rate(NAN), 0.0F);
  EXPECT_EQ(probability_of_rate(INFINITY), 1.0F);
}

}  // namespace
}  // namespace odds::math
