// Bodies on surfaces of triangles much smaller than they are: of the many in the body's box few are in the body.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "math/rotation_between.hpp"
#include "ode/known_convexes.hpp"
#include "ode/ode_fixture.hpp"

namespace odds::test {
namespace {

constexpr double radius = 0.3;

class FineMeshTest : public OdeTest {
 protected:
  void SetUp() override {
    OdeTest::SetUp();
    floor = mesh_geom(box_shape(2, 2, 1, 100), space);  // its top is at z = 0, of triangles of 2 cm
    dGeomSetPosition(floor, 0, 0, -0.5);
    dGeomOddsMeshSetCarryMotion(floor, 0);
  }
  // `lowest`: of the body so turned, as far below its centre.
  std::vector<dContactGeom> put(dGeomID body, const Quat& turn, double lowest, double depth) {
    const dQuaternion q = {turn.w(), turn.x(), turn.y(), turn.z()};
    dGeomSetQuaternion(body, q);
    const double y = 0.3 * uniform(random);  // one after the other: compilers differ in the order of arguments
    const double x = 0.3 * uniform(random);
    dGeomSetPosition(body, x, y, -lowest - depth);
    return collide(body, floor, 8);
  }
  static void expect_floor(const std::vector<dContactGeom>& contacts, double depth) {
    ASSERT_FALSE(contacts.empty());
    double deepest = 0.0;
    for (const dContactGeom& contact : contacts) {
      EXPECT_NEAR(contact.normal[2], 1.0, 1e-9) << "nothing else pushes on a floor";
      EXPECT_NEAR(contact.pos[2], 0.0, 1e-9);
      deepest = std::max(deepest, contact.depth);
    }
    EXPECT_NEAR(deepest, depth, 1e-3 * depth);
  }
  Quat any_turn() {
    const double z = normal(random);
    const double y = normal(random);
    const double x = normal(random);
    const double w = normal(random);
    return Quat(w, x, y, z).normalized();
  }

  dGeomID floor = nullptr;
  std::mt19937 random{41};
  std::uniform_real_distribution<double> uniform{-1.0, 1.0};
  std::normal_distribution<double> normal;
};

// Triangles beside the cylinder took the places of those in it: a fifth of those that lay had no contact at all.
TEST_F(FineMeshTest, ACylinderLiesAndStandsOnItsRim) {
  const dGeomID cylinder = dCreateCylinder(space, radius, 0.6);
  for (const double depth : {0.001, 0.01, 0.05}) {
    for (int round = 0; round < 20; ++round) {
      const Quat about(Eigen::AngleAxisd(3.0 * uniform(random), Vec3::UnitZ()));
      const Quat lies(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitX()));
      expect_floor(put(cylinder, about * lies, -radius, depth), depth);
      const Quat leans(Eigen::AngleAxisd(0.6, Vec3::UnitX()));
      expect_floor(put(cylinder, about * leans, -radius * std::sin(0.6) - 0.3 * std::cos(0.6), depth), depth);
    }
  }
}

TEST_F(FineMeshTest, AConvexBallRests) {
  const ConvexBall ball(space, radius, 16, 8);
  for (const double depth : {0.001, 0.01, 0.05}) {
    for (int round = 0; round < 20; ++round) {
      const Quat turn = any_turn();
      expect_floor(put(ball.geom, turn, ball.lowest(turn), depth), depth);
    }
  }
}

// One cut by its 960 sides took longer than the budget, and what was cut was not in it: it fell.
TEST_F(FineMeshTest, InShortTimeAConvexOfManySidesIsHeld) {
  const ConvexBall ball(space, radius, 60, 16);
  const SlowLooks slow(500);
  for (const double budget_us : {2.0, 5.0, 20.0, 50.0}) {
    ASSERT_EQ(dGeomOddsMeshSetBudget(floor, budget_us), 1);
    for (int round = 0; round < 50; ++round) {
      const Quat turn = any_turn();
      const double depth = round % 2 == 0 ? 0.01 : 0.05;
      const auto contacts = put(ball.geom, turn, ball.lowest(turn), depth);
      ASSERT_FALSE(contacts.empty()) << "within " << budget_us << " us";
      for (const dContactGeom& contact : contacts) {
        EXPECT_NEAR(contact.normal[2], 1.0, 1e-9);
        EXPECT_NEAR(contact.pos[2], 0.0, 1e-9);
        EXPECT_LE(contact.depth, depth * (1.0 + 1e-6));
      }
    }
  }
}

// Where some of the surface was left out, the ways through it seemed the shortest, and a corner went sideways.
TEST_F(FineMeshTest, ACornerOfABoxIsPushedUp) {
  const dGeomID box = dCreateBox(space, 2 * radius, 2 * radius, 2 * radius);
  for (const double depth : {0.001, 0.01, 0.05, 0.1}) {
    for (int round = 0; round < 20; ++round) {
      const Quat turn = any_turn();
      const double lowest = -radius * turn.toRotationMatrix().row(2).cwiseAbs().sum();
      const auto contacts = put(box, turn, lowest, depth);
      ASSERT_FALSE(contacts.empty());
      if (turn.toRotationMatrix().row(2).cwiseAbs().minCoeff() < 0.3) continue;  // a flat one has as short a way out
      expect_floor(contacts, depth);
    }
  }
}

// The solid of box_shape with its top raised by `height(x, y)`.
template <class Height>
std::shared_ptr<const query::Shape> ground(double width, std::uint32_t cells, const Height& height) {
  const mesh::TriangleMesh flat = make(mesh::made::Box{.x = width, .y = width, .z = 1, .cells = cells}).value();
  std::vector<Vec3> corners(flat.vertices().begin(), flat.vertices().end());
  for (Vec3& corner : corners) corner.z() += corner.z() > 0.499 ? height(corner.x(), corner.y()) : 0.0;
  std::vector<mesh::Triangle> triangles(flat.triangles().begin(), flat.triangles().end());
  return query::Shape::build(std::make_shared<const mesh::TriangleMesh>(
                                 mesh::TriangleMesh::make(std::move(corners), std::move(triangles)).value()))
      .value();
}

// Bumps make patches that face several ways; the way common to them led through what was left out.
TEST_F(FineMeshTest, ACornerOfABoxIsPushedUpByBumps) {
  const auto bumps = [](double x, double y) { return 0.02 * std::sin(60.0 * x) * std::sin(60.0 * y); };
  const dGeomID bumpy = mesh_geom(ground(1.2, 120, bumps), space);
  dGeomSetPosition(bumpy, 0, 0, -0.5);
  dGeomOddsMeshSetCarryMotion(bumpy, 0);
  const dGeomID box = dCreateBox(space, 2 * radius, 2 * radius, 2 * radius);
  int sideways = 0;
  for (int round = 0; round < 200; ++round) {
    const Quat turn = any_turn();
    const double lowest = -radius * turn.toRotationMatrix().row(2).cwiseAbs().sum();
    dGeomSetQuaternion(box, std::array<dReal, 4>{turn.w(), turn.x(), turn.y(), turn.z()}.data());
    const double y = 0.3 * uniform(random);
    const double x = 0.3 * uniform(random);
    dGeomSetPosition(box, x, y, -lowest - 0.05);
    const auto contacts = collide(box, bumpy, 8);
    ASSERT_FALSE(contacts.empty());
    sideways += contacts.front().normal[2] < 0.5 ? 1 : 0;
  }
  EXPECT_EQ(sideways, 0) << "of 200";
}

// Between two walls of 45 degrees, x = z and x = -z, of triangles of 3 to 5 cm.
std::shared_ptr<const query::Shape> groove() {
  constexpr std::uint32_t cells = 60;
  std::vector<Vec3> corners;
  std::vector<mesh::Triangle> triangles;
  for (std::uint32_t i = 0; i <= cells; ++i) {
    for (std::uint32_t k = 0; k <= cells; ++k) {
      const double x = 2.0 * i / cells - 1.0;
      corners.emplace_back(x, 2.0 * k / cells - 1.0, std::abs(x));
      if (i == cells || k == cells) continue;
      const std::uint32_t a = i * (cells + 1) + k;
      const std::uint32_t b = a + cells + 1;
      triangles.push_back({a, b, b + 1});
      triangles.push_back({a, b + 1, a + 1});
    }
  }
  return query::Shape::build(std::make_shared<const mesh::TriangleMesh>(
                                 mesh::TriangleMesh::make(std::move(corners), std::move(triangles)).value()))
      .value();
}

// Their boxes have more triangles than there is room for; one wall alone held them.
TEST_F(FineMeshTest, BallsAndCapsulesTouchBothWallsOfAGroove) {
  const dGeomID walls = mesh_geom(groove(), space);
  const dGeomID ball = dCreateSphere(space, radius);
  const dGeomID capsule = dCreateCapsule(space, radius, 0.4);
  rotate(capsule, Vec3::UnitX(), 0.5 * std::numbers::pi);
  for (const dGeomID body : {ball, capsule}) {
    dGeomSetPosition(body, 0, 0.003, radius * std::sqrt(2.0) - 0.001);
    bool left = false;
    bool right = false;
    for (const dContactGeom& contact : collide(body, walls)) {
      EXPECT_NEAR(contact.depth, 0.001 * std::sqrt(0.5), 1e-9);
      left = left || contact.normal[0] > 0.7;
      right = right || contact.normal[0] < -0.7;
    }
    EXPECT_TRUE(left && right) << "class " << dGeomGetClass(body);
  }
  EXPECT_EQ(stats().primitive_cut_off, 0u);
}

// The nearest triangle was asked for after hundreds of others, when the time was up.
TEST_F(FineMeshTest, InShortTimeACapsuleThatLiesIsHeld) {
  const dGeomID capsule = dCreateCapsule(space, radius, 0.6);
  const SlowLooks slow(200);
  ASSERT_EQ(dGeomOddsMeshSetBudget(floor, 60.0), 1);
  for (int round = 0; round < 50; ++round) {
    const Quat about(Eigen::AngleAxisd(3.0 * uniform(random), Vec3::UnitZ()));
    const Quat lies(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitX()));
    expect_floor(put(capsule, about * lies, -radius, 0.01), 0.01);
  }
}

// The crossing was found, and lost where nothing nearer was.
TEST_F(FineMeshTest, ACapsuleAcrossTheSurfaceHasAContactHoweverEarlyItsSearchEnds) {
  const dGeomID solid = mesh_geom(sphere_shape(1.0, 60), space);
  const dGeomID capsule = dCreateCapsule(space, 0.02, 1.2);
  dGeomOddsMeshSetCarryMotion(solid, 0);
  for (std::uint64_t units = 9; units < 200; ++units) {
    ASSERT_EQ(dGeomOddsMeshSetWorkBudget(solid, units), 1);
    const Vec3 out = any_turn() * Vec3::UnitZ();
    const Quat turn = math::rotation_between(Vec3::UnitZ(), out);
    const dQuaternion q = {turn.w(), turn.x(), turn.y(), turn.z()};
    dGeomSetQuaternion(capsule, q);
    dGeomSetPosition(capsule, out.x(), out.y(), out.z());  // one half is inside
    const auto contacts = collide(capsule, solid);
    ASSERT_FALSE(contacts.empty()) << units << " units";
    if (units < 12) continue;  // a triangle beside that which the axis goes through may be all that was seen
    EXPECT_GT(normal_of(contacts[0]).dot(out), 0.9) << units << " units";
    EXPECT_NEAR(contacts[0].depth, 0.62, 0.02);
  }
  dGeomOddsMeshSetWorkBudget(solid, 0);
  for (double microseconds = 2.0; microseconds < 40.0; microseconds += 0.25) {
    const SlowLooks slow(100);
    ASSERT_EQ(dGeomOddsMeshSetBudget(solid, microseconds), 1);
    EXPECT_FALSE(collide(capsule, solid).empty()) << microseconds << " us";
  }
}

// What is nearest to the middle of a plate that leans is beside it: with some ten nodes for all, nothing else was seen.
TEST_F(FineMeshTest, APlateThatLeansHasAContactHoweverEarlyItsSearchEnds) {
  const auto lean_into_floor = [&](dGeomID plate, const Vec3& half) {
    const Quat about(Eigen::AngleAxisd(3.0 * uniform(random), Vec3::UnitZ()));
    const Quat turn = about * Quat(Eigen::AngleAxisd(0.6 + 0.4 * uniform(random), Vec3::UnitX()));
    return put(plate, turn, -turn.toRotationMatrix().row(2).cwiseAbs().dot(half), 0.08);
  };
  const Vec3 thick(0.4, 0.4, 0.04);
  const Vec3 thin(0.4, 0.4, 0.01);
  const dGeomID thick_plate = dCreateBox(space, 2.0 * thick.x(), 2.0 * thick.y(), 2.0 * thick.z());
  const dGeomID thin_plate = dCreateBox(space, 2.0 * thin.x(), 2.0 * thin.y(), 2.0 * thin.z());
  // Fewer units do not always reach a triangle that is in the plate: 24 did not in 171 of 2,000 poses, 44 not in 1.
  for (std::uint64_t units = 45; units < 100; ++units) {
    ASSERT_EQ(dGeomOddsMeshSetWorkBudget(floor, units), 1);
    for (int i = 0; i < 5; ++i) EXPECT_FALSE(lean_into_floor(thick_plate, thick).empty()) << units << " units";
  }
  dGeomOddsMeshSetWorkBudget(floor, 0);
  for (double microseconds = 5.0; microseconds < 30.0; microseconds += 0.5) {
    const SlowLooks slow(150);  // about one at each node
    ASSERT_EQ(dGeomOddsMeshSetBudget(floor, microseconds), 1);
    for (int i = 0; i < 5; ++i) EXPECT_FALSE(lean_into_floor(thick_plate, thick).empty()) << microseconds << " us";
    if (microseconds < 8.0) continue;  // then 10 of 240 had none
    for (int i = 0; i < 5; ++i) EXPECT_FALSE(lean_into_floor(thin_plate, thin).empty()) << microseconds << " us, thin";
  }
}

TEST_F(FineMeshTest, WhatAShortTimeEndedIsCounted) {
  const dGeomID solid = mesh_geom(sphere_shape(1.0, 60), space);
  dGeomOddsMeshSetCarryMotion(solid, 0);
  const SlowLooks slow(700);
  ASSERT_EQ(dGeomOddsMeshSetBudget(solid, 2.0), 1);
  for (const dGeomID body : {dCreateBox(space, 0.1, 0.1, 0.1), dCreateCylinder(space, 0.05, 0.1),
                             dCreateCapsule(space, 0.05, 0.1), dCreateSphere(space, 0.05)}) {
    dGeomSetPosition(body, 0.05, 0.02, 0.03);  // all of the surface is nearly as far
    oddsResetStats();
    EXPECT_EQ(collide(body, solid).size() > 0, true) << "class " << dGeomGetClass(body);
    EXPECT_EQ(stats().primitive_cut_off, 1u) << "class " << dGeomGetClass(body);
  }
}

// Neighbours in the tree are often of one side: then the way through the plate's breadth seemed the shortest.
TEST_F(FineMeshTest, APlateOfManyTrianglesIsLeftAtItsSide) {
  const dGeomID plate = mesh_geom(box_shape(1.0, 1.0, 0.004, 80), space);
  dGeomOddsMeshSetCarryMotion(plate, 0);
  const Vec3 half(0.15, 0.1, 0.2);
  const dGeomID box = dCreateBox(space, 2.0 * half.x(), 2.0 * half.y(), 2.0 * half.z());
  for (int round = 0; round < 300; ++round) {
    const Quat turn = any_turn();
    const dQuaternion q = {turn.w(), turn.x(), turn.y(), turn.z()};
    dGeomSetQuaternion(box, q);
    const double z = 0.05 * uniform(random);
    const double y = 0.25 * uniform(random);
    const double x = 0.25 * uniform(random);
    dGeomSetPosition(box, x, y, z);
    const auto contacts = collide(box, plate);
    ASSERT_FALSE(contacts.empty());
    const double reach = turn.toRotationMatrix().row(2).cwiseAbs().dot(half);
    EXPECT_LE(contacts[0].depth, 1.35 * (reach - std::abs(z)) + 0.005) << "round " << round;
  }
}

// Of a shape with other bounding volumes a wide tree is built beside it.
TEST_F(FineMeshTest, OtherBoundingVolumesGiveTheSameContacts) {
  const auto mesh =
      std::make_shared<const mesh::TriangleMesh>(make(mesh::made::Icosphere{.radius = 1.0, .frequency = 20}).value());
  const dGeomID wide = mesh_geom(query::Shape::build(mesh).value(), space);
  const dGeomID other = mesh_geom(query::Shape::build(mesh, {.volume = volume::Kind::obb}).value(), space);
  for (const dGeomID body :
       {dCreateBox(space, 0.3, 0.2, 0.1), dCreateCapsule(space, 0.1, 0.2), dCreateSphere(space, 0.2)}) {
    for (int round = 0; round < 20; ++round) {
      const Vec3 place = any_turn() * Vec3(0.0, 0.0, 1.02);
      dGeomSetPosition(body, place.x(), place.y(), place.z());
      const auto contacts = collide(body, wide);
      const auto same = collide(body, other);
      ASSERT_EQ(contacts.size(), same.size());
      ASSERT_FALSE(contacts.empty());
      for (std::size_t i = 0; i < same.size(); ++i) EXPECT_EQ(position_of(contacts[i]), position_of(same[i]));
    }
  }
}

}  // namespace
}  // namespace odds::test
