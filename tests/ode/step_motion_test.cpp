// Where geoms stood before a step of the world.
#include "ode/step_motion.hpp"

#include "ode/ode_fixture.hpp"
#include "ode/vectors.hpp"

namespace odds::test {
namespace {

class StepMotion : public OdeTest {
 protected:
  void SetUp() override {
    OdeTest::SetUp();
    geom = mesh_geom(sphere_shape(1.0, 12), space);
  }
  [[nodiscard]] math::Pose pose() const {
    return {ode::matrix_of(dGeomGetRotation(geom)), ode::vector_of(dGeomGetPosition(geom))};
  }
  dGeomID geom = nullptr;
};

TEST_F(StepMotion, GoesBackByTheBodysVelocities) {
  const dWorldID world = dWorldCreate();
  const dBodyID body = dBodyCreate(world);
  dGeomSetBody(geom, body);
  dGeomSetOffsetPosition(geom, 0.3, 0.0, 0.1);
  dBodySetPosition(body, 1.0, 2.0, 3.0);
  dBodySetLinearVel(body, 5.0, -1.0, 0.5);
  dBodySetAngularVel(body, 0.5, 20.0, -3.0);
  dBodySetFiniteRotationMode(body, 1);
  dWorldSetGravity(world, 0.0, 0.0, -9.81);
  for (const double step_s : {1e-3, 1e-4}) {
    const math::Pose before = pose();
    dWorldStep(world, step_s);
    const math::Pose back = ode::before_step(geom, pose(), step_s);
    EXPECT_NEAR((back.translation - before.translation).norm(), 0.0, 1e-9) << step_s;
    EXPECT_NEAR((back.rotation - before.rotation).norm(), 0.0, 1e-9) << step_s;
    EXPECT_GT((pose().translation - before.translation).norm(), 4.0 * step_s);
  }
  dWorldDestroy(world);
}

TEST_F(StepMotion, AGeomWithoutABodyStaysWhereItIs) {
  dGeomSetPosition(geom, 1.0, 2.0, 3.0);
  EXPECT_EQ(ode::before_step(geom, pose(), 1e-3).translation, Vec3(1.0, 2.0, 3.0));
}

}  // namespace
}  // namespace odds::test
