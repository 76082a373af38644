// Long bodies that lie across a solid, deeper in than half of what they are thick: out again where they came in.
#include <algorithm>
#include <cmath>
#include <functional>

#include "ode/ode_fixture.hpp"

namespace odds::test {
namespace {

struct Rod {
  const char* name;
  std::function<dGeomID(dSpaceID)> make;  ///< 1 m along z, 0.1 m thick
};

class RodAcrossBeam : public OdeTest, public ::testing::WithParamInterface<Rod> {};

TEST_P(RodAcrossBeam, IsPushedUpNotAlongItself) {
  const dGeomID beam = mesh_geom(box_shape(0.3, 3.0, 0.3, 3), space);
  const dGeomID rod = GetParam().make(space);
  // A capsule's length leaves its caps out: what counts is that it is far longer than the beam is wide.
  for (const double lean : {0.0, 0.03, -0.05}) {
    rotate(rod, Vec3::UnitY(), 0.5 * M_PI + lean);
    for (const double pressed : {0.01, 0.04, 0.06, 0.08, 0.095, 0.12}) {
      dGeomSetPosition(rod, 0.01, 0.03, 0.15 + 0.05 - pressed);
      const auto contacts = collide(rod, beam);
      ASSERT_FALSE(contacts.empty()) << lean << ' ' << pressed;
      expect_sound(contacts, rod, beam);
      for (const dContactGeom& contact : contacts) {
        EXPECT_GT(contact.normal[2], 0.8) << lean << ", pressed in by " << pressed;
        EXPECT_LT(contact.depth, pressed + 0.5 * std::abs(std::sin(lean)) + 0.01) << lean << ' ' << pressed;
      }
    }
  }
}

TEST_P(RodAcrossBeam, ThatFellOnItIsNotThrownAlongItself) {
  for (const double speed : {3.0, 6.0}) {
    for (int start = 0; start < 20; ++start) {
      const dWorldID world = dWorldCreate();
      const dJointGroupID joints = dJointGroupCreate(0);
      dWorldSetGravity(world, 0.0, 0.0, -9.81);
      const dSpaceID scene = dSimpleSpaceCreate(nullptr);
      mesh_geom(box_shape(0.3, 3.0, 0.3), scene);
      const dGeomID rod = GetParam().make(scene);
      const dBodyID body = dBodyCreate(world);
      dMass mass;
      dMassSetCapsule(&mass, 1000.0, 3, 0.05, 1.0);
      dBodySetMass(body, &mass);
      dGeomSetBody(rod, body);
      rotate(rod, Vec3::UnitY(), 0.5 * M_PI);
      dBodySetPosition(body, 0.01, 0.03, 0.15 + 0.05 + 0.001 + 0.003 * start);
      dBodySetLinearVel(body, 0.0, 0.0, -speed);
      struct Scene {
        dWorldID world;
        dJointGroupID joints;
      } both{world, joints};
      const auto touch = [](void* data, dGeomID g1, dGeomID g2) {
        const auto& [in, group] = *static_cast<Scene*>(data);
        std::array<dContact, 8> contacts{};
        const int count = dCollide(g1, g2, 8, &contacts[0].geom, sizeof(dContact));
        for (int i = 0; i < count; ++i) {
          contacts[static_cast<std::size_t>(i)].surface.mode = dContactApprox1;
          contacts[static_cast<std::size_t>(i)].surface.mu = 0.6;
          dJointAttach(dJointCreateContact(in, group, &contacts[static_cast<std::size_t>(i)]), dGeomGetBody(g1),
                       dGeomGetBody(g2));
        }
      };
      double along = 0.0;
      for (int step = 0; step < 25; ++step) {
        dSpaceCollide(scene, &both, touch);
        dWorldQuickStep(world, 0.01);
        dJointGroupEmpty(joints);
        along = std::max(along, std::abs(dBodyGetLinearVel(body)[0]));
      }
      EXPECT_LT(along, 0.5 * speed) << speed << " m/s, start " << start;
      dSpaceDestroy(scene);
      dJointGroupDestroy(joints);
      dWorldDestroy(world);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Bodies, RodAcrossBeam,
                         ::testing::Values(Rod{"capsule", [](dSpaceID s) { return dCreateCapsule(s, 0.05, 1.0); }},
                                           Rod{"cylinder", [](dSpaceID s) { return dCreateCylinder(s, 0.05, 1.0); }},
                                           Rod{"box", [](dSpaceID s) { return dCreateBox(s, 0.1, 0.1, 1.0); }}),
                         [](const auto& tested) { return tested.param.name; });

TEST_F(OdeTest, ACapsuleOfNoLengthThatIsCrossedIsABall) {
  const dGeomID beam = mesh_geom(box_shape(0.3, 3.0, 0.3), space);
  const dGeomID capsule = dCreateCapsule(space, 0.05, 0.0);
  dGeomSetPosition(capsule, 0.0, 0.0, 0.15);
  const auto contacts = collide(capsule, beam);
  ASSERT_FALSE(contacts.empty());
  EXPECT_NEAR(contacts[0].depth, 0.05, 1e-6);
}

}  // namespace
}  // namespace odds::test
