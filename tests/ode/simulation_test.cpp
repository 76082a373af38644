// End to end: things dropped on things come to rest and stay, 10 s at 1 kHz.
#include <cmath>

#include "ode/world_fixture.hpp"

namespace odds::test {
namespace {

class Simulation : public WorldTest {
 protected:
  void SetUp() override {
    WorldTest::SetUp();
    dWorldSetERP(world, 0.2);
    dWorldSetContactMaxCorrectingVel(world, 0.5);
    dWorldSetContactSurfaceLayer(world, 1e-4);
  }

  dBodyID body_of(dGeomID geom, double x, double y, double z) {
    const dBodyID body = dBodyCreate(world);
    dMass mass;
    dMassSetBoxTotal(&mass, 1.0, 0.2, 0.2, 0.2);
    dBodySetMass(body, &mass);
    dGeomSetBody(geom, body);
    dBodySetPosition(body, x, y, z);
    return body;
  }

  // Runs 10 s; after the first two nothing may move by more than `drift` (metres), turn, or be faster than `speed` at
  // the end.
  void expect_rest(dBodyID body, double height, double drift, double speed = 1e-3) {
    for (int i = 0; i < 2000; ++i) step();
    const Vec3 settled = Vec3(dBodyGetPosition(body)[0], dBodyGetPosition(body)[1], dBodyGetPosition(body)[2]);
    EXPECT_NEAR(settled.z(), height, 5e-4);
    double farthest = 0.0;
    for (int i = 0; i < 8000; ++i) {
      step();
      const dReal* p = dBodyGetPosition(body);
      farthest = std::max(farthest, (Vec3(p[0], p[1], p[2]) - settled).norm());
    }
    EXPECT_LT(farthest, drift);
    const dReal* v = dBodyGetLinearVel(body);
    EXPECT_LT(Vec3(v[0], v[1], v[2]).norm(), speed);
  }

  // The body's own up axis still points up.
  static double tilt_degrees(dBodyID body) {
    return std::acos(std::min(1.0, dBodyGetRotation(body)[10])) * 180.0 / M_PI;
  }
};

TEST_F(Simulation, AMeshBoxOnAPlane) {
  dCreatePlane(space, 0, 0, 1, 0);
  const dBodyID body = body_of(mesh_geom(box_shape(0.2, 0.2, 0.2, 4), space), 0, 0, 0.15);
  expect_rest(body, 0.1, 1e-4);
  EXPECT_LT(tilt_degrees(body), 0.1);
}

TEST_F(Simulation, AMeshBoxOnAMeshFloor) {
  const dGeomID floor = mesh_geom(box_shape(2, 2, 0.2, 8), space);
  const dGeomID box = mesh_geom(box_shape(0.2, 0.2, 0.2, 2), space);
  ASSERT_EQ(oddsPreparePair(floor, box), 1);
  const dBodyID body = body_of(box, 0.07, 0.03, 0.25);
  expect_rest(body, 0.2, 5e-4);
  EXPECT_LT(tilt_degrees(body), 0.2);
}

TEST_F(Simulation, AnOdeBoxOnAMeshFloor) {
  mesh_geom(box_shape(2, 2, 0.2, 8), space);
  const dBodyID body = body_of(dCreateBox(space, 0.2, 0.2, 0.2), 0.07, 0.03, 0.25);
  expect_rest(body, 0.2, 1e-4);
  EXPECT_LT(tilt_degrees(body), 0.1);
}

TEST_F(Simulation, AMeshBoxOnAnOdeBox) {
  const dGeomID table = dCreateBox(space, 2, 2, 0.2);
  dGeomSetPosition(table, 0, 0, 0);
  const dBodyID body = body_of(mesh_geom(box_shape(0.2, 0.2, 0.2, 3), space), 0.07, 0.03, 0.25);
  expect_rest(body, 0.2, 1e-4);
  EXPECT_LT(tilt_degrees(body), 0.1);
}

TEST_F(Simulation, ASphereOnAMeshFloorStaysWhereItFell) {
  mesh_geom(box_shape(2, 2, 0.2, 8), space);
  const dBodyID body = body_of(dCreateSphere(space, 0.1), 0.07, 0.03, 0.25);
  expect_rest(body, 0.2, 1e-4);
}

TEST_F(Simulation, AMeshThatStartsWithinAMeshFloorComesOutAndRestsOnIt) {
  mesh_geom(box_shape(2.0, 2.0, 1.0, 8), space);  // its top at 0.5
  for (const bool comes_first : {false, true}) {
    const dGeomID ball = mesh_geom(sphere_shape(0.05), comes_first ? nullptr : space);
    if (comes_first) {
      dSpaceDestroy(space);
      space = dSimpleSpaceCreate(nullptr);
      dSpaceAdd(space, ball);
      mesh_geom(box_shape(2.0, 2.0, 1.0, 8), space);
    }
    const dBodyID body = body_of(ball, 0.3, 0.2, 0.25);
    for (int i = 0; i < 1500; ++i) step();
    EXPECT_NEAR(dBodyGetPosition(body)[2], 0.55, 2e-3) << "the first of the two: " << comes_first;
    EXPECT_LT(std::abs(dBodyGetLinearVel(body)[2]), 1e-2);
    dGeomDestroy(ball);
  }
}

TEST_F(Simulation, AMeshFasterThanAMeshFloorIsThickComesBack) {
  mesh_geom(box_shape(2.0, 2.0, 0.2, 8), space);  // its top at 0.1
  const dGeomID ball = mesh_geom(sphere_shape(0.02), space);
  const dBodyID body = body_of(ball, 0.1, 0.1, 0.135);
  dBodySetLinearVel(body, 0, 0, -100.0);  // 100 mm a step: from outside to within at once
  step();
  ASSERT_LT(dBodyGetPosition(body)[2], 0.06);
  for (int i = 0; i < 2000; ++i) step();
  EXPECT_NEAR(dBodyGetPosition(body)[2], 0.12, 2e-3);
}

}  // namespace
}  // namespace odds::test
