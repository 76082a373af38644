// The nearest triangle to a segment or a point, and all within a distance, against looking at each.
#include "query/shape/near_segment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <variant>
#include <vector>

#include "odds/math/random.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/primitive/triangle_distance.hpp"
#include "odds/query/shape.hpp"
#include "query/shape_data.hpp"
#include "support/each_kernel.hpp"
#include "support/wavy_tree.hpp"

namespace odds::query {
namespace {

class NearSegments : public ::testing::TestWithParam<double> {
 protected:
  [[nodiscard]] double distance(std::uint32_t triangle, const Vec3& begin, const Vec3& end) const {
    const mesh::Triangle& t = mesh->triangles()[triangle];
    const Vec3 corners[3] = {mesh->vertices()[t[0]], mesh->vertices()[t[1]], mesh->vertices()[t[2]]};
    return std::sqrt(primitive::closest_points_segment_triangle(begin, end, corners).squared_distance);
  }

  Vec3 middle = Vec3::Constant(GetParam());
  testing::WavyTree sphere{middle};  // about it
  const mesh::TriangleMesh* mesh = sphere.mesh.get();
  const tree::WideTree* tree = sphere.tree;
};

TEST_P(NearSegments, FindWhatLookingAtEachTriangleFinds) {
  math::Random random(8, 1);
  std::size_t none = 0;
  std::size_t passed_over = 0;
  for (int round = 0; round < 120; ++round) {
    const Vec3 begin = middle + random.uniform(0.0, 2.0) * random.direction();
    const double length = round % 3 == 0 ? 0.0 : random.uniform(0.0, 1.5);
    const Vec3 end = begin + length * random.direction();
    std::vector<double> distances(mesh->triangles().size());
    for (std::uint32_t t = 0; t < distances.size(); ++t) distances[t] = distance(t, begin, end);
    const double least = *std::min_element(distances.begin(), distances.end());
    const NearSegment near(*mesh, *tree, begin, end);
    std::size_t asked = 0;
    const auto counted = [&](std::uint32_t t) {
      ++asked;
      return distances[t];
    };
    for (const double within : {0.3, std::numeric_limits<double>::infinity()}) {
      std::uint64_t nodes = 1'000'000;
      bool finished = false;
      const std::uint32_t found = near.nearest(
          within, 0.0, counted, [] { return true; }, nodes, finished);
      EXPECT_TRUE(finished);
      ASSERT_EQ(found == no_feature, least > within);
      if (found == no_feature) {
        ++none;
      } else {
        EXPECT_EQ(distances[found], least);
      }
    }
    std::uint64_t all = 1'000'000;
    bool finished = false;
    const auto at = [&](std::uint32_t t) { return distances[t]; };
    const std::uint32_t about = near.nearest(
        10.0, 0.05, at, [] { return true; }, all, finished);
    ASSERT_NE(about, no_feature);
    EXPECT_LE(distances[about], least + 0.05) << "no other is nearer by more";
    passed_over += 2 * distances.size() - asked;
    std::vector<int> times(distances.size(), 0);
    std::uint64_t nodes = 1'000'000;
    const double within = random.uniform(0.0, 0.5);
    EXPECT_TRUE(near.all_within(
        within,
        [&](std::uint32_t t) {
          ++times[t];
          return true;
        },
        [] { return true; }, nodes));
    for (std::uint32_t t = 0; t < distances.size(); ++t) {
      EXPECT_LE(times[t], 1);
      EXPECT_TRUE(times[t] == 1 || distances[t] > within) << t;
    }
  }
  EXPECT_GT(none, 5u);
  EXPECT_GT(passed_over, 200 * mesh->triangles().size()) << "most need not be looked at";
}

TEST_P(NearSegments, EndWhereTheyAreTold) {
  const Vec3 from = middle + Vec3(2.0, 0.3, 0.1);
  const NearSegment near(*mesh, *tree, from, from);
  const auto far = [&](std::uint32_t t) { return distance(t, from, from); };
  bool finished = true;
  std::uint64_t nodes = 2;
  EXPECT_EQ(near.nearest(
                10.0, 0.0, far, [] { return true; }, nodes, finished),
            no_feature);
  EXPECT_FALSE(finished);
  EXPECT_EQ(nodes, 0u);
  nodes = 100;
  EXPECT_EQ(near.nearest(
                10.0, 0.0, far, [] { return false; }, nodes, finished),
            no_feature);
  EXPECT_FALSE(finished);
  EXPECT_EQ(nodes, 100u);
  std::size_t taken = 0;
  EXPECT_FALSE(near.all_within(
      10.0, [&](std::uint32_t) { return ++taken < 3; }, [] { return true; }, nodes));
  EXPECT_EQ(taken, 3u);
}

INSTANTIATE_TEST_SUITE_P(About, NearSegments, ::testing::Values(0.0, 1e3, -1e6));

// Visited by bounds of slabs, too, surface on the far side of a solid came first: in a short time a body found none of
// what lay beside its middle.
TEST(NearSegment, ComesToWhatIsNearestSoon) {
  const auto made = mesh::made::make_shape("bumpy_sphere");
  ASSERT_TRUE(made.ok());
  const auto mesh = std::make_shared<const mesh::TriangleMesh>(made.value());
  const auto shape = Shape::build(mesh).value();
  const tree::WideTree& tree = std::get<tree::WideTree>(shape->data().tree);
  int soon = 0;
  constexpr int points = 500;
  for (int i = 0; i < points; ++i) {
    math::Random random(4, static_cast<std::uint64_t>(i));
    const Vec3 vertex = mesh->vertices()[random.below(mesh->vertices().size())];
    const Vec3 away = random.direction();
    const Vec3 from = vertex + random.uniform(0.0, 0.25) * mesh->size() * away;
    const auto distance = [&](std::uint32_t triangle) {
      const mesh::Triangle& t = mesh->triangles()[triangle];
      const Vec3 corners[3] = {mesh->vertices()[t[0]], mesh->vertices()[t[1]], mesh->vertices()[t[2]]};
      return (primitive::closest_point_on_triangle(from, corners) - from).norm();
    };
    const NearSegment near(*mesh, tree, from, from);
    std::uint64_t nodes = 1'000'000;
    double first = 0.0;
    const auto take = [&](std::uint32_t triangle) {
      first = distance(triangle);
      return false;
    };
    static_cast<void>(near.all_within(
        mesh->size(), take, [] { return true; }, nodes));
    bool finished = false;
    const std::uint32_t nearest = near.nearest(
        mesh->size(), 0.0, distance, [] { return true; }, nodes, finished);
    soon += first <= distance(nearest) + 5e-3 * mesh->size() ? 1 : 0;
  }
  EXPECT_GT(soon, points * 7 / 10);
}

// Slivers, whose normals are rounding; sizes the squares of whose squares underflow or overflow.
TEST(NearSegmentKernels, BoundsOfTrianglesAreNoMoreThanDistances) {
  math::Random random(9, 3);
  double sum_of_bounds = 0.0;
  double sum_of_distances = 0.0;
  for (int round = 0; round < 4000; ++round) {
    const double scale = std::pow(10.0, round % 2 == 0 ? 0.0 : random.uniform(-16.0, 12.0));
    const Vec3 from = scale * random.uniform(0.0, 10.0) * random.direction();
    const Vec3 middle = from + scale * random.uniform(0.0, 4.0) * random.direction();
    const Vec3 half = (round % 3 == 0 ? 0.0 : scale * random.uniform()) * random.direction();
    const wide::SegmentInTree segment = segment_about(middle.cast<float>(), half.cast<float>());
    alignas(64) tree::WideLeaf leaf;
    Vec3 corners[tree::wide_lanes][3];
    for (unsigned t = 0; t < tree::wide_lanes; ++t) {
      const double width = t % 2 == 0 ? 1.0 : std::pow(10.0, random.uniform(-9.0, 0.0));
      const Vec3 along = random.direction();
      const Vec3 across = along.cross(random.direction());
      const Vec3 first = random.uniform() * random.direction();
      const Vec3 all[3] = {first, first + along, first + random.uniform() * along + width * across};
      for (int c = 0; c < 3; ++c) {
        for (int axis = 0; axis < 3; ++axis) leaf.corner[c][axis][t] = static_cast<float>(scale * all[c][axis]);
        corners[t][c] =
            from.cast<float>().cast<double>() + Vec3(leaf.corner[c][0][t], leaf.corner[c][1][t], leaf.corner[c][2][t]);
      }
    }
    float least[tree::wide_lanes];
    wide::searches_for(InstructionSet::portable)
        ->triangles_near(leaf, tree::wide_lanes, from.cast<float>(), segment, least);
    const Vec3 begin = (segment.middle - segment.half).cast<double>();
    const Vec3 end = (segment.middle + segment.half).cast<double>();
    for (unsigned t = 0; t < tree::wide_lanes; ++t) {
      const double d = std::sqrt(primitive::closest_points_segment_triangle(begin, end, corners[t]).squared_distance);
      const double bound = static_cast<double>(least[t]);
      ASSERT_FALSE(bound > d + 16.0 * 0x1p-24 * 20.0 * scale)
          << bound << " of " << d << " scale " << scale << ", lane " << t << ", round " << round;
      if (round % 2 == 0) sum_of_bounds += std::max(bound, 0.0);
      if (round % 2 == 0) sum_of_distances += d;
    }
  }
  EXPECT_GT(sum_of_bounds, 0.9 * sum_of_distances);
}

TEST(NearSegmentKernels, OfEachInstructionSetGiveTheSame) {
  const wide::Searches& portable = *wide::searches_for(InstructionSet::portable);
  math::Random random(9, 1);
  wide::SegmentInTree segment;
  float expected[tree::wide_lanes];
  float own[tree::wide_lanes];
  int nodes = 0;
  testing::for_each_kernel(
      &wide::Searches::children_near,
      [&](const wide::Searches& searches, const tree::WideNode& node) {
        const Vec3 middle = random.direction();
        const Vec3 half = (nodes++ % 4 == 0 ? 0.0 : 0.4) * random.direction();
        segment = segment_about(middle.cast<float>(), half.cast<float>());
        float boxes_expected[tree::wide_lanes];
        float boxes[tree::wide_lanes];
        portable.children_near(node, segment, expected, boxes_expected);
        searches.children_near(node, segment, own, boxes);
        for (unsigned lane = 0; lane < tree::wide_lanes; ++lane) {
          EXPECT_EQ(own[lane], expected[lane]);
          EXPECT_EQ(boxes[lane], boxes_expected[lane]);
          EXPECT_EQ(node.child[lane].is_nothing(), own[lane] == std::numeric_limits<float>::infinity());
        }
      },
      [&](const wide::Searches& searches, const tree::WideLeaf& leaf, unsigned count, const Vec3f& from) {
        portable.triangles_near(leaf, count, from, segment, expected);
        searches.triangles_near(leaf, count, from, segment, own);
        for (unsigned t = 0; t < tree::wide_lanes; ++t) EXPECT_EQ(own[t], expected[t]);
      });
}

}  // namespace
}  // namespace odds::query
