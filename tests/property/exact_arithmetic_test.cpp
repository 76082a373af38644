// Expansions are exact: checked against integers that 128-bit arithmetic holds without rounding.
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "odds/math/exact.hpp"

namespace {

using odds::math::Expansion;
using odds::math::two_difference;
using odds::math::two_product;
using odds::math::two_sum;
__extension__ using Int128 = __int128;

int sign(Int128 value) { return value > 0 ? 1 : (value < 0 ? -1 : 0); }

template <std::size_t N>
Int128 value_of(const Expansion<N>& expansion) {
  Int128 sum = 0;
  for (std::size_t i = 0; i < expansion.size(); ++i) sum += static_cast<Int128>(expansion[i]);
  return sum;
}

template <std::size_t N>
bool ordered_without_overlap(const Expansion<N>& expansion) {
  for (std::size_t i = 0; i < expansion.size(); ++i) {
    if (expansion[i] == 0.0) return false;
    if (i > 0 && std::fabs(expansion[i - 1]) >= std::fabs(expansion[i])) return false;
  }
  return true;
}

std::int64_t integer_of_bits(int bits) {
  const std::int64_t limit = std::int64_t{1} << bits;
  return *rc::gen::resize(1000, rc::gen::inRange<std::int64_t>(-limit, limit + 1));
}

TEST(ExactArithmetic, TransformsLoseNothing) {
  EXPECT_TRUE(rc::check("two_sum, two_difference, two_product", [] {
    const std::int64_t a = integer_of_bits(53);
    const std::int64_t b = integer_of_bits(*rc::gen::inRange(1, 54));
    const auto x = static_cast<double>(a);
    const auto y = static_cast<double>(b);
    const auto exact = [](auto t) { return static_cast<Int128>(t.high) + static_cast<Int128>(t.low); };
    RC_ASSERT(exact(two_sum(x, y)) == Int128{a} + b);
    RC_ASSERT(exact(two_difference(x, y)) == Int128{a} - b);
    RC_ASSERT(exact(two_product(x, y)) == Int128{a} * b);
  }));
}

TEST(ExactArithmetic, ExpansionsOfProductsAndSumsAreExact) {
  EXPECT_TRUE(rc::check("(a - b)(c - d) - (e - f)(g - h), then times (i - j)", [] {
    std::int64_t v[10];
    for (auto& x : v) x = integer_of_bits(*rc::gen::inRange(2, 37));
    const auto difference = [&](int i, int j) {
      return Expansion<2>(two_difference(static_cast<double>(v[i]) * 0x1p2, static_cast<double>(v[j]) * 0x1p-2));
    };
    const auto minor = difference(0, 1) * difference(2, 3) - difference(4, 5) * difference(6, 7);
    const auto exact_difference = [&](int i, int j) { return Int128{v[i]} * 16 - v[j]; };  // in units of 1/4
    const Int128 expected =
        exact_difference(0, 1) * exact_difference(2, 3) - exact_difference(4, 5) * exact_difference(6, 7);
    RC_ASSERT(ordered_without_overlap(minor));
    RC_ASSERT(value_of(minor * 16.0) == expected);
    RC_ASSERT(minor.sign() == sign(expected));
    const auto product = minor * difference(8, 9);
    RC_ASSERT(ordered_without_overlap(product));
    RC_ASSERT(product.sign() == sign(expected) * sign(exact_difference(8, 9)));
  }));
}

TEST(ExactArithmetic, KeepsWhatRoundingWouldDrop) {
  // (1 + u)^2 - (1 + 2u) = u^2 with u = 2^-52: a plain double gives 0.
  const double u = 0x1p-52;
  const Expansion<2> x(two_sum(1.0, u));
  const auto rest = x * x - Expansion<2>(two_sum(1.0, 2.0 * u));
  EXPECT_EQ(rest.sign(), 1);
  EXPECT_EQ(rest.approximate(), u * u);
  EXPECT_EQ((rest - rest).size(), 0u);
}

}  // namespace
