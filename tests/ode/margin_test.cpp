// A margin around meshes: contacts of what has come apart by less, which let it come nearer and no faster.
#include <cmath>
#include <limits>

#include "odds/math/types.hpp"
#include "ode_fixture.hpp"

namespace odds::test {
namespace {

constexpr double margin = 2e-4;
constexpr double step_s = 1e-3;

class Margin : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(oddsInitODE(0), 1);
    space = dSimpleSpaceCreate(nullptr);
    ground = mesh_geom(box_shape(0.4, 0.4, 0.1, 4), space);
    brick = mesh_geom(box_shape(0.1, 0.1, 0.1, 2), space);
    dGeomSetPosition(ground, 0, 0, -0.05);
  }
  void TearDown() override {
    dSpaceDestroy(space);
    oddsCloseODE();
  }
  void lift(double gap) const { dGeomSetPosition(brick, 0.003, 0.002, 0.05 + gap); }

  dSpaceID space = nullptr;
  dGeomID ground = nullptr;
  dGeomID brick = nullptr;
};

TEST_F(Margin, IsNoneUnlessSetAndRefusesWhatIsNoLength) {
  EXPECT_EQ(dGeomOddsMeshGetMargin(brick), 0);
  EXPECT_EQ(dGeomOddsMeshSetMargin(brick, margin), 1);
  for (const dReal bad : {-1e-9, std::nan(""), dInfinity}) EXPECT_EQ(dGeomOddsMeshSetMargin(brick, bad), 0);
  EXPECT_EQ(dGeomOddsMeshGetMargin(brick), margin);
}

TEST_F(Margin, OfEitherGeomCountsInEitherOrder) {
  for (const dGeomID with : {brick, ground}) {
    dGeomOddsMeshSetMargin(with, margin);
    lift(-1e-5);
    ASSERT_GE(collide(brick, ground).size(), 4U);
    lift(1e-4);
    for (const bool swapped : {false, true}) {
      const auto contacts = swapped ? collide(ground, brick) : collide(brick, ground);
      ASSERT_FALSE(contacts.empty());
      EXPECT_NEAR(contacts[0].depth, -1e-4, 1e-12);
      EXPECT_NEAR(contacts[0].normal[2], swapped ? -1.0 : 1.0, 1e-6) << "into the first";
    }
    oddsAnswer answer;
    ASSERT_EQ(oddsGetLastAnswer(brick, ground, &answer), 1);
    EXPECT_EQ(answer.verdict, ODDS_CLEAR);
    EXPECT_GE(answer.contacts, 1);
    dGeomOddsMeshSetMargin(with, 0);
    EXPECT_TRUE(collide(brick, ground).empty());
  }
}

TEST_F(Margin, WidensTheBoxSoThatASpaceAsksInTime) {
  dReal before[6];
  lift(0.0);
  dGeomGetAABB(brick, before);
  dGeomOddsMeshSetMargin(brick, margin);
  lift(0.0);
  dReal after[6];
  dGeomGetAABB(brick, after);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(after[2 * axis], before[2 * axis] - margin, 1e-15);
    EXPECT_NEAR(after[2 * axis + 1], before[2 * axis + 1] + margin, 1e-15);
  }
}

TEST(MakeSpeculative, ChangesOnlyContactsThatAreApart) {
  dContact contact{};
  contact.geom.depth = 1e-3;
  oddsMakeSpeculative(&contact, step_s);
  EXPECT_EQ(contact.surface.mode, 0);
  contact.geom.depth = -1e-4;
  for (const dReal bad : {0.0, -1.0, std::nan("")}) oddsMakeSpeculative(&contact, bad);
  EXPECT_EQ(contact.surface.mode, 0);
  oddsMakeSpeculative(&contact, step_s);
  EXPECT_EQ(contact.surface.mode, dContactMotionN);
  EXPECT_NEAR(contact.surface.motionN, -0.1, 1e-15);
  contact.surface.motionN = 0.3;
  oddsMakeSpeculative(&contact, step_s);
  EXPECT_NEAR(contact.surface.motionN, 0.2, 1e-15) << "a motion of its own stays";
  oddsMakeSpeculative(nullptr, step_s);
}

/// What a brick of 1 kg comes to when it is let go at some height and pressed down.
class BrickUnderLoad : public Margin {
 protected:
  void SetUp() override {
    Margin::SetUp();
    world = dWorldCreate();
    dWorldSetGravity(world, 0, 0, -100);
    const dBodyID body = dBodyCreate(world);
    dMass mass;
    dMassSetBoxTotal(&mass, 1.0, 0.1, 0.1, 0.1);
    dBodySetMass(body, &mass);
    dGeomSetBody(brick, body);
    joints = dJointGroupCreate(0);
  }
  void TearDown() override {
    dJointGroupDestroy(joints);
    dWorldDestroy(world);  // before ODE is closed
    Margin::TearDown();
  }
  /// Lowest gap in so many steps.
  double fall(double from, int steps, double with) {
    dGeomOddsMeshSetMargin(brick, with);
    lift(from);
    dBodySetLinearVel(dGeomGetBody(brick), 0, 0, 0);
    double lowest = from;
    for (int i = 0; i < steps; ++i) {
      for (const dContactGeom& found : collide(brick, ground)) {
        dContact contact{};
        contact.geom = found;
        contact.surface.mu = 0.5;
        oddsMakeSpeculative(&contact, step_s);
        dJointAttach(dJointCreateContact(world, joints, &contact), dGeomGetBody(found.g1), dGeomGetBody(found.g2));
      }
      dWorldQuickStep(world, step_s);
      dJointGroupEmpty(joints);
      lowest = std::min(lowest, static_cast<double>(dGeomGetPosition(brick)[2]) - 0.05);
    }
    return lowest;
  }

  dWorldID world = nullptr;
  dJointGroupID joints = nullptr;
};

TEST_F(BrickUnderLoad, ThatLosesItsContactsIsNotDropped) {
  EXPECT_LT(fall(1e-9, 1, 0.0), -0.9e-4) << "one step's fall: 100 m/s^2 * (1 ms)^2";
  dGeomOddsMeshSetMargin(brick, margin);
  lift(-1e-6);
  ASSERT_GE(collide(brick, ground).size(), 4U) << "it has stood there";
  EXPECT_GT(fall(1e-9, 20, margin), -2e-6);
}

}  // namespace
}  // namespace odds::test
