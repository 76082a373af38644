// The many sides of a body, eight at a time, by each instruction set against one at a time.
#include "query/wide/many_sides.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "odds/math/random.hpp"
#include "query/wide/searches.hpp"
#include "support/each_kernel.hpp"

namespace odds::query {
namespace {

using wide::EightSides;

/// Planes about a ball of radius 1, of a number that is no multiple of eight.
class ManySides : public ::testing::Test {
 protected:
  static constexpr std::size_t count = 101;

  ManySides() : eights((count + EightSides::count - 1) / EightSides::count) {
    for (std::size_t i = 0; i < count; ++i) {
      normals[i] = random.direction();
      offsets[i] = random.uniform(0.9, 1.1);
      eights[i / EightSides::count].set(i % EightSides::count, normals[i], offsets[i]);
    }
  }
  [[nodiscard]] double height(std::size_t i, const Vec3& point) const {
    const Vec3& n = normals[i];
    return n.x() * point.x() + n.y() * point.y() + n.z() * point.z() - offsets[i];
  }
  template <class Check>
  static void for_each_set(const Check& check) {
    testing::for_each_instruction_set(&wide::Searches::way_out, check);
  }

  math::Random random{6, 1};
  std::vector<EightSides> eights;
  std::array<Vec3, count> normals;
  std::array<double, count> offsets{};
};

TEST_F(ManySides, AreNearABallThatIsNotWhollyWithinThem) {
  int beyond = 0;
  int within = 0;
  for (int round = 0; round < 500; ++round) {
    const Vec3 center = random.uniform(0.0, 1.5) * random.direction();
    const double radius = random.uniform(0.0, 0.4);
    bool is_beyond = false;
    std::vector<std::uint8_t> expected(eights.size());
    for (std::size_t i = 0; i < count; ++i) {
      is_beyond = is_beyond || height(i, center) > radius;
      if (height(i, center) > -radius) expected[i / 8] |= static_cast<std::uint8_t>(1U << (i % 8));
    }
    beyond += is_beyond ? 1 : 0;
    within += std::all_of(expected.begin(), expected.end(), [](auto lanes) { return lanes == 0; }) ? 1 : 0;
    for_each_set([&](const wide::Searches& searches) {
      std::vector<std::uint8_t> near(eights.size());
      ASSERT_EQ(searches.sides_near(eights, center, radius, near.data()), !is_beyond) << searches.instruction_set;
      if (!is_beyond) {
        EXPECT_EQ(near, expected) << searches.instruction_set;
      }
    });
  }
  EXPECT_GT(beyond, 50);
  EXPECT_GT(within, 50);
}

TEST_F(ManySides, AreLeftByTheNearest) {
  for (int round = 0; round < 500; ++round) {
    const Vec3 point = random.uniform(0.0, 1.2) * random.direction();
    const Vec3 direction = random.direction();
    double expected = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3& n = normals[i];
      const double speed = direction.x() * n.x() + direction.y() * n.y() + direction.z() * n.z();
      if (speed >= 1e-12) expected = std::min(expected, std::max(-height(i, point), 0.0) / speed);
    }
    for_each_set([&](const wide::Searches& searches) {
      EXPECT_EQ(searches.way_out(eights, point, direction), expected) << searches.instruction_set;
    });
  }
}

TEST_F(ManySides, OfNoneThereIsNoWayOut) {
  for_each_set([](const wide::Searches& searches) {
    EXPECT_EQ(searches.way_out({}, Vec3::Zero(), Vec3::UnitX()), std::numeric_limits<double>::infinity());
    const std::vector<EightSides> open(1);  // they hold everything
    std::uint8_t lanes = 1;
    EXPECT_TRUE(searches.sides_near(open, Vec3(1e9, 0, 0), 1e9, &lanes));
    EXPECT_EQ(lanes, 0U);
    EXPECT_EQ(searches.way_out(open, Vec3::Zero(), Vec3::UnitX()), std::numeric_limits<double>::infinity());
  });
}

}  // namespace
}  // namespace odds::query
