// Every crossing of a ray, against asking each triangle; edges and corners, from afar, without end.
#include "query/ray/crossings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "odds/math/random.hpp"
#include "primitive/watertight_ray.hpp"
#include "support/wavy_tree.hpp"

namespace odds::query {
namespace {

class RayCrossings : public ::testing::TestWithParam<double> {
 protected:
  [[nodiscard]] std::vector<RayHit> all(Crossings& crossings) const {
    std::vector<RayHit> found;
    RayEffort effort;
    while (const auto hit = crossings.next({UINT64_MAX}, effort)) {
      EXPECT_TRUE(effort.finished);
      found.push_back(*hit);
      if (found.size() > 100) break;
    }
    return found;
  }
  /// As each triangle has them, nearest first, those of common edges once.
  [[nodiscard]] std::vector<double> expected(const Vec3& origin, const Vec3& direction, double length,
                                             bool front_only) const {
    const primitive::WatertightRay ray(origin, direction, front_only);
    std::vector<double> distances;
    for (const mesh::Triangle& t : mesh.triangles()) {
      const Vec3 corners[3] = {mesh.vertices()[t[0]], mesh.vertices()[t[1]], mesh.vertices()[t[2]]};
      const double distance = ray.crossing(corners);
      if (distance >= 0.0 && distance <= length) distances.push_back(distance);
    }
    std::sort(distances.begin(), distances.end());
    const auto same = [](double x, double y) { return y <= x * (1.0 + 1e-10); };
    distances.erase(std::unique(distances.begin(), distances.end(), same), distances.end());
    return distances;
  }

  Vec3 middle = Vec3::Constant(GetParam());
  testing::WavyTree sphere{middle};
  const mesh::TriangleMesh& mesh = *sphere.mesh;
};

TEST_P(RayCrossings, AreThoseOfEachTriangle) {
  math::Random random(12, 1);
  std::size_t most = 0;
  for (int round = 0; round < 400; ++round) {
    const Vec3 origin = middle + random.uniform(0.0, 3.0) * random.direction();
    const Vec3 aim = round % 4 == 0 ? mesh.vertices()[random.below(mesh.vertices().size())]
                                    : Vec3(middle + random.uniform(0.0, 1.2) * random.direction());
    const Vec3 direction = (aim - origin).normalized();
    const double length = round % 3 == 0 ? INFINITY : random.uniform(0.0, 4.0);
    const bool front_only = round % 5 == 0;
    Crossings crossings(mesh, *sphere.tree, origin, direction, length, front_only);
    const std::vector<RayHit> found = all(crossings);
    const std::vector<double> right = expected(origin, direction, length, front_only);
    ASSERT_EQ(found.size(), right.size()) << round;
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].distance, right[i]) << round;
    most = std::max(most, found.size());
  }
  EXPECT_GE(most, 4u);
}

TEST_P(RayCrossings, OfAClosedSurfaceComeInPairsFromAnyDistance) {
  math::Random random(12, 2);
  int met = 0;
  for (int round = 0; round < 300; ++round) {
    const double away = std::pow(10.0, random.uniform(1.0, 7.0));
    const Vec3 origin = middle + away * random.direction();
    const Vec3 aim = round % 2 == 0 ? mesh.vertices()[random.below(mesh.vertices().size())]
                                    : Vec3(middle + 0.9 * random.uniform() * random.direction());
    const Vec3 direction = (aim - origin).normalized();
    Crossings crossings(mesh, *sphere.tree, origin, direction, INFINITY, false);
    const std::vector<RayHit> found = all(crossings);
    if (round % 2 == 1) {
      EXPECT_GE(found.size(), 2u);
      EXPECT_EQ(found.size() % 2, 0u) << away;
    }
    for (const RayHit& hit : found) {
      EXPECT_NEAR(hit.distance, away, 3.0);
      ++met;
    }
    Crossings too_short(mesh, *sphere.tree, origin, direction, away - 3.0, false);
    EXPECT_TRUE(all(too_short).empty());
    Crossings backwards(mesh, *sphere.tree, origin, -direction, INFINITY, false);
    EXPECT_TRUE(all(backwards).empty());
  }
  EXPECT_GT(met, 300);
}

TEST_P(RayCrossings, SayWhereTheNodesRanOut) {
  Crossings crossings(mesh, *sphere.tree, middle + Vec3(3, 0.1, 0.2), -Vec3::UnitX(), INFINITY, false);
  RayEffort effort;
  EXPECT_FALSE(crossings.next({2}, effort));
  EXPECT_FALSE(effort.finished);
  EXPECT_EQ(effort.nodes, 2u);
  EXPECT_TRUE(crossings.next({UINT64_MAX}, effort)) << "nothing is lost by that";
  EXPECT_TRUE(effort.finished);
}

INSTANTIATE_TEST_SUITE_P(About, RayCrossings, ::testing::Values(0.0, 1e3, -1e6));

// Weights of corners are nothing but rounding there, and put the crossing anywhere between them.
TEST(WatertightRay, CrossesWhatItSeesEdgeOnWhereItIs) {
  math::Random random(3, 7);
  int crossed = 0;
  for (int round = 0; round < 20000; ++round) {
    const Mat3 turn = random.rotation().toRotationMatrix();
    const Vec3 place = random.direction();
    const bool without_area = round % 2 == 0;
    const Vec3 corners[3] = {place, place + turn * Vec3(without_area ? 0.3 : 0.5, without_area ? 0.0 : 0.7, 0.0),
                             place + turn * Vec3(1.0, 0.0, 0.0)};
    const Vec3 aim = place + turn * Vec3(without_area ? random.uniform() : 0.0, 0.0, 0.0);
    // At a point of the needle from anywhere, or in the triangle's plane past its corner.
    const Vec3 local =
        without_area ? Vec3(random.direction()) : Vec3(Vec3(-0.8, random.uniform(0.6, 2.0), 0.0).normalized());
    const Vec3 direction = (turn * local).normalized();
    const double expected = random.uniform(1.0, 5.0);
    const double distance = primitive::WatertightRay(aim - expected * direction, direction, false).crossing(corners);
    if (distance < 0.0) continue;
    ++crossed;
    ASSERT_NEAR(distance, expected, 1e-9) << round;
  }
  EXPECT_GT(crossed, 1000);
}

TEST(WatertightRay, LetsNoRayThroughFansAndStrips) {
  math::Random random(3, 1);
  for (int round = 0; round < 2000; ++round) {
    // Triangles about a corner that the ray goes through, or nearly: one at least is crossed.
    const Vec3 origin = random.direction();
    const Vec3 corner = 5.0 * random.direction();
    const Vec3 direction = (corner - origin).normalized();
    const Vec3 across = direction.unitOrthogonal();
    const Vec3 up = direction.cross(across);
    constexpr int most = 7;
    Vec3 rim[most];
    for (int i = 0; i < most; ++i) {
      const double angle = (i + 0.6 * random.uniform()) * 2.0 * M_PI / most;
      rim[i] = corner + std::cos(angle) * across + std::sin(angle) * up + random.uniform(-0.3, 0.3) * direction;
    }
    for (const bool front_only : {false, true}) {
      const primitive::WatertightRay ray(origin, direction, front_only);
      int crossed = 0;
      for (int i = 0; i < most; ++i) {
        const Vec3 from_behind[3] = {corner, rim[i], rim[(i + 1) % most]};
        const Vec3 from_front[3] = {corner, rim[(i + 1) % most], rim[i]};
        EXPECT_EQ(ray.crossing(from_behind) >= 0.0, !front_only && ray.crossing(from_front) >= 0.0)
            << "which way it is turned matters where only fronts count";
        const double distance = ray.crossing(from_front);
        if (!(distance >= 0.0)) continue;
        EXPECT_NEAR(distance, (corner - origin).norm(), 1e-9);
        ++crossed;
      }
      EXPECT_GE(crossed, 1);
    }
  }
}

}  // namespace
}  // namespace odds::query
