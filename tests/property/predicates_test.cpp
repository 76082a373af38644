// Signs of orientations: against 128-bit integers, at all scales, and under exchange of arguments.
#include "odds/primitive/predicates.hpp"

#include <array>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>
#include <rapidcheck.h>

namespace {

using odds::Vec3;
using odds::math::collinear;
using odds::primitive::orient2d;
using odds::primitive::orient3d;
__extension__ using Int128 = __int128;
using IntegerPoint = std::array<std::int64_t, 3>;

int sign(Int128 value) { return value > 0 ? 1 : (value < 0 ? -1 : 0); }

// Up to 2^bits; small ones often, so that exact zeros occur.
IntegerPoint draw_point(int bits) {
  const std::int64_t limit = std::int64_t{1} << bits;
  IntegerPoint p;
  for (auto& x : p) x = *rc::gen::resize(1000, rc::gen::inRange<std::int64_t>(-limit, limit + 1));
  return p;
}

Vec3 scaled(const IntegerPoint& p, double scale) {
  return scale * Vec3(static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2]));
}

int exact_orient3d(const std::array<IntegerPoint, 4>& p) {
  Int128 d[3][3];
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) d[i][k] = Int128{p[i + 1][k]} - p[0][k];
  }
  return sign(d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) - d[0][1] * (d[1][0] * d[2][2] - d[1][2] * d[2][0]) +
              d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0]));
}

// Four points in one plane up to a unit: the last is a whole combination of the others, then nudged.
std::array<IntegerPoint, 4> nearly_coplanar(int bits) {
  std::array<IntegerPoint, 4> p = {draw_point(bits), draw_point(bits), draw_point(bits), {}};
  const auto m = *rc::gen::inRange<std::int64_t>(-4, 5);
  const auto n = *rc::gen::inRange<std::int64_t>(-4, 5);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto nudge = *rc::gen::element<std::int64_t>(0, 0, 0, 0, -1, 1);
    p[3][k] = p[0][k] + m * (p[1][k] - p[0][k]) + n * (p[2][k] - p[0][k]) + nudge;
  }
  return p;
}

constexpr double scales[] = {1.0, 0x1p-30, 0x1p300, 0x1p-300, 0x1p-360, 0x1p900, 0x1p-1074};

TEST(Predicates, Orient3dEqualsIntegerArithmeticAtEveryScale) {
  EXPECT_TRUE(rc::check("orient3d", [] {
    const auto p = nearly_coplanar(*rc::gen::element(2, 10, 30, 36));
    const int expected = exact_orient3d(p);
    for (const double s : scales) {
      RC_ASSERT(orient3d(scaled(p[0], s), scaled(p[1], s), scaled(p[2], s), scaled(p[3], s)) == expected);
    }
  }));
}

TEST(Predicates, Orient3dAcrossAllMagnitudesAtOnce) {
  EXPECT_TRUE(rc::check("one axis at another scale keeps the sign", [] {
    const auto p = nearly_coplanar(20);
    const int expected = exact_orient3d(p);
    Vec3 stretch;
    for (int k = 0; k < 3; ++k) stretch[k] = *rc::gen::element(1.0, 0x1p-1074, 0x1p-500, 0x1p-50, 0x1p200, 0x1p980);
    std::array<Vec3, 4> q;
    for (std::size_t i = 0; i < 4; ++i) q[i] = scaled(p[i], 1.0).cwiseProduct(stretch);
    RC_ASSERT(orient3d(q[0], q[1], q[2], q[3]) == expected);
  }));
}

TEST(Predicates, Orient3dFlipsWithEveryExchange) {
  EXPECT_TRUE(rc::check("antisymmetry", [] {
    const auto p = nearly_coplanar(30);
    const double s = *rc::gen::element(0.1, 1e-9, 1e15, 1e-200);
    std::array<Vec3, 4> q;
    for (std::size_t i = 0; i < 4; ++i) q[i] = scaled(p[i], s);
    const int here = orient3d(q[0], q[1], q[2], q[3]);
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i + 1; j < 4; ++j) {
        auto r = q;
        std::swap(r[i], r[j]);
        RC_ASSERT(orient3d(r[0], r[1], r[2], r[3]) == -here);
      }
    }
  }));
}

TEST(Predicates, Orient2dEqualsIntegerArithmeticAtEveryScale) {
  EXPECT_TRUE(rc::check("orient2d and collinear", [] {
    const int bits = *rc::gen::element(2, 10, 30, 49);
    std::array<IntegerPoint, 3> p = {draw_point(bits), draw_point(bits), {}};
    const auto m = *rc::gen::inRange<std::int64_t>(-4, 5);
    for (std::size_t k = 0; k < 3; ++k) {
      p[2][k] = p[0][k] + m * (p[1][k] - p[0][k]) + *rc::gen::element<std::int64_t>(0, 0, 0, -1, 1);
    }
    int expected[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3;
      const auto d = [&](std::size_t i, std::size_t axis) { return Int128{p[i][axis]} - p[0][axis]; };
      expected[k] = sign(d(1, k) * d(2, l) - d(1, l) * d(2, k));
    }
    for (const double s : scales) {
      const Vec3 a = scaled(p[0], s);
      const Vec3 b = scaled(p[1], s);
      const Vec3 c = scaled(p[2], s);
      for (int k = 0; k < 3; ++k) {
        const int l = (k + 1) % 3;
        RC_ASSERT(orient2d(a[k], a[l], b[k], b[l], c[k], c[l]) == expected[k]);
      }
      RC_ASSERT(collinear(a, b, c) == (expected[0] == 0 && expected[1] == 0 && expected[2] == 0));
    }
  }));
}

TEST(Predicates, TheLastBitDecides) {
  const double next = std::nextafter(0.3, 1.0);
  EXPECT_EQ(orient2d(0, 0, 0.3, 0.3, 0.6, 0.6), 0);
  EXPECT_EQ(orient2d(0, 0, 0.3, next, 0.6, 0.6), -1);
  EXPECT_EQ(orient2d(0, 0, next, 0.3, 0.6, 0.6), 1);
  const Vec3 o(0.1, 0.1, 0.1);
  EXPECT_EQ(orient3d(o, Vec3(0.7, 0.1, 0.7), Vec3(0.1, 0.7, 0.7), Vec3(0.7, 0.7, 0.7)), -1);
  const Vec3 huge(1e15, 1e15, 1e15);
  EXPECT_EQ(orient3d(huge, huge + Vec3(1, 0, 1), huge + Vec3(0, 1, 1), huge + Vec3(1, 1, 2)), 0);
  EXPECT_EQ(orient3d(huge, huge + Vec3(1, 0, 1), huge + Vec3(0, 1, 1), huge + Vec3(1, 1, 2.125)), 1);
}

}  // namespace
