// Mesh against cylinder: exact depths on floors in every tilt; standing, lying, on beams; out of boxes; swallowed.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "odds/mesh/made/terrain.hpp"
#include "ode/ode_fixture.hpp"

namespace odds::test {
namespace {

class CylinderTest : public OdeTest {
 protected:
  std::mt19937 random{23};
  std::uniform_real_distribution<double> uniform{-1.0, 1.0};
};

constexpr double radius = 0.1;
constexpr double length = 0.3;

Vec3 axis_of(dGeomID geom) {
  const dReal* r = dGeomGetRotation(geom);
  return {r[2], r[6], r[10]};
}

Vec3 place_of(dGeomID geom) {
  const dReal* p = dGeomGetPosition(geom);
  return {p[0], p[1], p[2]};
}

// How far a cylinder reaches from its centre along a unit vector.
double reach(const Vec3& axis, const Vec3& direction) {
  const double along = std::abs(axis.dot(direction));
  return 0.5 * length * along + radius * std::sqrt(std::max(0.0, 1.0 - along * along));
}

TEST_F(CylinderTest, InEveryTiltItIsAsDeepAsItsLowestPoint) {
  const dGeomID floor = mesh_geom(box_shape(2, 2, 0.4, 16), space);
  const dGeomID cylinder = dCreateCylinder(space, radius, length);
  for (int round = 0; round < 600; ++round) {
    rotate(cylinder, Vec3(uniform(random), uniform(random), uniform(random)), 3.0 * uniform(random));
    const double depth = 0.002 + 0.001 * uniform(random);
    dGeomSetPosition(cylinder, 0.5 * uniform(random), 0.5 * uniform(random),
                     0.2 + reach(axis_of(cylinder), Vec3::UnitZ()) - depth);
    const auto contacts = collide(cylinder, floor);
    ASSERT_FALSE(contacts.empty()) << "round " << round;
    expect_sound(contacts, cylinder, floor);
    // Standing to less than a milliradian, it is held at fixed points of its rim.
    EXPECT_NEAR(contacts[0].depth, depth, 1e-5 * radius) << "round " << round;
    for (const dContactGeom& contact : contacts) {
      EXPECT_NEAR(contact.normal[2], 1.0, 1e-9) << "round " << round;
      EXPECT_LE(contact.depth, depth + 1e-9);
    }
  }
}

TEST_F(CylinderTest, StandingItIsHeldAllAroundTheRim) {
  const dGeomID floor = mesh_geom(box_shape(2, 2, 0.4, 16), space);
  const dGeomID cylinder = dCreateCylinder(space, radius, length);
  for (int round = 0; round < 100; ++round) {
    rotate(cylinder, Vec3(0, 0, 1), 3.0 * uniform(random));
    dGeomSetPosition(cylinder, 0.5 * uniform(random), 0.5 * uniform(random), 0.2 + 0.5 * length - 0.001);
    const auto contacts = collide(cylinder, floor, 4);
    ASSERT_EQ(contacts.size(), 4u);
    Vec3 middle = Vec3::Zero();
    for (const dContactGeom& contact : contacts) {
      EXPECT_NEAR(contact.normal[2], 1.0, 1e-9);
      EXPECT_NEAR(contact.depth, 0.001, 1e-9);
      EXPECT_NEAR((position_of(contact) - place_of(cylinder)).head<2>().norm(), radius, 1e-9);
      middle += 0.25 * position_of(contact);
    }
    EXPECT_LT((middle - place_of(cylinder)).head<2>().norm(), 0.25 * radius) << "spread around the centre";
  }
}

// Its lowest point is beside the table; the deepest one over it is where its rim goes over the table's edge. What was
// cut there by a prism around it, and pulled in, was on the wall, where it had no depth: 1e-15 m instead of
// millimetres.
TEST_F(CylinderTest, LeaningOverAnEdgeItIsAsDeepAsItsRimThere) {
  const dGeomID table = mesh_geom(box_shape(2, 2, 0.4, 3), space);
  dGeomOddsMeshSetCarryMotion(table, 0);  // each collision stands alone
  const dGeomID cylinder = dCreateCylinder(space, radius, length);
  for (int round = 0; round < 1000; ++round) {
    rotate(table, Vec3(uniform(random), uniform(random), uniform(random)), 3.0 * uniform(random));
    const Vec3 axis =
        in_world(table, Vec3(0.025 * (1.0 + uniform(random)), 0.025 * uniform(random), -1.0).normalized());
    dMatrix3 leaning;
    dRFromZAxis(leaning, axis.x(), axis.y(), axis.z());
    dGeomSetRotation(cylinder, leaning);
    const Vec3 center =
        in_world(table, Vec3(1.0 - 0.06 * uniform(random), 0.8 * uniform(random), 0.2 + 0.5 * length - 1e-4));
    dGeomSetPosition(cylinder, center.x(), center.y(), center.z());
    double deepest = 0.0;
    for (int i = 0; i < 20000; ++i) {
      const double angle = 1e-4 * std::numbers::pi * i;
      dVector3 rim;
      dVector3 over;
      dGeomGetRelPointPos(cylinder, radius * std::cos(angle), radius * std::sin(angle), 0.5 * length, rim);
      dGeomGetPosRelPoint(table, rim[0], rim[1], rim[2], over);
      if (over[0] <= 1.0) deepest = std::max(deepest, 0.2 - over[2]);
    }
    if (deepest < 1e-4) continue;
    const auto contacts = collide(table, cylinder);
    ASSERT_FALSE(contacts.empty()) << "round " << round;
    expect_sound(contacts, table, cylinder);
    EXPECT_LT(normal_of(contacts[0]).dot(in_world(table, Vec3::UnitZ())), -0.98) << "round " << round;
    EXPECT_NEAR(contacts[0].depth, deepest, 0.05 * deepest) << "round " << round;
  }
}

// Its lowest point may be over one facet by nearly nothing, while its rim is deep in the next: that was not asked for.
TEST_F(CylinderTest, OnFacetsItIsAsDeepAsItsRimIsOverTheirEdges) {
  const dGeomID ball = mesh_geom(sphere_shape(1.0, 4), space);
  dGeomOddsMeshSetCarryMotion(ball, 0);  // each collision stands alone
  int too_shallow = 0;
  for (int round = 0; round < 3000; ++round) {
    const double r = 0.175 + 0.125 * uniform(random);
    const double l = 0.35 + 0.25 * uniform(random);
    const dGeomID cylinder = dCreateCylinder(nullptr, r, l);
    rotate(cylinder, Vec3(uniform(random), uniform(random), uniform(random)), 3.0 * uniform(random));
    const Vec3 outwards = Vec3(uniform(random), uniform(random), uniform(random)).normalized();
    const auto place = [&](const Vec3& at) { dGeomSetPosition(cylinder, at.x(), at.y(), at.z()); };
    double touches = 0.5;
    double is_apart = 2.0;
    for (int i = 0; i < 30; ++i) {
      const double between = 0.5 * (touches + is_apart);
      place(between * outwards);
      (collide(ball, cylinder, 1).empty() ? is_apart : touches) = between;
    }
    const double pressed = std::pow(10.0, -2.75 + 0.75 * uniform(random));
    const Vec3 at = (touches - pressed) * outwards;
    place(at);
    const auto contacts = collide(ball, cylinder);
    ASSERT_FALSE(contacts.empty()) << round;
    place(at - contacts[0].depth * normal_of(contacts[0]));
    for (const dContactGeom& left : collide(ball, cylinder)) {
      if (left.depth > 0.3 * pressed) {
        ++too_shallow;
        break;
      }
    }
    dGeomDestroy(cylinder);
  }
  EXPECT_EQ(too_shallow, 0);
}

TEST_F(CylinderTest, LyingItIsHeldAtBothEnds) {
  const dGeomID floor = mesh_geom(box_shape(2, 2, 0.4, 16), space);
  const dGeomID cylinder = dCreateCylinder(space, radius, length);
  for (int round = 0; round < 200; ++round) {
    dMatrix3 lie;
    const double angle = 3.1 * uniform(random);
    dRFromZAxis(lie, std::cos(angle), std::sin(angle), 0);
    dGeomSetRotation(cylinder, lie);
    dGeomSetPosition(cylinder, 0.5 * uniform(random), 0.5 * uniform(random), 0.2 + radius - 0.0005);
    const auto contacts = collide(cylinder, floor, 2);
    ASSERT_EQ(contacts.size(), 2u) << "round " << round;
    EXPECT_NEAR((position_of(contacts[0]) - position_of(contacts[1])).norm(), length, 1e-5);
    for (const dContactGeom& contact : contacts) {
      EXPECT_NEAR(contact.normal[2], 1.0, 1e-9);
      EXPECT_NEAR(contact.depth, 0.0005, 0.01 * 0.0005) << "round " << round;
    }
  }
}

TEST_F(CylinderTest, LyingAcrossABeamItIsHeldAtTheBeamsEdges) {
  const dGeomID beam = mesh_geom(box_shape(0.1, 1, 0.1, 2), space);
  const dGeomID cylinder = dCreateCylinder(space, radius, length);
  dMatrix3 lie;
  dRFromZAxis(lie, 1, 0, 0);
  dGeomSetRotation(cylinder, lie);
  dGeomSetPosition(cylinder, 0.02, 0.1, 0.05 + radius - 0.001);
  const auto contacts = collide(cylinder, beam);
  ASSERT_GE(contacts.size(), 2u);
  double least = 1.0;
  double most = -1.0;
  for (const dContactGeom& contact : contacts) {
    EXPECT_NEAR(contact.normal[2], 1.0, 1e-6);
    EXPECT_LE(contact.depth, 0.001 + 1e-9);
    least = std::min(least, static_cast<double>(contact.pos[0]));
    most = std::max(most, static_cast<double>(contact.pos[0]));
  }
  EXPECT_NEAR(contacts[0].depth, 0.001, 1e-9);
  EXPECT_NEAR(least, -0.05, 1e-6);
  EXPECT_NEAR(most, 0.05, 1e-6);
}

TEST_F(CylinderTest, ACornerInItsWallIsPushedOutAlongTheRadius) {
  const dGeomID mesh = mesh_geom(box_shape(1, 1, 1, 2), space);
  const dGeomID cylinder = dCreateCylinder(space, radius, length);
  // Upright beside a vertical edge of the box.
  const double away = std::sqrt(0.5) * (radius - 0.004);
  dGeomSetPosition(cylinder, 0.5 + away, 0.5 + away, 0.1);
  const auto contacts = collide(cylinder, mesh);
  ASSERT_FALSE(contacts.empty());
  EXPECT_NEAR(contacts[0].depth, 0.004, 1e-5);
  for (const dContactGeom& contact : contacts) {
    EXPECT_NEAR(contact.normal[0], std::sqrt(0.5), 1e-3);
    EXPECT_NEAR(contact.normal[1], std::sqrt(0.5), 1e-3);
  }
  // The prism's corner reaches here, the cylinder does not.
  dGeomSetPosition(cylinder, 0.5 + radius * std::cos(M_PI / 16) * 1.01, 0.5 + radius * std::sin(M_PI / 16) * 1.01, 0.1);
  EXPECT_TRUE(collide(cylinder, mesh).empty());
}

// The least overlap of two convex bodies over many directions: what they must at least move to part.
TEST_F(CylinderTest, TheDeepestContactIsTheWayOutOfABox) {
  const Vec3 half(0.4, 0.5, 0.6);
  const dGeomID mesh = mesh_geom(box_shape(0.8, 1.0, 1.2, 2), space);
  const dGeomID cylinder = dCreateCylinder(space, radius, length);
  std::normal_distribution<double> normal;
  int hits = 0;
  int longer = 0;
  for (int round = 0; round < 400; ++round) {
    rotate(cylinder, Vec3(uniform(random), uniform(random), uniform(random)), 3.0 * uniform(random));
    dGeomSetPosition(cylinder, 0.6 * uniform(random), 0.7 * uniform(random), 0.8 * uniform(random));
    const Vec3 center = place_of(cylinder);
    const Vec3 axis = axis_of(cylinder);
    const auto overlap = [&](const Vec3& out) { return out.cwiseAbs().dot(half) + reach(axis, out) - out.dot(center); };
    Vec3 best = Vec3::UnitX();
    for (int i = 0; i < 5000; ++i) {
      const Vec3 out = Vec3(normal(random), normal(random), normal(random)).normalized();
      if (overlap(out) < overlap(best)) best = out;
    }
    for (double step = 0.3; step > 1e-7; step *= 0.9) {
      const Vec3 out = (best + step * Vec3(normal(random), normal(random), normal(random))).normalized();
      if (overlap(out) < overlap(best)) best = out;
    }
    for (int axis_number = 0; axis_number < 3; ++axis_number) {
      for (const double sign : {1.0, -1.0}) {
        const Vec3 out = sign * Vec3::Unit(axis_number);
        if (overlap(out) < overlap(best)) best = out;
      }
    }
    const double least = overlap(best);
    const auto contacts = collide(cylinder, mesh);
    expect_sound(contacts, cylinder, mesh);
    if (least < 0.0) {
      EXPECT_TRUE(contacts.empty()) << "round " << round << ", apart by " << -least;
      continue;
    }
    if (least < 1e-3 || least > 0.05) continue;
    ++hits;
    ASSERT_FALSE(contacts.empty()) << "round " << round << ", overlap " << least << " at " << center.transpose()
                                   << ", axis " << axis.transpose() << ", out " << best.transpose();
    const double along = overlap(normal_of(contacts[0]));
    EXPECT_GE(along, 0.0);
    EXPECT_LE(contacts[0].depth, along + 0.02 * radius + 1e-9) << "bounded by the overlap, round " << round;
    longer += contacts[0].depth > 1.3 * least + 1e-3 || contacts[0].depth < 0.7 * least - 1e-3;
  }
  EXPECT_GT(hits, 50);
  EXPECT_LT(longer, hits / 10);
}

TEST_F(CylinderTest, SwallowedByAClosedMeshItIsPushedOut) {
  const dGeomID mesh = mesh_geom(box_shape(2, 2, 2, 4), space);
  const dGeomID cylinder = dCreateCylinder(space, radius, length);
  dGeomSetPosition(cylinder, 0.1, 0.2, 0.6);
  const auto contacts = collide(cylinder, mesh);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR(contacts[0].normal[2], 1.0, 1e-9);
  EXPECT_NEAR(contacts[0].depth, 0.4 + 0.15, 1e-9);
}

TEST_F(CylinderTest, OnTerrainNoNormalPointsIntoTheGround) {
  mesh::made::Terrain hills;
  hills.cells = 48;
  const dGeomID terrain = mesh_geom(shape_of(hills), space);
  const dGeomID cylinder = dCreateCylinder(space, 0.05, 0.1);
  int seen = 0;
  for (int round = 0; round < 300; ++round) {
    rotate(cylinder, Vec3(uniform(random), uniform(random), uniform(random)), 3.0 * uniform(random));
    dGeomSetPosition(cylinder, 0.8 * uniform(random), 0.8 * uniform(random), 0.1 * uniform(random));
    const auto contacts = collide(terrain, cylinder);
    expect_sound(contacts, terrain, cylinder);
    for (const dContactGeom& contact : contacts) {
      ++seen;
      EXPECT_LT(contact.normal[2], 0.0) << "round " << round;
      EXPECT_LE(contact.depth, 0.15) << "at most the cylinder's diagonal";
    }
  }
  EXPECT_GT(seen, 200);
}

TEST_F(CylinderTest, AnExhaustedBudgetIsCountedAndSound) {
  const dGeomID mesh = mesh_geom(sphere_shape(1, 20), space);
  const dGeomID cylinder = dCreateCylinder(space, 0.5, 1);
  dGeomSetPosition(cylinder, 1.2, 0, 0);
  ASSERT_EQ(dGeomOddsMeshSetWorkBudget(mesh, 2), 1);
  expect_sound(collide(mesh, cylinder), mesh, cylinder);
  EXPECT_EQ(stats().primitive_cut_off, 1u);
}

}  // namespace
}  // namespace odds::test
