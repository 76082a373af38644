// Triangles of a wide tree in convex regions, against looking at each.
#include "query/shape/convex_region.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "odds/math/random.hpp"
#include "support/each_kernel.hpp"
#include "support/wavy_tree.hpp"

namespace odds::query {
namespace {

using Sides = ConvexRegion::Sides;

struct HalfSpace {
  Vec3 normal;
  double offset;
};

class ConvexRegions : public ::testing::TestWithParam<double> {
 protected:
  std::vector<HalfSpace> any_half_spaces(math::Random& random, std::size_t count) {
    const Vec3 about = middle + random.uniform(0.0, 1.2) * random.direction();
    std::vector<HalfSpace> all(count);
    for (HalfSpace& side : all) {
      side.normal = random.direction();
      side.offset = side.normal.dot(about) + random.uniform(0.0, 0.4);
    }
    return all;
  }
  [[nodiscard]] std::array<double, 3> heights(std::uint32_t triangle, const HalfSpace& side) const {
    std::array<double, 3> above{};
    for (std::size_t i = 0; i < 3; ++i) {
      above[i] = side.normal.dot(mesh->vertices()[mesh->triangles()[triangle][i]]) - side.offset;
    }
    return above;
  }

  Vec3 middle = Vec3::Constant(GetParam());
  testing::WavyTree sphere{middle};  // about it
  const mesh::TriangleMesh* mesh = sphere.mesh.get();
  const tree::WideTree* tree = sphere.tree;
};

TEST_P(ConvexRegions, HaveAllTrianglesThatAreNotBeyondASideAndWhatMayCutThem) {
  math::Random random(5, 1);
  const double rounding = 1e-12 * (1.0 + std::abs(GetParam()));
  std::size_t left_out = 0;
  std::size_t whole = 0;
  for (int round = 0; round < 200; ++round) {
    const std::vector<HalfSpace> sides = any_half_spaces(random, 1 + static_cast<std::size_t>(round) % 20);
    ConvexRegion region(*mesh, *tree, rounding);
    for (const HalfSpace& side : sides) region.add(side.normal, side.offset);
    std::vector<Sides> found(mesh->triangles().size());
    std::vector<int> times(found.size(), 0);
    std::uint64_t nodes = 1'000'000;
    const bool all = region.search([](tree::ChildRef, Sides) { return ConvexRegion::Visit::open; },
                                   [&](std::uint32_t triangle, Sides left) {
                                     found[triangle] = left;
                                     ++times[triangle];
                                     return true;
                                   },
                                   nodes);
    ASSERT_TRUE(all);
    for (std::uint32_t t = 0; t < found.size(); ++t) {
      ASSERT_LE(times[t], 1);
      bool is_beyond = false;
      for (std::size_t i = 0; i < sides.size(); ++i) {
        const auto above = heights(t, sides[i]);
        is_beyond = is_beyond || *std::min_element(above.begin(), above.end()) > 0.0;
        if (times[t] == 1 && (found[t] >> i & 1U) == 0) {
          EXPECT_LT(*std::max_element(above.begin(), above.end()), -rounding) << "it was told to be well within";
          ++whole;
        }
      }
      EXPECT_TRUE(times[t] == 1 || is_beyond) << "left out: " << t;
      left_out += times[t] == 0 ? 1 : 0;
    }
  }
  EXPECT_GT(left_out, 100'000u);
  EXPECT_GT(whole, 10'000u);
}

TEST_P(ConvexRegions, ChangeAndEndWhereTheyAreTold) {
  ConvexRegion region(*mesh, *tree, 1e-9);
  region.add(Vec3::UnitX(), middle.x() + 0.3);
  region.add(Vec3::UnitX(), middle.x() - 1e300);  // nothing is within
  const auto open = [](tree::ChildRef, Sides) { return ConvexRegion::Visit::open; };
  std::size_t taken = 0;
  const auto take = [&](std::uint32_t, Sides) { return ++taken < 5; };
  std::uint64_t nodes = 100;
  EXPECT_TRUE(region.search(open, take, nodes));
  EXPECT_EQ(taken, 0u);
  EXPECT_EQ(nodes, 100u);
  region.set(1, Vec3::UnitX(), middle.x() + 1e300);  // everything
  EXPECT_FALSE(region.search(open, take, nodes));
  EXPECT_EQ(taken, 5u);
  nodes = 1;
  taken = 0;
  EXPECT_FALSE(region.search(open, take, nodes)) << "one node has no triangles";
  EXPECT_EQ(taken, 0u);
  EXPECT_EQ(nodes, 0u);
  nodes = 100;
  EXPECT_FALSE(region.search([](tree::ChildRef, Sides) { return ConvexRegion::Visit::end; }, take, nodes));
  EXPECT_EQ(nodes, 100u);
  EXPECT_TRUE(region.search([](tree::ChildRef, Sides) { return ConvexRegion::Visit::pass_over; }, take, nodes));
  EXPECT_EQ(taken, 0u);
}

INSTANTIATE_TEST_SUITE_P(About, ConvexRegions, ::testing::Values(0.0, 1e3, -1e6));

TEST(HalfSpaceKernels, OfEachInstructionSetGiveTheSame) {
  const wide::Searches& portable = *wide::searches_for(InstructionSet::portable);
  math::Random random(6, 1);
  wide::HalfSpaces spaces;
  spaces.margin = 1e-6F;
  spaces.well_within = 2e-6F;
  wide::LanesWithin expected;
  wide::LanesWithin own;
  const auto compare = [&] {
    ASSERT_EQ(own.lanes, expected.lanes);
    for (std::size_t lane = 0; lane < tree::wide_lanes; ++lane) {
      const bool is_within = (own.lanes >> lane & 1U) != 0;
      ASSERT_TRUE(!is_within || own.sides[lane] == expected.sides[lane]);
    }
  };
  testing::for_each_kernel(
      &wide::Searches::children_within,
      [&](const wide::Searches& searches, const tree::WideNode& node) {
        for (spaces.count = 0; spaces.count < 9; ++spaces.count) {
          const Vec3 normal = random.direction();
          for (int axis = 0; axis < 3; ++axis) spaces.normal[spaces.count][axis] = static_cast<float>(normal[axis]);
          spaces.offset[spaces.count] = static_cast<float>(random.uniform(0.2, 1.2));
        }
        portable.children_within(node, spaces, spaces.all(), expected);
        searches.children_within(node, spaces, spaces.all(), own);
        compare();
      },
      [&](const wide::Searches& searches, const tree::WideLeaf& leaf, unsigned count, const Vec3f& center) {
        portable.triangles_within(leaf, count, center, spaces, spaces.all(), expected);
        searches.triangles_within(leaf, count, center, spaces, spaces.all(), own);
        EXPECT_EQ(own.lanes >> count, 0u);
        compare();
      });
}

}  // namespace
}  // namespace odds::query
