// Contacts held from tick to tick: they move with the bodies, and a body whose budget is short stays where it lies.
#include "ode/held_contacts.hpp"

#include "ode/ode_fixture.hpp"

namespace odds::test {
namespace {

using ode::HeldContacts;

query::Contact contact_at(const Vec3& position, const Vec3& normal, double depth) {
  return {position, normal, depth, 3, 4};
}
math::Pose moved(const Vec3& by) { return {Mat3::Identity(), by}; }

TEST(HeldContacts, DepthFollowsTheBodies) {
  HeldContacts held;
  const query::Contact found[] = {contact_at({0.1, 0.2, 0.5}, -Vec3::UnitZ(), 0.01)};
  held.keep(found, {}, true);
  const auto same = held.at({}, 1.0);
  ASSERT_EQ(same.size(), 1U);
  EXPECT_NEAR(same[0].depth, 0.01, 1e-15);
  EXPECT_NEAR((same[0].position - found[0].position).norm(), 0.0, 1e-15);
  // The normal points into A: B, which stands above, comes 2 mm lower.
  EXPECT_NEAR(held.at(moved({0, 0, -0.002}), 1.0)[0].depth, 0.012, 1e-15);
  EXPECT_NEAR(held.at(moved({0.005, 0, 0.003}), 1.0)[0].depth, 0.007, 1e-15);
  EXPECT_EQ(held.at(moved({0, 0, 0.0115}), 1.0)[0].depth, 0.0) << "parted by a little";
  EXPECT_TRUE(held.at(moved({0, 0, 0.02}), 1.0).empty()) << "parted";
  EXPECT_TRUE(held.at({}, 1.0).empty()) << "let go for good";
  held.keep(found, {}, true);
  EXPECT_TRUE(held.at(moved({0.03, 0, 0}), 1.0).empty()) << "slid off";
}

TEST(HeldContacts, WhatIsKeptTakesThePlaceOfAll) {
  HeldContacts held;
  const query::Contact careful[] = {contact_at({0, 0, 0}, Vec3::UnitZ(), 0.001),
                                    contact_at({0.5, 0, 0}, Vec3::UnitZ(), 0.003)};
  held.keep(careful, {}, true);
  EXPECT_TRUE(held.better_than_rough());
  const auto two = held.at({}, 1.0);
  ASSERT_EQ(two.size(), 2U);
  EXPECT_EQ(two[0].depth, 0.003) << "deepest first";
  EXPECT_EQ(two[0].triangle_a, 3U);
  std::vector<query::Contact> many(20, careful[0]);
  held.keep(many, {}, false);
  EXPECT_FALSE(held.better_than_rough());
  EXPECT_EQ(held.at({}, 1.0).size(), HeldContacts::most);
  held.keep({}, {}, true);
  EXPECT_TRUE(held.at({}, 1.0).empty());
}

TEST(HeldContacts, CareGrowsStale) {
  HeldContacts held;
  const query::Contact careful[] = {contact_at({0, 0, 0}, Vec3::UnitZ(), 0.001)};
  held.keep(careful, {}, true);
  for (int run = 0; run < HeldContacts::most_runs; ++run) {
    EXPECT_TRUE(held.better_than_rough());
    EXPECT_EQ(held.at({}, 1.0).size(), 1U);
  }
  EXPECT_FALSE(held.better_than_rough());
  EXPECT_EQ(held.at({}, 1.0).size(), 1U) << "where there is nothing else";
}

/// A crate falls on a crate; returns how high and how far sideways it ever was.
struct Excursion {
  double highest = 0.0;
  double sideways = 0.0;
};
Excursion drop_crate(dSpaceID space, double budget_us) {
  const dWorldID world = dWorldCreate();
  dWorldSetGravity(world, 0, 0, -9.81);
  const dJointGroupID joints = dJointGroupCreate(0);
  const auto crate = box_shape(1, 1, 1);
  const dGeomID below = mesh_geom(crate, space);
  const dGeomID above = mesh_geom(crate, space);
  const dBodyID body = dBodyCreate(world);
  dMass mass;
  dMassSetBox(&mass, 400.0, 1.0, 1.0, 1.0);
  dBodySetMass(body, &mass);
  dGeomSetBody(above, body);
  dBodySetPosition(body, 0.1, 0.05, 1.2);
  dGeomOddsMeshSetBudget(above, budget_us);
  oddsPreparePair(below, above);
  Excursion excursion;
  for (int step = 0; step < 600; ++step) {
    for (const dContactGeom& geom : collide(below, above, 8)) {
      dContact contact = {};
      contact.geom = geom;
      contact.surface.mode = dContactApprox1;
      contact.surface.mu = 0.6;
      dJointAttach(dJointCreateContact(world, joints, &contact), nullptr, body);
    }
    dWorldQuickStep(world, 0.001);
    dJointGroupEmpty(joints);
    const dReal* at = dBodyGetPosition(body);
    excursion.highest = std::max(excursion.highest, at[2]);
    excursion.sideways = std::max(excursion.sideways, std::hypot(at[0], at[1]));
  }
  dGeomDestroy(above);
  dGeomDestroy(below);
  dJointGroupDestroy(joints);
  dWorldDestroy(world);
  return excursion;
}

class StarvedCrate : public OdeTest {};

TEST_F(StarvedCrate, IsNeverThrown) {
  // True whatever the machine: bodies that get through are another matter, a thrown one goes 20 m and more.
  for (const double budget_us : {1.0, 3.0, 5.0, 8.0, 10.0, 12.0, 15.0, 20.0, 40.0}) {
    for (int repeat = 0; repeat < 4; ++repeat) {
      const Excursion excursion = drop_crate(space, budget_us);
      EXPECT_LT(excursion.highest, 6.0) << budget_us << " us";
      EXPECT_LT(excursion.sideways, 6.0) << budget_us << " us";
    }
  }
}

}  // namespace
}  // namespace odds::test
