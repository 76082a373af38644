// Mesh against capsule: exact distances to a box; lying, standing, in corners, through sheets, swallowed.
#include <algorithm>
#include <cmath>
#include <random>

#include "odds/math/pose.hpp"
#include "odds/mesh/made/terrain.hpp"
#include "ode/ode_fixture.hpp"

namespace odds::test {
namespace {

class CapsuleTest : public OdeTest {
 protected:
  std::mt19937 random{21};
  std::uniform_real_distribution<double> uniform{-1.0, 1.0};
};

Vec3 axis_of(dGeomID geom) {
  const dReal* r = dGeomGetRotation(geom);
  return {r[2], r[6], r[10]};
}

Vec3 place_of(dGeomID geom) {
  const dReal* p = dGeomGetPosition(geom);
  return {p[0], p[1], p[2]};
}

// The least distance between a segment and a solid box at the origin: a convex function along the segment.
double distance_to_box(const Vec3& begin, const Vec3& end, const Vec3& half) {
  const auto at = [&](double s) { return ((begin + s * (end - begin)).cwiseAbs() - half).cwiseMax(0.0).norm(); };
  double from = 0.0;
  double to = 1.0;
  for (int i = 0; i < 200; ++i) {
    const double a = from + (to - from) / 3.0;
    const double b = to - (to - from) / 3.0;
    (at(a) < at(b) ? to : from) = at(a) < at(b) ? b : a;
  }
  return std::min({at(from), at(0.0), at(1.0)});
}

TEST_F(CapsuleTest, TheDeepestContactIsAsDeepAsTheDistanceOfTheAxisSays) {
  const Vec3 half(0.4, 0.5, 0.6);
  const dGeomID mesh = mesh_geom(box_shape(0.8, 1.0, 1.2, 4), space);
  const double radius = 0.25;
  const double length = 0.7;
  const dGeomID capsule = dCreateCapsule(space, radius, length);
  int hits = 0;
  for (int round = 0; round < 1000; ++round) {
    rotate(capsule, Vec3(uniform(random), uniform(random), uniform(random)), 3.0 * uniform(random));
    dGeomSetPosition(capsule, 1.2 * uniform(random), 1.2 * uniform(random), 1.2 * uniform(random));
    const Vec3 arm = 0.5 * length * axis_of(capsule);
    const double distance = distance_to_box(place_of(capsule) - arm, place_of(capsule) + arm, half);
    const auto contacts = collide(capsule, mesh);
    ASSERT_EQ(contacts.empty(), distance >= radius) << "round " << round << ", distance " << distance;
    expect_sound(contacts, capsule, mesh);
    if (contacts.empty() || distance < 1e-3) continue;
    ++hits;
    EXPECT_NEAR(contacts[0].depth, radius - distance, 1e-9) << "round " << round;
    // Along the normal the deepest point of the capsule lies `depth` behind the contact's place.
    const Vec3 n = normal_of(contacts[0]);
    const double lowest = n.dot(place_of(capsule)) - std::abs(n.dot(arm)) - radius;
    EXPECT_NEAR(n.dot(position_of(contacts[0])) - lowest, contacts[0].depth, 0.5 * length) << "round " << round;
    for (const dContactGeom& contact : contacts) EXPECT_LE(contact.depth, contacts[0].depth + 1e-12);
  }
  EXPECT_GT(hits, 200);
}

TEST_F(CapsuleTest, LyingOnATessellatedFloorItIsHeldAtBothEnds) {
  const dGeomID floor = mesh_geom(box_shape(2, 2, 0.2, 16), space);
  const dGeomID capsule = dCreateCapsule(space, 0.1, 0.4);
  for (int round = 0; round < 300; ++round) {
    dMatrix3 lie;
    const double angle = 3.1 * uniform(random);
    const double tilt = 0.01 * uniform(random);
    dRFromZAxis(lie, std::cos(angle), std::sin(angle), tilt);
    dGeomSetRotation(capsule, lie);
    const double lift = 0.2 * std::abs(axis_of(capsule).z());
    dGeomSetPosition(capsule, 0.5 * uniform(random), 0.5 * uniform(random), 0.1 + 0.1 - 0.003 + lift - 0.001);
    const auto contacts = collide(capsule, floor);
    ASSERT_GE(contacts.size(), 2u) << "round " << round;
    expect_sound(contacts, capsule, floor);
    EXPECT_NEAR(contacts[0].depth, 0.004, 1e-9) << "round " << round;
    for (const dContactGeom& contact : contacts) {
      EXPECT_NEAR(contact.normal[2], 1.0, 1e-9) << "round " << round;
      EXPECT_NEAR(contact.pos[2], 0.1, 1e-9);
    }
    if (2.0 * lift < 0.0035) {
      EXPECT_NEAR((position_of(contacts[0]) - position_of(contacts[1])).norm(), 0.4, 0.01) << "round " << round;
      EXPECT_NEAR(contacts[1].depth, 0.004 - 2.0 * lift, 1e-9) << "round " << round;
    }
  }
}

// All along it is as near to the table, but for rounding: the nearest place was often at its inner end, and none at the
// table's edge.
TEST_F(CapsuleTest, LyingOverAnEdgeItIsHeldThereAndAtItsInnerEnd) {
  const dGeomID table = mesh_geom(box_shape(2, 2, 0.4, 3), space);
  dGeomOddsMeshSetCarryMotion(table, 0);  // each collision stands alone
  const dGeomID capsule = dCreateCapsule(space, 0.1, 0.6);
  for (int round = 0; round < 300; ++round) {
    rotate(table, Vec3(uniform(random), uniform(random), uniform(random)), 3.0 * uniform(random));
    const Vec3 along = Vec3(1.0, 0.5 * uniform(random), 1e-4 * uniform(random)).normalized();
    const Vec3 axis = in_world(table, along);
    dMatrix3 lying;
    dRFromZAxis(lying, axis.x(), axis.y(), axis.z());
    dGeomSetRotation(capsule, lying);
    const Vec3 middle(0.95 + 0.1 * uniform(random), 0.5 * uniform(random), 0.299);
    const Vec3 center = in_world(table, middle);
    dGeomSetPosition(capsule, center.x(), center.y(), center.z());
    const auto contacts = collide(table, capsule);
    expect_sound(contacts, table, capsule);
    for (const double at : {-0.3, (1.0 - middle.x()) / along.x()}) {  // from the middle, along the axis
      const Vec3 on_axis = middle + at * along;
      const Vec3 place = in_world(table, Vec3(on_axis.x(), on_axis.y(), 0.2));
      const double depth = 0.3 - on_axis.z();
      const auto holds = [&](const dContactGeom& contact) {
        return (position_of(contact) - place).norm() < 1e-3 && std::abs(contact.depth - depth) < 1e-6;
      };
      EXPECT_TRUE(std::any_of(contacts.begin(), contacts.end(), holds)) << "round " << round << ", at " << at;
    }
  }
}

TEST_F(CapsuleTest, StandingItHasOneContact) {
  const dGeomID floor = mesh_geom(box_shape(2, 2, 0.2, 16), space);
  const dGeomID capsule = dCreateCapsule(space, 0.1, 0.4);
  for (int step = 0; step < 100; ++step) {
    dGeomSetPosition(capsule, -0.5 + 0.01 * step, 0.125, 0.1 + 0.2 + 0.1 - 0.002);
    const auto contacts = collide(floor, capsule);
    ASSERT_EQ(contacts.size(), 1u) << "step " << step;
    EXPECT_NEAR(contacts[0].normal[2], -1.0, 1e-9);
    EXPECT_NEAR(contacts[0].depth, 0.002, 1e-9);
  }
}

TEST_F(CapsuleTest, ThroughTheFloorItIsPushedOutAsFarAsItsLowerEndIsDeep) {
  const dGeomID floor = mesh_geom(box_shape(4, 4, 2, 8), space);
  const dGeomID plane = dCreatePlane(nullptr, 0, 0, 1, 1);
  const dGeomID capsule = dCreateCapsule(space, 0.05, 0.6);
  int pierced = 0;
  for (int round = 0; round < 300; ++round) {
    rotate(capsule, Vec3(uniform(random), uniform(random), 0), 1.2 * uniform(random));
    dGeomSetPosition(capsule, 0.3 * uniform(random), 0.3 * uniform(random), 1.0 + 0.2 * uniform(random));
    const auto contacts = collide(capsule, floor);
    const auto reference = collide(capsule, plane);
    ASSERT_EQ(contacts.empty(), reference.empty()) << "round " << round;
    if (contacts.empty()) continue;
    double deepest = 0.0;
    for (const dContactGeom& each : reference) deepest = std::max(deepest, each.depth);
    EXPECT_NEAR(contacts[0].depth, deepest, 1e-9) << "round " << round;
    for (const dContactGeom& contact : contacts) EXPECT_NEAR(contact.normal[2], 1.0, 1e-9) << "round " << round;
    pierced += deepest > 0.05 && deepest < 0.6;
  }
  EXPECT_GT(pierced, 100);
  dGeomDestroy(plane);
}

TEST_F(CapsuleTest, SwallowedByAClosedMeshItIsPushedToTheNearestFace) {
  const dGeomID mesh = mesh_geom(box_shape(4, 4, 4, 4), space);
  const dGeomID capsule = dCreateCapsule(space, 0.1, 0.4);
  dGeomSetPosition(capsule, 0.1, 0.2, 1.5);
  const auto contacts = collide(capsule, mesh);
  ASSERT_EQ(contacts.size(), 2u) << "both ends of one way";
  EXPECT_NEAR(contacts[0].depth, 0.5 + 0.2 + 0.1, 1e-9);
  for (const dContactGeom& contact : contacts) EXPECT_NEAR(contact.normal[2], 1.0, 1e-9);
}

TEST_F(CapsuleTest, ThroughASheetItGoesBackToTheSideOfItsMiddle) {
  mesh::made::Terrain flat;
  flat.height = 0.0;
  flat.cells = 10;
  const dGeomID sheet = mesh_geom(shape_of(flat), space);
  const dGeomID capsule = dCreateCapsule(space, 0.05, 0.4);
  for (const double side : {1.0, -1.0}) {
    dGeomSetPosition(capsule, 0.03, 0.04, side * 0.12);
    const auto contacts = collide(capsule, sheet);
    ASSERT_EQ(contacts.size(), 1u) << "one end is behind the sheet";
    EXPECT_NEAR(contacts[0].normal[2], side, 1e-9);
    EXPECT_NEAR(contacts[0].depth, 0.08 + 0.05, 1e-9);
  }
}

TEST_F(CapsuleTest, AcrossARidgeItHasOneContactAndInACornerTwoNormals) {
  const dGeomID mesh = mesh_geom(box_shape(1, 1, 1, 3), space);
  const dGeomID capsule = dCreateCapsule(space, 0.1, 0.8);
  dMatrix3 along;
  dRFromZAxis(along, 1, 0, -1);
  dGeomSetRotation(capsule, along);
  const double away = std::sqrt(0.5) * 0.09;
  dGeomSetPosition(capsule, 0.5 + away, 0.1, 0.5 + away);
  const auto ridge = collide(capsule, mesh);
  ASSERT_EQ(ridge.size(), 1u);
  EXPECT_NEAR(ridge[0].depth, 0.01, 1e-9);
  EXPECT_NEAR(ridge[0].normal[0], std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(ridge[0].normal[2], std::sqrt(0.5), 1e-9);

  const dGeomID wall = mesh_geom(box_shape(1, 1, 1, 3), space);
  dGeomSetPosition(wall, 1.0, 0.0, 1.0);  // its lower left edge meets the other's upper right edge
  dGeomSetPosition(mesh, 0.0, 0.0, 0.0);
  dRFromZAxis(along, 0, 1, 0);
  dGeomSetRotation(capsule, along);
  dGeomSetPosition(capsule, 0.5 - 0.098, 0.0, 0.5 + 0.097);
  const auto on_floor = collide(capsule, mesh);
  ASSERT_GE(on_floor.size(), 2u);
  for (const dContactGeom& contact : on_floor) {
    EXPECT_NEAR(contact.normal[2], 1.0, 1e-9);
    EXPECT_NEAR(contact.depth, 0.003, 1e-9);
  }
  const auto at_wall = collide(capsule, wall);
  ASSERT_GE(at_wall.size(), 2u);
  for (const dContactGeom& contact : at_wall) {
    EXPECT_NEAR(contact.normal[0], -1.0, 1e-9);
    EXPECT_NEAR(contact.depth, 0.002, 1e-9);
  }
}

TEST_F(CapsuleTest, ManyTrianglesAreCutOffAndCountedYetTheDeepestIsExact) {
  const dGeomID capsule = dCreateCapsule(space, 0.2, 0.8);
  dMatrix3 lie;
  dRFromZAxis(lie, 1, 0.3, 0);
  dGeomSetRotation(capsule, lie);
  dGeomSetPosition(capsule, 0.013, 0.017, 0.1 + 0.199);
  // Of the finer floor more triangles than there is room for are within the capsule, of the other one only in its box.
  for (const std::uint32_t cells : {60u, 240u}) {
    const dGeomID floor = mesh_geom(box_shape(2, 2, 0.2, cells), space);
    const auto contacts = collide(capsule, floor);
    EXPECT_EQ(stats().primitive_cut_off, cells > 60 ? 1u : 0u);
    ASSERT_GE(contacts.size(), 2u);
    for (const dContactGeom& contact : contacts) {
      EXPECT_NEAR(contact.normal[2], 1.0, 1e-9);
      EXPECT_NEAR(contact.depth, 0.001, 1e-9);
    }
  }
}

TEST_F(CapsuleTest, OnTerrainContactsAreSound) {
  mesh::made::Terrain hills;
  hills.cells = 48;
  hills.depth = 0.5;
  const dGeomID terrain = mesh_geom(shape_of(hills), space);
  const dGeomID capsule = dCreateCapsule(space, 0.05, 0.1);
  int seen = 0;
  for (int round = 0; round < 500; ++round) {
    rotate(capsule, Vec3(uniform(random), uniform(random), uniform(random)), 3.0 * uniform(random));
    dGeomSetPosition(capsule, 0.8 * uniform(random), 0.8 * uniform(random), 0.1 * uniform(random));
    const auto contacts = collide(capsule, terrain);
    expect_sound(contacts, capsule, terrain);
    for (const dContactGeom& contact : contacts) {
      ++seen;
      EXPECT_GT(contact.normal[2], 0.0) << "round " << round;
      EXPECT_LE(contact.depth, 0.5) << "round " << round;
    }
  }
  EXPECT_GT(seen, 200);
}

TEST_F(CapsuleTest, BadPosesAndSmallBudgetsAreCounted) {
  const dGeomID mesh = mesh_geom(sphere_shape(1, 20), space);
  const dGeomID capsule = dCreateCapsule(nullptr, 0.5, 1.0);
  dGeomSetPosition(capsule, 1.2, 0, 0);
  ASSERT_EQ(dGeomOddsMeshSetWorkBudget(mesh, 2), 1);
  expect_sound(collide(mesh, capsule), mesh, capsule);
  EXPECT_EQ(stats().primitive_cut_off, 1u);
  dGeomSetPosition(capsule, NAN, 0, 0);
  EXPECT_TRUE(collide(mesh, capsule).empty());
  EXPECT_EQ(stats().bad_poses, 1u);
  dGeomDestroy(capsule);
}

// At corners one of several triangles, as near as each other but for rounding, said on which side the axis was.
TEST_F(CapsuleTest, MovedWithItsMeshItHasTheSameContacts) {
  std::vector<Vec3> vertices;
  const auto ball = sphere_shape(1.0, 5);
  for (const Vec3& v : ball->mesh().vertices()) {
    vertices.push_back(v * (1.0 + 0.2 * std::sin(5.0 * v.x()) * std::sin(7.0 * v.y()) + 0.3 * uniform(random)));
  }
  auto bumpy = mesh::TriangleMesh::make(vertices, {ball->mesh().triangles().begin(), ball->mesh().triangles().end()});
  const dGeomID mesh = mesh_geom(
      query::Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(bumpy).value())).value(), space);
  const dGeomID capsule = dCreateCapsule(space, 0.2, 0.6);
  const auto place = [](dGeomID geom, const math::Pose& pose) {
    dMatrix3 rotation = {};
    for (int i = 0; i < 9; ++i) rotation[4 * (i / 3) + i % 3] = pose.rotation(i / 3, i % 3);
    dGeomSetRotation(geom, rotation);
    dGeomSetPosition(geom, pose.translation.x(), pose.translation.y(), pose.translation.z());
  };
  const auto any_pose = [&](double reach) {
    const Vec3 axis = Vec3(uniform(random), uniform(random), 1.5).normalized();
    return math::Pose{Eigen::AngleAxisd(3.0 * uniform(random), axis).toRotationMatrix(),
                      reach * Vec3(uniform(random), uniform(random), uniform(random))};
  };
  for (int round = 0; round < 4000; ++round) {
    const math::Pose pose = any_pose(1.2);
    const math::Pose moved = any_pose(10.0);
    place(mesh, {});
    place(capsule, pose);
    const auto before = collide(mesh, capsule);
    place(mesh, moved);
    place(capsule, moved * pose);
    const auto after = collide(mesh, capsule);
    ASSERT_EQ(before.size(), after.size()) << round;
    for (std::size_t i = 0; i < before.size(); ++i) ASSERT_NEAR(before[i].depth, after[i].depth, 1e-9) << round;
  }
}

// More triangles are near than there is room for; the axis goes through two of them, and one is the shorter way out.
TEST_F(CapsuleTest, ThroughAFinePlateItTakesTheShorterWayOut) {
  const dGeomID plate = mesh_geom(box_shape(2, 2, 0.1, 40), space);
  ASSERT_EQ(dGeomOddsMeshSetBudget(plate, 1e9), 1);
  const dGeomID capsule = dCreateCapsule(space, 0.3, 1.0);
  for (int round = 0; round < 300; ++round) {
    const double tilt = 0.15 + 0.15 * uniform(random);
    const double height = (round % 2 == 0 ? 1.0 : -1.0) * (0.2 + 0.1 * uniform(random));
    rotate(capsule, Vec3(uniform(random), uniform(random), 0), tilt);
    dGeomSetPosition(capsule, 0.5 * uniform(random), 0.5 * uniform(random), height);
    const auto contacts = collide(plate, capsule);
    expect_sound(contacts, plate, capsule);
    ASSERT_FALSE(contacts.empty()) << round;
    EXPECT_NEAR(contacts[0].depth, 0.05 + 0.5 * std::cos(tilt) + 0.3 - std::abs(height), 1e-9) << round;
  }
}

// The axis cuts an edge off. It is not pushed until its far end is over the plane of the face that it leaves first.
TEST_F(CapsuleTest, WhoseAxisGoesInOverAnEdgeIsAsDeepAsItIsThere) {
  const dGeomID box = mesh_geom(box_shape(1, 1, 1, 4), space);
  const double radius = 0.05;
  for (const double length : {0.4, 1.0}) {
    const dGeomID capsule = dCreateCapsule(space, radius, length);
    for (const double tilt : {20.0, 45.0, 70.0}) {
      for (const double turn : {0.0, 30.0}) {
        const double angle = tilt * M_PI / 180.0;
        // Across the edge at x = z = 0.5; turned about the way out.
        const Vec3 out(std::sin(angle), 0.0, std::cos(angle));
        const Mat3 turned = Eigen::AngleAxisd(turn * M_PI / 180.0, out).toRotationMatrix();
        const Vec3 axis = turned * Vec3(std::cos(angle), 0.0, -std::sin(angle));
        rotate(capsule, Vec3::UnitZ().cross(axis).normalized(), std::acos(axis.z()));
        for (const double inside : {-0.01, -1e-4, 1e-9, 1e-4, 0.01, 0.03}) {
          const Vec3 place = Vec3(0.5, 0.1, 0.5) - inside * out;
          dGeomSetPosition(capsule, place.x(), place.y(), place.z());
          const auto contacts = collide(capsule, box);
          expect_sound(contacts, capsule, box);
          ASSERT_FALSE(contacts.empty()) << tilt << ", " << turn << ", " << inside;
          EXPECT_NEAR(contacts[0].depth, inside + radius, 1e-9) << tilt << ", " << turn << ", " << inside;
          EXPECT_NEAR(normal_of(contacts[0]).dot(out), 1.0, 1e-9) << tilt << ", " << turn << ", " << inside;
          EXPECT_LT((position_of(contacts[0]) - Vec3(0.5, 0.1, 0.5)).norm(), 1e-9);
        }
      }
    }
  }
}

}  // namespace
}  // namespace odds::test
