// A mesh at rest against a box, cylinder or convex keeps its contacts, as two meshes do.
#include "ode/geom/resting_contacts.hpp"

#include <cmath>
#include <memory>

#include "ode/partners_fixture.hpp"

namespace odds::test {
namespace {

/// A brick of 768 triangles, 0.1 mm deep in what lies below z = 0.
class Resting : public OdeTest {
 protected:
  static constexpr double depth = 1e-4;
  static constexpr double size = 0.59;                 ///< of the brick, about
  static constexpr double motion = 0.5 * 1e-5 * size;  ///< less than what is carried over
  static constexpr std::array<const char*, 3> bodies{"box", "cylinder", "convex"};

  void SetUp() override {
    OdeTest::SetUp();
    brick = mesh_geom(box_shape(0.2, 0.5, 0.248, 8), space);
    put(0.0);
  }
  void TearDown() override {
    for (const dGeomID geom : registered) oddsForgetGeom(geom);
    OdeTest::TearDown();
  }
  /// A body whose top is at z = 0.
  dGeomID below(const std::string& kind) {
    dGeomID geom = nullptr;
    if (kind == "box") geom = dCreateBox(space, 2, 2, 0.5);
    if (kind == "cylinder") geom = dCreateCylinder(space, 1.0, 0.5);
    if (kind == "convex") {
      geom = dCreateConvex(space, planes.data(), 6, points.data(), 8, polygons.data());
      EXPECT_EQ(oddsRegisterConvex(geom, points.data(), 8, polygons.data(), 6), 1) << oddsGetLastError();
      registered.push_back(geom);
    }
    dGeomSetPosition(geom, 0.03, 0.02, -0.25);
    return geom;
  }
  void put(double higher, double aside = 0.0) { dGeomSetPosition(brick, aside, 0, 0.124 - depth + higher); }
  /// Whether contacts are made anew: there is no work for that.
  bool are_made_anew(dGeomID body) {
    dGeomOddsMeshSetWorkBudget(brick, 4);
    const auto before = stats().primitive_cut_off;
    static_cast<void>(collide(brick, body));
    dGeomOddsMeshSetWorkBudget(brick, 0);
    return stats().primitive_cut_off > before;
  }

  dGeomID brick = nullptr;
  std::vector<dGeomID> registered;
  std::array<dReal, 24> points{-1, -1, -0.25, 1, -1, -0.25, -1, 1, -0.25, 1, 1, -0.25,
                               -1, -1, 0.25,  1, -1, 0.25,  -1, 1, 0.25,  1, 1, 0.25};
  std::array<dReal, 24> planes{-1, 0, 0, 1, 1, 0, 0, 1, 0, -1, 0, 1, 0, 1, 0, 1, 0, 0, -1, 0.25, 0, 0, 1, 0.25};
  std::array<unsigned, 30> polygons{4, 0, 4, 6, 2, 4, 1, 3, 7, 5, 4, 0, 1, 5, 4,
                                    4, 2, 6, 7, 3, 4, 0, 2, 3, 1, 4, 4, 5, 7, 6};
};

TEST_F(Resting, KeepsItsContactsWithEveryConvexBody) {
  for (const char* kind : bodies) {
    SCOPED_TRACE(kind);
    const dGeomID body = below(kind);
    put(0.0);
    const auto made = collide(brick, body);
    ASSERT_GE(made.size(), 4u);
    EXPECT_FALSE(are_made_anew(body));
    put(-motion, 0.3 * motion);
    EXPECT_FALSE(are_made_anew(body));
    const auto carried = collide(brick, body);
    expect_sound(carried, brick, body);
    ASSERT_EQ(carried.size(), made.size());
    for (std::size_t i = 0; i < made.size(); ++i) {
      EXPECT_NEAR(carried[i].depth, made[i].depth + motion, 1e-12);
      EXPECT_NEAR(carried[i].pos[2], made[i].pos[2] - motion, 1e-12) << "on the brick's own surface";
      EXPECT_LE((position_of(carried[i]) - position_of(made[i])).head<2>().norm(), 0.3 * motion + 1e-12);
      EXPECT_LE((normal_of(carried[i]) - normal_of(made[i])).norm(), 1e-12);
      EXPECT_EQ(carried[i].side1, made[i].side1);
    }
    dGeomDisable(body);
    dGeomSetPosition(body, 0, 0, -100);
  }
}

// A face of 128 triangles and the walls beside it are more than there is room for, but not more than there is time for.
TEST_F(Resting, KeepsContactsOfManyTrianglesWithinTheUsualBudget) {
  const SlowLooks usual(30);
  ASSERT_EQ(dGeomOddsMeshSetBudget(brick, 100.0), 1);
  for (const char* kind : bodies) {
    const dGeomID body = below(kind);
    ASSERT_FALSE(collide(brick, body).empty());
    EXPECT_FALSE(are_made_anew(body)) << kind;
    dGeomDisable(body);
    dGeomSetPosition(body, 0, 0, -100);
  }
}

TEST_F(Resting, IsAskedAboutInBothOrders) {
  const dGeomID box = below("box");
  ASSERT_FALSE(collide(brick, box).empty());
  const auto turned = collide(box, brick);
  EXPECT_FALSE(are_made_anew(box));
  expect_sound(turned, box, brick);
  for (const dContactGeom& contact : turned) EXPECT_NEAR(contact.normal[2], -1.0, 1e-9);
}

TEST_F(Resting, MakesThemAnewIfNothingIsToBeCarried) {
  const dGeomID box = below("box");
  dGeomOddsMeshSetCarryMotion(brick, 0);
  ASSERT_FALSE(collide(brick, box).empty());
  EXPECT_TRUE(are_made_anew(box));
}

TEST_F(Resting, CreepingAddsUp) {
  const dGeomID box = below("box");
  static_cast<void>(collide(brick, box));
  put(0.0, motion);
  EXPECT_FALSE(are_made_anew(box));
  put(0.0, 2.0 * motion + 1e-6 * size);
  EXPECT_TRUE(are_made_anew(box));
}

TEST_F(Resting, WhatHasPartedIsClear) {
  const dGeomID box = below("box");
  put(depth - 0.1 * motion);
  ASSERT_FALSE(collide(brick, box).empty());
  put(depth + 0.1 * motion);
  EXPECT_TRUE(collide(brick, box).empty());
  put(depth - 0.1 * motion);
  EXPECT_FALSE(collide(brick, box).empty());
}

TEST_F(Resting, ABodyOfAnotherSizeOrShapeIsAnotherQuestion) {
  const dGeomID box = below("box");
  static_cast<void>(collide(brick, box));
  dGeomBoxSetLengths(box, 2, 0.2, 0.5);
  EXPECT_TRUE(are_made_anew(box));
  for (const dContactGeom& contact : collide(brick, box)) EXPECT_LE(std::abs(contact.pos[1] - 0.02), 0.1 + 1e-9);

  const dGeomID convex = below("convex");
  static_cast<void>(collide(brick, convex));
  EXPECT_FALSE(are_made_anew(convex));
  ASSERT_EQ(oddsRegisterConvex(convex, points.data(), 8, polygons.data(), 6), 1);
  EXPECT_TRUE(are_made_anew(convex));

  EXPECT_EQ(collide(brick, convex, 2).size(), 2u) << "fewer contacts are another question, too";
}

TEST_F(Resting, WhatWasCutOffIsNotCarried) {
  const dGeomID box = below("box");
  EXPECT_TRUE(are_made_anew(box));
  EXPECT_TRUE(are_made_anew(box));
}

TEST_F(Resting, MorePartnersThanAreKeptHaveTheirContactsToo) {
  std::vector<dGeomID> boxes;
  for (std::size_t i = 0; i < ode::RestingContacts::most_partners + 4; ++i) {
    const dGeomID box = dCreateBox(space, 0.02, 0.4, 0.5);
    dGeomSetPosition(box, -0.09 + 0.009 * static_cast<double>(i), 0, -0.25);
    boxes.push_back(box);
  }
  for (int round = 0; round < 3; ++round) {
    put(1e-8 * round);
    for (const dGeomID box : boxes) {
      const auto contacts = collide(brick, box);
      ASSERT_GE(contacts.size(), 4u);
      for (const dContactGeom& contact : contacts) {
        EXPECT_EQ(contact.g2, box);
        EXPECT_NEAR(contact.depth, depth - 1e-8 * round, 1e-12);
        EXPECT_LE(std::abs(contact.pos[0] - dGeomGetPosition(box)[0]), 0.01 + 1e-9);
      }
    }
  }
  EXPECT_FALSE(are_made_anew(boxes.back()));
}

}  // namespace
}  // namespace odds::test
