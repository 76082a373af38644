// Which side of a surface a point is on, where the limits end the search for the nearest place.
#include "ode/mesh/nearest_surface.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "odds/math/random.hpp"
#include "odds/mesh/made/icosphere.hpp"
#include "odds/query/shape.hpp"
#include "ode/ode_fixture.hpp"

namespace odds::test {
namespace {

constexpr double anywhere = std::numeric_limits<double>::infinity();

/// A ball some of whose vertices stand far out: thin spikes, of whose faces most face away from a point beside them.
std::shared_ptr<const ode::PreparedMesh> spiky() {
  const mesh::TriangleMesh ball = make(mesh::made::Icosphere{.radius = 1.0, .frequency = 20}).value();
  std::vector<Vec3> corners(ball.vertices().begin(), ball.vertices().end());
  math::Random random(3, 1);
  for (Vec3& corner : corners) {
    if (random.uniform() < 0.15) corner *= 1.0 + random.uniform();
  }
  auto made =
      mesh::TriangleMesh::make(std::move(corners), {ball.triangles().begin(), ball.triangles().end()}, "spiky").value();
  return ode::PreparedMesh::make(
      query::Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(made))).value());
}

TEST(NearestSurface, OfASpikeTheSideIsRightWhereverTheSearchEnds) {
  const auto mesh = spiky();
  math::Random random(5, 1);
  int inside = 0;
  int unfinished = 0;
  for (int round = 0; round < 3000; ++round) {
    const Vec3 point = random.uniform(0.8, 2.0) * random.direction();
    std::uint64_t all = std::numeric_limits<std::uint64_t>::max();
    bool finished = false;
    const auto right = ode::nearest_surface(*mesh, point, anywhere, query::no_feature, {}, 0, {0}, all, finished);
    ASSERT_TRUE(right && finished);
    inside += right->inside ? 1 : 0;
    std::uint64_t few = 4 + random.below(12);
    const auto early = ode::nearest_surface(*mesh, point, anywhere, query::no_feature, {}, 0, {1000}, few, finished);
    unfinished += finished ? 0 : 1;
    if (!early) continue;
    EXPECT_EQ(early->inside, right->inside) << point.transpose();
    EXPECT_GE(early->distance, right->distance * (1.0 - 1e-9));
  }
  EXPECT_GT(inside, 300);
  EXPECT_GT(unfinished, 1000);
}

}  // namespace
}  // namespace odds::test
