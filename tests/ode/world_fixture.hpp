// A world of ODE about the geoms of a test.
#pragma once

#include <cstring>

#include "ode/ode_fixture.hpp"

namespace odds::test {

/// Steps of 1 kHz with gravity along -z. What collides gets contacts with `friction`, unless neither has a body.
class WorldTest : public OdeTest {
 protected:
  static constexpr double period = 1e-3;  ///< seconds

  void SetUp() override {
    OdeTest::SetUp();
    world = dWorldCreate();
    joints = dJointGroupCreate(0);
    dWorldSetGravity(world, 0, 0, -9.81);
  }
  void TearDown() override {
    dJointGroupDestroy(joints);
    dWorldDestroy(world);
    OdeTest::TearDown();
  }

  void step() {
    dSpaceCollide(space, this, [](void* data, dGeomID a, dGeomID b) {
      const auto* self = static_cast<WorldTest*>(data);
      if (dGeomGetBody(a) == nullptr && dGeomGetBody(b) == nullptr) return;
      dContact contacts[8];
      const int count = dCollide(a, b, 8, &contacts[0].geom, sizeof(dContact));
      for (int i = 0; i < count; ++i) {
        std::memset(static_cast<void*>(&contacts[i].surface), 0, sizeof contacts[i].surface);
        contacts[i].surface.mode = self->contact_mode;
        contacts[i].surface.mu = self->friction;
        dJointAttach(dJointCreateContact(self->world, self->joints, &contacts[i]), dGeomGetBody(a), dGeomGetBody(b));
      }
    });
    dWorldStep(world, period);
    dJointGroupEmpty(joints);
  }

  dWorldID world = nullptr;
  dJointGroupID joints = nullptr;
  double friction = 0.8;
  int contact_mode = 0;
};

}  // namespace odds::test
