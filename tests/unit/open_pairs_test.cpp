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

}  // namespace
}  // namespace odds::query::wide
