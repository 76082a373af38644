// The corner of greatest value, against looking at each; how far boxes and triangles reach, by each instruction set.
#include "query/shape/corner_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "odds/math/random.hpp"
#include "query/wide/searches.hpp"
#include "support/each_kernel.hpp"
#include "support/wavy_tree.hpp"

namespace odds::query {
namespace {

constexpr double nothing = -std::numeric_limits<double>::infinity();

/// Of direction . x, by the portable kernels.
struct Along {
  Vec3f direction;
  float margin;

  void of(const tree::WideNode& node, CornerSearch::OfLanes& most) const {
    wide::Extents extents;
    wide::searches_for(InstructionSet::portable)->extents_of_children(node, direction, extents);
    for (std::size_t k = 0; k < tree::wide_lanes; ++k) most[k] = extents.greatest[k] + margin;
  }
  void of(const tree::WideLeaf& leaf, const Vec3f& center, CornerSearch::OfLanes& most) const {
    wide::Extents extents;
    wide::searches_for(InstructionSet::portable)->extents_of_triangles(leaf, center, direction, extents);
    for (std::size_t k = 0; k < tree::wide_lanes; ++k) most[k] = extents.greatest[k] + margin;
  }
};

class CornerSearches : public ::testing::TestWithParam<double> {
 protected:
  [[nodiscard]] Along along(const Vec3& direction) const { return {direction.cast<float>(), search.margin()}; }
  [[nodiscard]] std::uint32_t corners() const {
    return 3 * static_cast<std::uint32_t>(sphere.mesh->triangles().size());
  }

  testing::WavyTree sphere{Vec3::Constant(GetParam())};
  CornerSearch search{*sphere.mesh, *sphere.tree};
};

TEST_P(CornerSearches, FindWhatLookingAtEachFinds) {
  math::Random random(5, 1);
  int none = 0;
  for (int round = 0; round < 200; ++round) {
    const Vec3 direction = random.direction();
    const Vec3 other = random.direction();
    const double highest = random.uniform(-1.3, 1.0);  // of those that count, along the other direction
    const auto value = [&](const Vec3& x) { return other.dot(x) <= highest ? direction.dot(x) : nothing; };
    double greatest = nothing;
    for (std::uint32_t corner = 0; corner < corners(); ++corner) {
      greatest = std::max(greatest, value(search.place(corner)));
    }
    for (const double not_greater : {0.0, 0.1}) {
      std::uint64_t nodes = 1'000'000;
      const std::uint32_t found = search.greatest(
          not_greater, value, along(direction), [] { return true; }, nodes);
      ASSERT_EQ(found == no_feature, greatest == nothing);
      if (found == no_feature) {
        ++none;
        continue;
      }
      EXPECT_GE(value(search.place(found)), greatest - not_greater);
      EXPECT_TRUE(not_greater > 0.0 || value(search.place(found)) == greatest);
      EXPECT_LT(CornerSearch::triangle_of(found), sphere.mesh->triangles().size());
    }
  }
  EXPECT_GT(none, 5);
}

TEST_P(CornerSearches, LookAtFewWhereNothingElseIsAsked) {
  math::Random random(5, 2);
  std::uint64_t exactly = 0;
  std::uint64_t roughly = 0;
  for (int round = 0; round < 100; ++round) {
    const Vec3 direction = random.direction();
    const auto value = [&](const Vec3& x) { return direction.dot(x); };
    for (const double not_greater : {0.0, 0.1}) {
      std::uint64_t nodes = 1'000'000;
      static_cast<void>(search.greatest(
          not_greater, value, along(direction), [] { return true; }, nodes));
      (not_greater > 0.0 ? roughly : exactly) += 1'000'000 - nodes;
    }
  }
  EXPECT_LT(exactly, 100 * 30u);
  EXPECT_LT(roughly, exactly / 2);
}

TEST_P(CornerSearches, EndWhereTheyAreTold) {
  const auto value = [](const Vec3& x) { return x.x(); };
  std::uint64_t nodes = 100;
  EXPECT_EQ(search.greatest(
                0.0, value, along(Vec3::UnitX()), [] { return false; }, nodes),
            no_feature);
  EXPECT_EQ(nodes, 100u);
  nodes = 0;
  EXPECT_EQ(search.greatest(
                0.0, value, along(Vec3::UnitX()), [] { return true; }, nodes),
            no_feature);
  int looks = 0;
  nodes = 1'000'000;
  const auto all = [](const tree::WideNode&, CornerSearch::OfLanes& most) { std::fill_n(most, 8, 10.0F); };
  struct Everything {
    decltype(all)& of_node;
    void of(const tree::WideNode& node, CornerSearch::OfLanes& most) const { of_node(node, most); }
    void of(const tree::WideLeaf&, const Vec3f&, CornerSearch::OfLanes& most) const { std::fill_n(most, 8, 10.0F); }
  };
  const std::uint32_t some = search.greatest(
      0.0, value, Everything{all}, [&] { return ++looks <= 24; }, nodes);
  EXPECT_NE(some, no_feature) << "what was found by then";
  EXPECT_EQ(1'000'000 - nodes, 24u) << "it is asked at each";
}

INSTANTIATE_TEST_SUITE_P(About, CornerSearches, ::testing::Values(0.0, 1e3, -1e6));

TEST(ExtentsKernels, OfEachInstructionSetGiveTheSame) {
  const wide::Searches& portable = *wide::searches_for(InstructionSet::portable);
  math::Random random(9, 2);
  Vec3f direction;
  wide::Extents expected;
  wide::Extents own;
  testing::for_each_kernel(
      &wide::Searches::extents_of_children,
      [&](const wide::Searches& searches, const tree::WideNode& node) {
        direction = random.direction().cast<float>();
        portable.extents_of_children(node, direction, expected);
        searches.extents_of_children(node, direction, own);
        for (unsigned lane = 0; lane < tree::wide_lanes && !node.child[lane].is_nothing(); ++lane) {
          EXPECT_EQ(own.least[lane], expected.least[lane]);
          EXPECT_EQ(own.greatest[lane], expected.greatest[lane]);
        }
      },
      [&](const wide::Searches& searches, const tree::WideLeaf& leaf, unsigned count, const Vec3f& center) {
        portable.extents_of_triangles(leaf, center, direction, expected);
        searches.extents_of_triangles(leaf, center, direction, own);
        for (unsigned t = 0; t < count; ++t) {
          EXPECT_EQ(own.least[t], expected.least[t]);
          EXPECT_EQ(own.greatest[t], expected.greatest[t]);
          float least = std::numeric_limits<float>::infinity();
          float greatest = -least;
          for (const auto& corner : leaf.corner) {
            const float along = direction.dot(center + Vec3f(corner[0][t], corner[1][t], corner[2][t]));
            least = std::min(least, along);
            greatest = std::max(greatest, along);
          }
          EXPECT_NEAR(own.least[t], least, 1e-6F);
          EXPECT_NEAR(own.greatest[t], greatest, 1e-6F);
        }
      });
}

}  // namespace
}  // namespace odds::query
