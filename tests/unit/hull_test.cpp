// Convex hulls: what they enclose, and that they part what can be parted.
#include "odds/volume/hull.hpp"

#include <gtest/gtest.h>

#include "odds/math/random.hpp"
#include "support/allocation_counter.hpp"
#include "volume/point_to_hull.hpp"

namespace odds::volume {
namespace {

std::vector<Vec3> cloud(math::Random& random, std::size_t size, const Vec3& extents) {
  std::vector<Vec3> points(size);
  for (Vec3& point : points) point = extents.cwiseProduct(random.uniform(0.5, 1.0) * random.direction());
  return points;
}

std::vector<Vec3> vertices_of(const Hull& hull) {
  std::vector<Vec3> vertices;
  for (std::size_t i = 0; i < hull.count_; ++i) vertices.push_back(hull.vertex(i));
  return vertices;
}

TEST(PointToHull, KnowsTheDistancesFromACube) {
  std::vector<Vec3> cube;
  for (unsigned i = 0; i < 8; ++i) cube.emplace_back(i & 1U, i >> 1U & 1U, i >> 2U);
  math::Random random(1);
  for (int i = 0; i < 3000; ++i) {
    const Vec3 point(random.uniform(-1.0, 2.0), random.uniform(-1.0, 2.0), random.uniform(-1.0, 2.0));
    const double expected = (point - point.cwiseMax(0.0).cwiseMin(1.0)).norm();
    EXPECT_NEAR(distance_to_hull(point, cube, 0.0), expected, 1e-5) << point.transpose();
  }
}

TEST(PointToHull, KnowsFlatAndRepeatedCorners) {
  const Vec3 p(0, 0, 2);
  EXPECT_DOUBLE_EQ(distance_to_hull(p, std::vector<Vec3>(5, Vec3(0, 0, 1)), 0.0), 1.0);
  EXPECT_DOUBLE_EQ(distance_to_hull(p, std::vector<Vec3>{{-1, 0, 0}, {1, 0, 0}, {0.5, 0, 0}}, 0.0), 2.0);
  EXPECT_DOUBLE_EQ(distance_to_hull(p, std::vector<Vec3>{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, 0.0), 2.0);
  EXPECT_NEAR(distance_to_hull({0.2, 0.1, 0}, std::vector<Vec3>{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}}, 0.0), 0.0, 1e-15);
}

TEST(Hull, EnclosesEveryPoint) {
  math::Random random(2);
  for (int i = 0; i < 300; ++i) {
    const Vec3 extents(1.0, i % 3 == 0 ? 1.0 : 0.1, i % 5 == 0 ? 0.0 : 0.3);
    std::vector<Vec3> points = cloud(random, static_cast<std::size_t>(3 + 7 * (i % 40)), extents);
    const Vec3 offset = 10.0 * random.direction();
    for (Vec3& point : points) point += offset;
    const Hull hull = Hull::fit(points, random.rotation().toRotationMatrix());
    const std::vector<Vec3> vertices = vertices_of(hull);
    for (const Vec3& point : points) {
      // Both are found from above; where rounding hides progress, one may end higher by less than kept vertices round.
      ASSERT_LE(distance_to_hull(point, vertices, 0.0), static_cast<double>(hull.inflation_) * (1 + 1e-5) + 1e-6) << i;
    }
  }
}

TEST(Hull, OfFewCornersIsExact) {
  math::Random random(3);
  for (int i = 0; i < 100; ++i) {
    const Hull hull = Hull::fit(cloud(random, 12, Vec3::Ones()), Mat3::Identity());
    EXPECT_LE(hull.inflation_, hull.radius() / 256.0F * 1.001F);
  }
}

TEST(Hull, PartsWhateverAPlaneParts) {
  // B is pushed out of A along a random direction until a gap of 3 % is left; boxes still overlap in most cases.
  math::Random random(4);
  int boxes_overlap = 0;
  constexpr int pairs = 2000;
  for (int i = 0; i < pairs; ++i) {
    const std::vector<Vec3> a = cloud(random, 5 + static_cast<std::size_t>(i % 8), Vec3(1, 0.6, 0.4));
    const std::vector<Vec3> b = cloud(random, 5 + static_cast<std::size_t>(i % 8), Vec3(0.3, 0.8, 0.5));
    const Vec3 direction = random.direction();
    math::Pose b_in_a{random.rotation().toRotationMatrix(), Vec3::Zero()};
    double end_of_a = -INFINITY;
    double start_of_b = INFINITY;
    for (const Vec3& p : a) end_of_a = std::max(end_of_a, direction.dot(p));
    for (const Vec3& p : b) start_of_b = std::min(start_of_b, direction.dot(b_in_a * p));
    b_in_a.translation = (end_of_a - start_of_b + 0.03) * direction;
    const Hull hull_a = Hull::fit(a, Mat3::Identity());
    const Hull hull_b = Hull::fit(b, Mat3::Identity());
    for (const double scale : {1.0, 0x1p-40, 0x1p40}) {
      const auto scaled = [&](std::vector<Vec3> points) {
        for (Vec3& point : points) point *= scale;
        return Hull::fit(points, Mat3::Identity());
      };
      const math::Pose pose{b_in_a.rotation, scale * b_in_a.translation};
      ASSERT_FALSE(overlap(scaled(a), scaled(b), RelativePose::make(pose, 8.0 * scale))) << i << " scale " << scale;
    }
    boxes_overlap += overlap(hull_a.box_, hull_b.box_, RelativePose::make(b_in_a, 8.0)) ? 1 : 0;
  }
  EXPECT_GT(boxes_overlap, pairs / 10) << "else the boxes alone do the work";
}

TEST(Hull, NeitherFitsOfFewPointsNorQueriesAllocate) {
  if (!support::counts_allocations) GTEST_SKIP() << "the sanitizer's allocator is not counted";
  math::Random random(5);
  const std::vector<Vec3> points = cloud(random, 64, Vec3::Ones());
  const RelativePose pose = RelativePose::make({random.rotation().toRotationMatrix(), Vec3(1.5, 0.2, 0.1)}, 8.0);
  const support::AllocationCounter counter;
  const Hull hull = Hull::fit(points, Mat3::Identity());
  static_cast<void>(overlap(hull, hull, pose));
  EXPECT_EQ(counter.allocations(), 0u);
}

}  // namespace
}  // namespace odds::volume
