// Mesh against ray: every triangle one by one as reference; ODE's three options; edges, lengths, contacts' rules.
#include <algorithm>
#include <cmath>
#include <random>

#include "odds/mesh/made/torus_knot.hpp"
#include "ode/ode_fixture.hpp"

namespace odds::test {
namespace {

class RayTest : public OdeTest {
 protected:
  dGeomID ray_of(double length, const Vec3& origin, const Vec3& direction) {
    const dGeomID ray = dCreateRay(space, length);
    dGeomRaySet(ray, origin.x(), origin.y(), origin.z(), direction.x(), direction.y(), direction.z());
    return ray;
  }
  std::mt19937 random{31};
  std::uniform_real_distribution<double> uniform{-1.0, 1.0};
};

struct Crossing {
  double distance;
  std::size_t triangle;
  bool front;
};

// Solves origin + t d = a + u (b - a) + v (c - a) for each triangle.
std::vector<Crossing> brute_force(const mesh::TriangleMesh& mesh, const Vec3& origin, const Vec3& direction,
                                  double length) {
  std::vector<Crossing> found;
  for (std::size_t t = 0; t < mesh.triangles().size(); ++t) {
    const mesh::Triangle& corner = mesh.triangles()[t];
    const Vec3 a = mesh.vertices()[corner[0]];
    Mat3 system;
    system << mesh.vertices()[corner[1]] - a, mesh.vertices()[corner[2]] - a, -direction;
    if (std::abs(system.determinant()) < 1e-14) continue;
    const Vec3 solution = system.inverse() * (origin - a);
    const bool in = solution[0] >= 0 && solution[1] >= 0 && solution[0] + solution[1] <= 1;
    if (!in || solution[2] < 0 || solution[2] > length) continue;
    found.push_back({solution[2], t, system.col(0).cross(system.col(1)).dot(direction) < 0});
  }
  std::sort(found.begin(), found.end(), [](const Crossing& x, const Crossing& y) { return x.distance < y.distance; });
  return found;
}

TEST_F(RayTest, EveryCrossingIsFoundNearestFirst) {
  const auto shape = shape_of(mesh::made::TorusKnot{});
  const dGeomID mesh = mesh_geom(shape, space);
  const double size = shape->mesh().size();
  const dGeomID ray = ray_of(3.0 * size, Vec3::Zero(), Vec3::UnitX());
  std::size_t crossings = 0;
  for (int round = 0; round < 400; ++round) {
    const Vec3 origin = size * Vec3(uniform(random), uniform(random), uniform(random));
    const Vec3 aim = 0.3 * size * Vec3(uniform(random), uniform(random), uniform(random));
    const Vec3 direction = (aim - origin).normalized();
    dGeomRaySet(ray, origin.x(), origin.y(), origin.z(), direction.x(), direction.y(), direction.z());
    for (const bool cull : {false, true}) {
      dGeomRaySetBackfaceCull(ray, cull);
      auto expected = brute_force(shape->mesh(), origin, direction, 3.0 * size);
      if (cull) std::erase_if(expected, [](const Crossing& c) { return !c.front; });
      const auto contacts = collide(ray, mesh, 64);
      expect_sound(contacts, ray, mesh);
      ASSERT_EQ(contacts.size(), expected.size()) << "round " << round;
      crossings += expected.size();
      for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_NEAR(contacts[i].depth, expected[i].distance, 1e-9);
        EXPECT_EQ(contacts[i].side1, -1);
        EXPECT_EQ(contacts[i].side2, static_cast<int>(expected[i].triangle));
        EXPECT_LT((position_of(contacts[i]) - origin - expected[i].distance * direction).norm(), 1e-9);
        EXPECT_EQ(normal_of(contacts[i]).dot(direction) < 0.0, expected[i].front) << "the face's own normal";
      }
      dGeomRaySetClosestHit(ray, 1);
      const auto closest = collide(mesh, ray, 64);
      dGeomRaySetClosestHit(ray, 0);
      ASSERT_EQ(closest.size(), std::min<std::size_t>(1, expected.size()));
      if (closest.empty()) continue;
      EXPECT_NEAR(closest[0].depth, expected[0].distance, 1e-9);
      EXPECT_LT((normal_of(closest[0]) + normal_of(contacts[0])).norm(), 1e-12) << "the other order";
    }
  }
  EXPECT_GT(crossings, 300u);
}

TEST_F(RayTest, FirstContactAndOneAskedGiveOne) {
  const dGeomID mesh = mesh_geom(box_shape(1, 1, 1, 2), space);
  const dGeomID ray = ray_of(10, Vec3(0.1, 0.2, 5), Vec3(0, 0, -1));
  EXPECT_EQ(collide(ray, mesh).size(), 2u);
  EXPECT_EQ(collide(ray, mesh, 1).size(), 1u);
  dGeomRaySetFirstContact(ray, 1);
  EXPECT_EQ(collide(ray, mesh).size(), 1u);
}

TEST_F(RayTest, ItAnswersLikeOdesRayAndBox) {
  const dGeomID mesh = mesh_geom(box_shape(0.8, 1.0, 1.2, 3), space);
  const dGeomID box = dCreateBox(space, 0.8, 1.0, 1.2);
  const dGeomID ray = ray_of(2.0, Vec3::Zero(), Vec3::UnitX());
  dGeomRaySetClosestHit(ray, 1);
  int hits = 0;
  for (int round = 0; round < 500; ++round) {
    const Vec3 origin = 2.0 * Vec3(uniform(random), uniform(random), uniform(random));
    const Vec3 direction = (0.5 * Vec3(uniform(random), uniform(random), uniform(random)) - origin).normalized();
    if ((origin.cwiseAbs() - Vec3(0.4, 0.5, 0.6)).maxCoeff() < 0.0) continue;  // ODE's box is solid for rays
    dGeomRaySet(ray, origin.x(), origin.y(), origin.z(), direction.x(), direction.y(), direction.z());
    const auto ours = collide(ray, mesh);
    const auto odes = collide(ray, box);
    ASSERT_EQ(ours.size(), odes.size()) << "round " << round;
    if (ours.empty()) continue;
    ++hits;
    EXPECT_NEAR(ours[0].depth, odes[0].depth, 1e-9);
    EXPECT_LT((normal_of(ours[0]) - normal_of(odes[0])).norm(), 1e-9);
    EXPECT_LT((position_of(ours[0]) - position_of(odes[0])).norm(), 1e-9);
  }
  EXPECT_GT(hits, 200);
}

TEST_F(RayTest, NoneSlipsThroughEdgesAndCorners) {
  const dGeomID mesh = mesh_geom(box_shape(1, 1, 1, 8), space);
  const dGeomID ray = ray_of(10, Vec3::Zero(), Vec3::UnitX());
  for (int i = -3; i <= 3; ++i) {
    for (int j = -3; j <= 3; ++j) {
      dGeomRaySet(ray, 0.125 * i, 0.125 * j, 3, 0, 0, -1);  // through vertices of the tessellation
      const auto contacts = collide(ray, mesh);
      ASSERT_EQ(contacts.size(), 2u) << i << ", " << j;
      EXPECT_NEAR(contacts[0].depth, 2.5, 1e-12);
      EXPECT_NEAR(contacts[1].depth, 3.5, 1e-12);
      const Vec3 skew = (Vec3(0.125 * i, 0.125 * j, 0.5) - Vec3(0.3, 0.7, 2.9)).normalized();
      dGeomRaySet(ray, 0.3, 0.7, 2.9, skew.x(), skew.y(), skew.z());
      EXPECT_EQ(collide(ray, mesh).size(), 2u) << i << ", " << j;
    }
  }
}

// As programs write them where an edge of a face has a corner of another in its middle.
TEST_F(RayTest, TrianglesWithoutAnAreaHideNone) {
  auto made = mesh::TriangleMesh::make({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 0}},
                                       {{0, 4, 2}, {0, 2, 2}, {0, 1, 2}, {0, 2, 3}});
  ASSERT_TRUE(made.ok());
  const dGeomID mesh = mesh_geom(
      query::Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(made).value())).value(), space);
  for (int i = 0; i < 1000; ++i) {
    const double x = 0.5 + 0.49 * uniform(random);
    const Vec3 direction = Vec3(0.3 * uniform(random), 0.3 * uniform(random), -1).normalized();
    const dGeomID ray = ray_of(5, Vec3(x, x, 0) - 2.0 * direction, direction);
    const auto contacts = collide(ray, mesh);
    ASSERT_EQ(contacts.size(), 1u) << x;
    EXPECT_NEAR(contacts[0].normal[2], 1.0, 1e-12) << x;
    EXPECT_NEAR(contacts[0].depth, 2.0, 1e-12) << x;
    dGeomDestroy(ray);
  }
}

TEST_F(RayTest, ItEndsAtItsLengthAndStartsAtItsOrigin) {
  const dGeomID mesh = mesh_geom(box_shape(1, 1, 1), space);
  const dGeomID ray = ray_of(1.4, Vec3(0.1, 0.2, 2), Vec3(0, 0, -1));
  EXPECT_TRUE(collide(ray, mesh).empty());
  dGeomRaySetLength(ray, 1.6);
  EXPECT_EQ(collide(ray, mesh).size(), 1u);
  dGeomRaySet(ray, 0.1, 0.2, 0, 0, 0, -1);
  const auto from_inside = collide(ray, mesh);
  ASSERT_EQ(from_inside.size(), 1u);
  EXPECT_NEAR(from_inside[0].depth, 0.5, 1e-12);
  EXPECT_NEAR(from_inside[0].normal[2], -1.0, 1e-12) << "out of the mesh, not against the ray";
  dGeomRaySetBackfaceCull(ray, 1);
  EXPECT_TRUE(collide(ray, mesh).empty());
}

TEST_F(RayTest, AMovedMeshIsMetWhereItIs) {
  const dGeomID mesh = mesh_geom(box_shape(1, 1, 1), space);
  rotate(mesh, Vec3(0, 0, 1), M_PI / 4);
  dGeomSetPosition(mesh, 10, 0, 0);
  const dGeomID ray = ray_of(100, Vec3::Zero(), Vec3(1, 0.01, 0).normalized());
  dGeomRaySetClosestHit(ray, 1);
  const auto contacts = collide(ray, mesh);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR(contacts[0].normal[0], -std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(contacts[0].normal[1], std::sqrt(0.5), 1e-9);
}

// One search took 3 microseconds and more without a look, of rays with 5 to spend.
TEST_F(RayTest, LooksAtTheClockOnTheWay) {
  const auto shape = shape_of(mesh::made::TorusKnot{.along = 600, .across = 50});
  const dGeomID mesh = mesh_geom(shape, space);
  ASSERT_EQ(dGeomOddsMeshSetBudget(mesh, 1e6), 1);
  const Vec3 corner = shape->mesh().vertices()[0];
  const dGeomID ray = ray_of(4.0 * shape->mesh().size(), Vec3::Zero(), Vec3::UnitX());
  for (int i = 0; i < 100; ++i) {
    const Vec3 direction = Vec3(uniform(random), uniform(random), uniform(random)).normalized();
    const Vec3 origin = corner - 2.0 * shape->mesh().size() * direction;
    dGeomRaySet(ray, origin.x(), origin.y(), origin.z(), direction.x(), direction.y(), direction.z());
    const SlowLooks looks(100);
    const std::size_t crossings = collide(mesh, ray).size();
    EXPECT_GT(looks.clock.readings(), 5 * static_cast<std::int64_t>(crossings + 1)) << i;
  }
}

TEST_F(RayTest, AnExhaustedBudgetIsCounted) {
  const dGeomID mesh = mesh_geom(sphere_shape(1, 20), space);
  const dGeomID ray = ray_of(100, Vec3(0, 0, 5), Vec3(0, 0.01, -1).normalized());
  ASSERT_EQ(dGeomOddsMeshSetWorkBudget(mesh, 2), 1);
  expect_sound(collide(mesh, ray), mesh, ray);
  EXPECT_EQ(stats().primitive_cut_off, 1u);
  ASSERT_EQ(dGeomOddsMeshSetMaxContacts(mesh, 0), 1);
  EXPECT_TRUE(collide(mesh, ray).empty());
}

}  // namespace
}  // namespace odds::test
