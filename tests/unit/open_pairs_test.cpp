// How the wide engine's searches note their open pairs, and the lanes that they write them from.
#include "query/wide/open_pairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "odds/math/random.hpp"

namespace odds::query::wide {
namespace {

TEST(OpenPairs, AddressesAreThoseOfTheNumbers) {
  std::vector<WideNode> nodes(7);
  for (Slot slot = 0; slot < nodes.size() * wide_lanes; ++slot) {
    nodes[slot / wide_lanes].center[0][slot % wide_lanes] = static_cast<float>(slot);
    nodes[slot / wide_lanes].half[2][slot % wide_lanes] = static_cast<float>(slot) + 0.5F;
    EXPECT_EQ(slot_at(address_of(slot)), slot);
    const LaneNumbers numbers(&nodes[0].center[0][0] + address_of(slot));
    EXPECT_EQ(numbers.center(0), static_cast<float>(slot));
    EXPECT_EQ(numbers.half(2), static_cast<float>(slot) + 0.5F);
  }
}

TEST(OpenPairs, KnowWhoseSlotIsOpened) {
  LaneAddress opened[2] = {address_of(21), address_of(40) + OpenPairs::of_b};
  LaneAddress other[2] = {address_of(33), address_of(5)};
  OpenPairs pairs{opened, other, 2};
  EXPECT_EQ(pairs.pair(0).of[0], 21U);
  EXPECT_EQ(pairs.pair(0).of[1], 33U);
  EXPECT_EQ(pairs.pair(1).of[0], 5U);
  EXPECT_EQ(pairs.pair(1).of[1], 40U);
  pairs.bring_up(0);
  EXPECT_EQ(pairs.pair(1).of[0], 21U);
  EXPECT_EQ(pairs.pair(0).of[1], 40U);
}

template <class L>
class Lanes : public ::testing::Test {};
using BuiltHere = ::testing::Types<
#if defined(__SSE2__)
    lanes::Sse2,
#endif
    lanes::Portable>;
TYPED_TEST_SUITE(Lanes, BuiltHere);

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

}  // namespace
}  // namespace odds::query::wide
