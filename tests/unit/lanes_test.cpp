// What the lanes of each instruction set do, beside plain numbers.
#include "query/wide/lanes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>

#include "odds/math/random.hpp"
#include "odds/tree/wide_tree.hpp"
#include "query/wide/doubles.hpp"
#include "support/lanes_built_here.hpp"

namespace odds::query::wide {
namespace {

using tree::wide_lanes;

template <class L>
class Lanes : public ::testing::Test {};
TYPED_TEST_SUITE(Lanes, testing::LanesBuiltHere);

TYPED_TEST(Lanes, AreWrittenInOrderCountedOrNot) {
  math::Random random(3);
  for (int i = 0; i < 2000; ++i) {
    const auto mask = static_cast<unsigned>(random.below(256));
    const auto counted = static_cast<unsigned>(random.below(256));
    std::uint32_t written[wide_lanes] = {};
    TypeParam::write_either(written, 1000, 7, mask, counted);
    std::size_t at = 0;
    for (unsigned lane = 0; lane < wide_lanes; ++lane) {
      if ((mask >> lane & 1U) == 0) continue;
      ASSERT_EQ(written[at++], (counted >> lane & 1U) != 0 ? 1000 + lane : 7U);
    }
  }
}

TYPED_TEST(Lanes, AreChosenAndTheLeastFound) {
  math::Random random(4);
  alignas(64) float numbers[2][wide_lanes + 1];
  for (int i = 0; i < 2000; ++i) {
    for (auto& eight : numbers) {
      for (float& number : eight) number = static_cast<float>(random.below(20)) - 10.0F;
    }
    const auto mask = static_cast<unsigned>(random.below(256));
    const auto chosen = TypeParam::choose(mask, TypeParam::load(numbers[0]), TypeParam::load_from(numbers[1] + 1));
    alignas(64) float kept[wide_lanes];
    TypeParam::store(kept, chosen);
    float written[wide_lanes];
    TypeParam::write_some(written, chosen, mask);
    std::size_t at = 0;
    for (unsigned lane = 0; lane < wide_lanes; ++lane) {
      const bool is_first = (mask >> lane & 1U) != 0;
      ASSERT_EQ(kept[lane], is_first ? numbers[0][lane] : numbers[1][lane + 1]);
      if (!is_first) continue;
      ASSERT_EQ(written[at++], kept[lane]);
    }
    const float least = *std::min_element(std::begin(kept), std::end(kept));
    ASSERT_EQ(TypeParam::least_value(chosen), least);
    ASSERT_EQ(kept[TypeParam::least(chosen)], least);
  }
}

TYPED_TEST(Lanes, AreChosenByABoundThatCountsAsWithin) {
  math::Random random(5);
  constexpr float infinity = std::numeric_limits<float>::infinity();
  alignas(64) float x[wide_lanes];
  alignas(64) float bound[wide_lanes];
  alignas(64) float kept[wide_lanes];
  for (int i = 0; i < 2000; ++i) {
    for (unsigned lane = 0; lane < wide_lanes; ++lane) {
      x[lane] = static_cast<float>(random.below(6)) - 3.0F;
      bound[lane] = random.below(4) == 0 ? -infinity : static_cast<float>(random.below(6)) - 3.0F;
    }
    TypeParam::store(kept, TypeParam::choose_at_most(TypeParam::load(x), TypeParam::load(bound), TypeParam::all(1.0F),
                                                     TypeParam::all(infinity)));
    for (unsigned lane = 0; lane < wide_lanes; ++lane) ASSERT_EQ(kept[lane], x[lane] <= bound[lane] ? 1.0F : infinity);
  }
}

/// Of any size, of either sign, zero, and now and then none.
template <class T>
T any_number(math::Random& random) {
  constexpr T special[] = {T(0),
                           -T(0),
                           std::numeric_limits<T>::infinity(),
                           std::numeric_limits<T>::denorm_min(),
                           std::numeric_limits<T>::min(),
                           std::numeric_limits<T>::max(),
                           std::numeric_limits<T>::quiet_NaN()};
  if (random.below(8) == 0) return special[random.below(std::size(special))];
  const auto size = static_cast<T>(std::exp(random.uniform(-20.0, 20.0)));
  return random.below(2) == 0 ? size : -size;
}

/// Equal, or neither a number.
template <class T>
bool same(T x, T y) {
  return x == y || (std::isnan(x) && std::isnan(y));
}

/// Eight numbers and eight others, and whether what became of them is what one number by itself becomes.
template <class T>
struct TwoEights {
  alignas(64) T a[8];
  alignas(64) T b[8];

  void draw(math::Random& random) {
    for (T& number : a) number = any_number<T>(random);
    for (T& number : b) number = any_number<T>(random);
  }
  template <class One>
  [[nodiscard]] bool make(const T (&made)[8], const One& one) const {
    for (unsigned i = 0; i < 8; ++i) {
      if (!same(made[i], one(a[i], b[i]))) return false;
    }
    return true;
  }
  template <class One>
  [[nodiscard]] unsigned mask(const One& one) const {
    unsigned mask = 0;
    for (unsigned i = 0; i < 8; ++i) mask |= (one(a[i], b[i]) ? 1U : 0U) << i;
    return mask;
  }
};

TYPED_TEST(Lanes, CalculateAsOneNumberDoes) {
  math::Random random(5);
  TwoEights<float> eights;
  const auto& [a, b] = eights;
  const auto is_as = [&](const auto& lanes, const auto& one) {
    alignas(64) float made[8];
    TypeParam::store(made, lanes);
    return eights.make(made, one);
  };
  for (int i = 0; i < 5000; ++i) {
    eights.draw(random);
    const auto x = TypeParam::load(a);
    const auto y = TypeParam::load(b);
    ASSERT_TRUE(is_as(x + y, [](float p, float q) { return p + q; })) << i;
    ASSERT_TRUE(is_as(x - y, [](float p, float q) { return p - q; })) << i;
    ASSERT_TRUE(is_as(x * y, [](float p, float q) { return p * q; })) << i;
    ASSERT_TRUE(is_as(TypeParam::divide(x, y), [](float p, float q) { return p / q; })) << i;
    ASSERT_TRUE(is_as(TypeParam::abs(x), [](float p, float) { return std::fabs(p); })) << i;
    ASSERT_TRUE(is_as(TypeParam::root(TypeParam::abs(x)), [](float p, float) { return std::sqrt(std::fabs(p)); })) << i;
    // Of what is not a number the second one, as SSE has it.
    ASSERT_TRUE(is_as(TypeParam::min(x, y), [](float p, float q) { return p < q ? p : q; })) << i;
    ASSERT_TRUE(is_as(TypeParam::max(x, y), [](float p, float q) { return p > q ? p : q; })) << i;
    ASSERT_EQ(TypeParam::less_equal(x, y), eights.mask([](float p, float q) { return p <= q; })) << i;
    ASSERT_EQ(TypeParam::highest_bits(a), eights.mask([](float p, float) { return std::signbit(p); })) << i;
  }
}

TYPED_TEST(Lanes, SplitExponentsOff) {
  math::Random random(6);
  for (int i = 0; i < 2000; ++i) {
    alignas(64) float numbers[wide_lanes];
    for (float& number : numbers) number = static_cast<float>(std::exp(random.uniform(-80.0, 80.0)));
    typename TypeParam::Float exponent;
    typename TypeParam::Float fraction;
    TypeParam::split(TypeParam::load(numbers), exponent, fraction);
    alignas(64) float exponents[wide_lanes];
    alignas(64) float fractions[wide_lanes];
    TypeParam::store(exponents, exponent);
    TypeParam::store(fractions, fraction);
    for (unsigned lane = 0; lane < wide_lanes; ++lane) {
      ASSERT_EQ(std::ldexp(1.0F + fractions[lane], static_cast<int>(exponents[lane])), numbers[lane]);
      ASSERT_GE(fractions[lane], 0.0F);
      ASSERT_LT(fractions[lane], 1.0F);
    }
  }
}

TYPED_TEST(Lanes, OfDoublesCalculateAsOneNumberDoes) {
  using Eight = lanes::Doubles<typename lanes::DoublesOf<TypeParam>::Register>;
  math::Random random(7);
  TwoEights<double> eights;
  const auto& [a, b] = eights;
  const auto is_as = [&](const Eight& eight, const auto& one) {
    alignas(64) double made[8];
    eight.store(made);
    return eights.make(made, one);
  };
  for (int i = 0; i < 5000; ++i) {
    eights.draw(random);
    const Eight x = Eight::load(a);
    const Eight y = Eight::load(b);
    ASSERT_TRUE(is_as(x + y, [](double p, double q) { return p + q; })) << i;
    ASSERT_TRUE(is_as(x - y, [](double p, double q) { return p - q; })) << i;
    ASSERT_TRUE(is_as(x * y, [](double p, double q) { return p * q; })) << i;
    ASSERT_TRUE(is_as(x / y, [](double p, double q) { return p / q; })) << i;
    ASSERT_TRUE(is_as(abs(x), [](double p, double) { return std::fabs(p); })) << i;
    ASSERT_TRUE(is_as(root(abs(x)), [](double p, double) { return std::sqrt(std::fabs(p)); })) << i;
    ASSERT_TRUE(is_as(min(x, y), [](double p, double q) { return p < q ? p : q; })) << i;
    ASSERT_TRUE(is_as(max(x, y), [](double p, double q) { return p > q ? p : q; })) << i;
    ASSERT_TRUE(is_as(choose(x < y, x, y), [](double p, double q) { return p < q ? p : q; })) << i;
    const double* const rows[8] = {a + 7, a + 6, a + 5, a + 4, a + 3, a + 2, a + 1, a};
    alignas(64) double turned[8];
    Eight::from(rows, 0).store(turned);
    ASSERT_TRUE(std::equal(std::rbegin(turned), std::rend(turned), a, same<double>)) << i;
    ASSERT_EQ((x < y).bits(), eights.mask([](double p, double q) { return p < q; })) << i;
    ASSERT_EQ(((x < y) | (y <= x)).bits(), eights.mask([](double p, double q) { return p < q || q <= p; })) << i;
    ASSERT_EQ(((x < y) & (y <= x)).bits(), 0U) << i;
  }
}

}  // namespace
}  // namespace odds::query::wide
