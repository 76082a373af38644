// The outermost of points, eight at a time, by each instruction set against one at a time.
#include "query/wide/outermost.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "odds/math/random.hpp"
#include "query/wide/searches.hpp"
#include "support/each_kernel.hpp"

namespace odds::query {
namespace {

using wide::EightPoints;

/// Points of a number that is no multiple of eight.
class Outermost : public ::testing::Test {
 protected:
  static constexpr std::size_t count = 77;

  Outermost() : eights((count + EightPoints::count - 1) / EightPoints::count) {
    for (std::size_t i = 0; i < EightPoints::count * eights.size(); ++i) {
      EightPoints& eight = eights[i / EightPoints::count];
      if (i < count) {
        points.push_back(random.uniform(0.0, 2.0) * random.direction());
        depths.push_back(random.uniform(-1.0, 1.0));
        eight.set(i % EightPoints::count, points[i], depths[i]);
      } else {
        eight.leave_out(i % EightPoints::count);
      }
    }
  }
  template <class Value>
  [[nodiscard]] std::uint32_t expected(double per_depth, double least_depth, std::size_t step,
                                       const Value& value) const {
    double most = -std::numeric_limits<double>::infinity();
    std::uint32_t found = no_feature;
    for (std::uint32_t i = 0; i < count; ++i) {
      const double v = value(points[i]) + per_depth * depths[i];
      if (i / EightPoints::count % step != 0 || depths[i] < least_depth || !(v > most)) continue;
      most = v;
      found = i;
    }
    return found;
  }
  template <class Check>
  static void for_each_set(const Check& check) {
    testing::for_each_instruction_set(&wide::Searches::outermost_along, check);
  }

  math::Random random{9, 1};
  std::vector<EightPoints> eights;
  std::vector<Vec3> points;
  std::vector<double> depths;
};

constexpr double any_depth = std::numeric_limits<double>::lowest();

TEST_F(Outermost, AlongADirection) {
  for (int round = 0; round < 300; ++round) {
    const Vec3 direction = random.direction();
    const double per_depth = random.uniform(0.0, 2.0);
    const double least = round % 3 == 0 ? any_depth : random.uniform(-1.0, 1.05);
    const std::size_t step = 1 + random.below(4);
    const std::uint32_t right = expected(per_depth, least, step, [&](const Vec3& p) { return direction.dot(p); });
    for_each_set([&](const wide::Searches& searches) {
      EXPECT_EQ(searches.outermost_along(eights, direction, per_depth, least, step), right) << searches.instruction_set;
    });
  }
}

TEST_F(Outermost, FromAPointAcrossADirectionOrAnyhow) {
  for (int round = 0; round < 300; ++round) {
    const Vec3 from = 2.0 * random.direction();
    const Vec3 normal = round % 2 == 0 ? random.direction() : Vec3(Vec3::Zero());
    const double per_depth = random.uniform(0.0, 2.0);
    const double least = round % 3 == 0 ? any_depth : random.uniform(-1.0, 1.05);
    const std::uint32_t right = expected(per_depth, least, 1, [&](const Vec3& p) {
      const Vec3 d = p - from;
      return (d - d.dot(normal) * normal).squaredNorm();
    });
    for_each_set([&](const wide::Searches& searches) {
      EXPECT_EQ(searches.outermost_from(eights, from, normal, per_depth, least, 1), right) << searches.instruction_set;
    });
  }
}

TEST_F(Outermost, OfThoseAsFarOutTheFirst) {
  std::vector<EightPoints> same(3);
  for (EightPoints& eight : same) {
    for (std::size_t lane = 0; lane < EightPoints::count; ++lane) eight.set(lane, Vec3(1, 2, 3), 0.0);
  }
  same[0].leave_out(0);
  same[0].set(1, Vec3::Zero(), 0.0);
  for_each_set([&](const wide::Searches& searches) {
    EXPECT_EQ(searches.outermost_along(same, Vec3::UnitX(), 0.0, any_depth, 1), 2U);
    EXPECT_EQ(searches.outermost_along(std::span(same).subspan(1), Vec3::UnitX(), 0.0, any_depth, 1), 0U);
  });
}

TEST_F(Outermost, OfNoneNone) {
  std::vector<EightPoints> none(1);
  for (std::size_t lane = 0; lane < EightPoints::count; ++lane) none[0].leave_out(lane);
  for_each_set([&](const wide::Searches& searches) {
    EXPECT_EQ(searches.outermost_along({}, Vec3::UnitX(), 1.0, any_depth, 1), no_feature);
    EXPECT_EQ(searches.outermost_along(none, Vec3::UnitX(), 1.0, any_depth, 1), no_feature);
    EXPECT_EQ(searches.outermost_from(eights, Vec3::Zero(), Vec3::UnitX(), 1.0, 2.0, 1), no_feature);
  });
}

}  // namespace
}  // namespace odds::query
