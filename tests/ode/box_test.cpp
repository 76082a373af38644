// Mesh against box: resting on tessellated floors, corners, ridges, concave corners; every exit really ends the
// overlap.
#include <algorithm>
#include <cmath>
#include <random>

#include "odds/mesh/made/terrain.hpp"
#include "odds/realtime/clock.hpp"
#include "ode/budget_clock.hpp"
#include "ode/ode_fixture.hpp"

namespace odds::test {
namespace {

class BoxTest : public OdeTest {
 protected:
  std::mt19937 random{9};
  std::uniform_real_distribution<double> uniform{-1.0, 1.0};
};

// Twice the area of the polygon of contacts around their centre, in the x-y plane.
double spanned_area(const std::vector<dContactGeom>& contacts) {
  Vec3 middle = Vec3::Zero();
  for (const dContactGeom& contact : contacts) middle += position_of(contact) / static_cast<double>(contacts.size());
  std::vector<Vec3> points;
  for (const dContactGeom& contact : contacts) points.push_back(position_of(contact) - middle);
  std::sort(points.begin(), points.end(),
            [](const Vec3& a, const Vec3& b) { return std::atan2(a.y(), a.x()) < std::atan2(b.y(), b.x()); });
  double twice = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& next = points[(i + 1) % points.size()];
    twice += points[i].x() * next.y() - points[i].y() * next.x();
  }
  return 0.5 * twice;
}

TEST_F(BoxTest, RestingOnATessellatedFloorAllNormalsAreVerticalAndCornersAreHeld) {
  const dGeomID floor = mesh_geom(box_shape(2, 2, 0.2, 16), space);
  const dGeomID box = dCreateBox(space, 0.3, 0.2, 0.1);
  for (int round = 0; round < 300; ++round) {
    rotate(box, Vec3(0, 0, 1), 3.0 * uniform(random));
    dGeomSetPosition(box, 0.5 * uniform(random), 0.5 * uniform(random), 0.149);
    const auto contacts = collide(box, floor, 8);
    ASSERT_GE(contacts.size(), 4u);
    expect_sound(contacts, box, floor);
    for (const dContactGeom& contact : contacts) {
      EXPECT_NEAR(contact.normal[2], 1.0, 1e-9);
      EXPECT_NEAR(contact.depth, 0.001, 1e-9);
    }
    EXPECT_GT(spanned_area(contacts), 0.95 * 0.06);
    EXPECT_GT(spanned_area(collide(box, floor, 4)), 0.7 * 0.06);
  }
}

// A corner of whose two sides one leans over is not below the section that the floor makes through the box, but beside
// it by nearly nothing: a box was held by two corners, across, as soon as it was tilted by 1e-11, and rocked.
TEST_F(BoxTest, StandingNearlyUprightItIsHeldAtAllItsCorners) {
  const dGeomID floor = mesh_geom(box_shape(2, 2, 0.2, 16), space);
  dGeomOddsMeshSetCarryMotion(floor, 0);  // each collision stands alone
  const dGeomID box = dCreateBox(space, 0.3, 0.2, 0.1);
  for (int round = 0; round < 300; ++round) {
    const double lean = std::pow(10.0, -7.0 + 4.0 * uniform(random));  // 1e-11 .. 1e-3
    const double towards = 3.0 * uniform(random);
    dMatrix3 turned;
    dRFrom2Axes(turned, std::cos(towards), std::sin(towards), lean, -std::sin(towards), std::cos(towards),
                lean * uniform(random));
    dGeomSetRotation(box, turned);
    const Vec3 center(0.5 * uniform(random), 0.5 * uniform(random), 0.149);
    dGeomSetPosition(box, center.x(), center.y(), center.z());
    const auto contacts = collide(box, floor, 8);
    expect_sound(contacts, box, floor);
    for (const double x : {-0.15, 0.15}) {
      for (const double y : {-0.1, 0.1}) {
        dVector3 corner;
        dGeomGetRelPointPos(box, x, y, -0.05, corner);
        const double depth = 0.1 - corner[2];
        const auto holds = [&](const dContactGeom& contact) {
          const Vec3 apart = position_of(contact) - Vec3(corner[0], corner[1], 0.1);
          return apart.norm() < 1e-5 && std::abs(contact.depth - depth) < 1e-5;
        };
        EXPECT_TRUE(std::any_of(contacts.begin(), contacts.end(), holds)) << round << ": lean " << lean;
      }
    }
  }
}

TEST_F(BoxTest, ATiltedBoxIsAsDeepAsItsLowestCorner) {
  const dGeomID floor = mesh_geom(box_shape(2, 2, 0.2, 16), space);
  const dGeomID box = dCreateBox(space, 0.3, 0.2, 0.1);
  for (int round = 0; round < 300; ++round) {
    rotate(box, Vec3(uniform(random), uniform(random), uniform(random)), uniform(random));
    dGeomSetPosition(box, 0.5 * uniform(random), 0.5 * uniform(random), 0.2);
    // Lowered until its lowest corner is 2 mm deep.
    dReal aabb[6];
    dGeomGetAABB(box, aabb);
    const dReal* p = dGeomGetPosition(box);
    dGeomSetPosition(box, p[0], p[1], p[2] + 0.1 - aabb[4] - 0.002);
    const auto contacts = collide(box, floor);
    ASSERT_FALSE(contacts.empty());
    EXPECT_NEAR(contacts[0].depth, 0.002, 1e-9);
    for (const dContactGeom& contact : contacts) EXPECT_NEAR(contact.normal[2], 1.0, 1e-9);
  }
}

TEST_F(BoxTest, GoingTheDeepestWayOutEndsTheOverlapOfConvexBodies) {
  const dGeomID mesh = mesh_geom(box_shape(0.8, 1.0, 1.2, 2), space);
  const dGeomID twin = dCreateBox(space, 0.8, 1.0, 1.2);
  const dGeomID box = dCreateBox(space, 0.5, 0.6, 0.7);
  int hits = 0;
  int much_longer = 0;
  for (int round = 0; round < 500; ++round) {
    rotate(box, Vec3(uniform(random), uniform(random), uniform(random)), 3.0 * uniform(random));
    const Vec3 position = Vec3(uniform(random), uniform(random), uniform(random));
    dGeomSetPosition(box, position.x(), position.y(), position.z());
    const auto contacts = collide(box, mesh);
    const auto reference = collide(box, twin);
    const double least = reference.empty()
                             ? 0.0
                             : std::max_element(reference.begin(), reference.end(), [](const auto& x, const auto& y) {
                                 return x.depth < y.depth;
                               })->depth;
    if (least > 1e-6) {
      ASSERT_FALSE(contacts.empty());
    }
    if (reference.empty()) {
      ASSERT_TRUE(contacts.empty());
    }
    if (contacts.empty() || least > 0.15) continue;  // deep overlaps have several reasonable ways out
    ++hits;
    double out = 0.0;
    for (const dContactGeom& contact : contacts) {
      EXPECT_NEAR((normal_of(contact) - normal_of(contacts[0])).norm(), 0.0, 1e-3)
          << "one manifold between convex bodies";
      out = std::max(out, contact.depth);
    }
    much_longer += out > 2.0 * least + 1e-3;
    const Vec3 away = position + (out + 1e-7) * normal_of(contacts[0]);
    dGeomSetPosition(box, away.x(), away.y(), away.z());
    for (const dContactGeom& left : collide(box, twin)) EXPECT_LT(left.depth, 1e-3) << "round " << round;
  }
  EXPECT_GT(hits, 100);
  EXPECT_LT(much_longer, hits / 50);
}

TEST_F(BoxTest, AMeshCornerInATableTopIsPushedOutOfTheTop) {
  const dGeomID mesh = mesh_geom(box_shape(0.2, 0.2, 0.2, 3), space);
  rotate(mesh, Vec3(1, -1, 0), std::acos(std::sqrt(1.0 / 3.0)));  // a diagonal stands upright
  dReal aabb[6];
  dGeomGetAABB(mesh, aabb);
  const dGeomID table = dCreateBox(space, 2, 2, 0.1);
  dGeomSetPosition(table, 0, 0, -0.05);
  const dGeomID plane = dCreatePlane(nullptr, 0, 0, 1, 0);
  dGeomSetPosition(mesh, 0, 0, 0.16);
  const auto reference = collide(mesh, plane);
  ASSERT_EQ(reference.size(), 1u);
  const auto contacts = collide(mesh, table);
  ASSERT_FALSE(contacts.empty());
  EXPECT_NEAR(contacts[0].depth, reference[0].depth, 1e-9);
  for (const dContactGeom& contact : contacts) EXPECT_NEAR(contact.normal[2], 1.0, 1e-9);
  dGeomDestroy(plane);
}

TEST_F(BoxTest, CrossedEdgesArePushedApartAcrossBoth) {
  const dGeomID mesh = mesh_geom(box_shape(1, 0.2, 0.2), space);
  rotate(mesh, Vec3(1, 0, 0), M_PI / 4);  // its upper edge runs along x
  const dGeomID box = dCreateBox(space, 0.2, 1, 0.2);
  rotate(box, Vec3(0, 1, 0), M_PI / 4);  // its lower edge runs along y
  const double half_diagonal = 0.1 * std::sqrt(2.0);
  dGeomSetPosition(box, 0.13, 0.07, 2.0 * half_diagonal - 0.01);
  const auto contacts = collide(box, mesh);
  ASSERT_FALSE(contacts.empty());
  EXPECT_NEAR(contacts[0].normal[2], 1.0, 1e-6);
  EXPECT_NEAR(contacts[0].depth, 0.01, 1e-6);
  EXPECT_NEAR(contacts[0].pos[0], 0.13, 1e-6);
  EXPECT_NEAR(contacts[0].pos[1], 0.0, 1e-6);
}

TEST_F(BoxTest, InAConcaveCornerFloorAndWallBothPush) {
  // A floor (z = 0) and a wall (x = 0), each of 8 x 8 cells.
  std::vector<Vec3> vertices;
  std::vector<mesh::Triangle> triangles;
  const auto sheet = [&](const auto& at) {
    const auto base = static_cast<std::uint32_t>(vertices.size());
    for (std::uint32_t i = 0; i <= 8; ++i) {
      for (std::uint32_t j = 0; j <= 8; ++j) vertices.push_back(at(i / 8.0, j / 8.0));
    }
    for (std::uint32_t i = 0; i < 8; ++i) {
      for (std::uint32_t j = 0; j < 8; ++j) {
        const std::uint32_t a = base + 9 * i + j;
        triangles.push_back({a, a + 9, a + 10});
        triangles.push_back({a, a + 10, a + 1});
      }
    }
  };
  sheet([](double u, double v) { return Vec3(u, v, 0); });
  sheet([](double u, double v) { return Vec3(0, u, v); });
  auto made = mesh::TriangleMesh::make(vertices, triangles);
  ASSERT_TRUE(made.ok());
  const dGeomID corner = mesh_geom(
      query::Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(made).value())).value(), space);
  const dGeomID box = dCreateBox(space, 0.3, 0.3, 0.3);
  dGeomSetPosition(box, 0.148, 0.5, 0.149);
  const auto contacts = collide(box, corner);
  int up = 0;
  int sideways = 0;
  for (const dContactGeom& contact : contacts) {
    if (contact.normal[2] > 0.999) {
      ++up;
      EXPECT_NEAR(contact.depth, 0.001, 1e-9);
    } else {
      ++sideways;
      EXPECT_NEAR(contact.normal[0], 1.0, 1e-9);
      EXPECT_NEAR(contact.depth, 0.002, 1e-9);
    }
  }
  EXPECT_EQ(up, 4);
  EXPECT_EQ(sideways, 4);
}

TEST_F(BoxTest, SwallowedByAClosedMeshItIsPushedOut) {
  const dGeomID mesh = mesh_geom(box_shape(2, 2, 2, 4), space);
  const dGeomID box = dCreateBox(space, 0.2, 0.2, 0.2);
  dGeomSetPosition(box, 0.1, 0.2, 0.6);
  const auto contacts = collide(box, mesh);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR(contacts[0].normal[2], 1.0, 1e-9);
  EXPECT_NEAR(contacts[0].depth, 0.5, 1e-9);
}

TEST_F(BoxTest, OnTerrainNoNormalPointsIntoTheGround) {
  mesh::made::Terrain hills;
  hills.cells = 48;
  const dGeomID terrain = mesh_geom(shape_of(hills), space);
  const dGeomID box = dCreateBox(space, 0.1, 0.1, 0.1);
  int contacts_seen = 0;
  for (int round = 0; round < 300; ++round) {
    rotate(box, Vec3(uniform(random), uniform(random), uniform(random)), 3.0 * uniform(random));
    dGeomSetPosition(box, 0.8 * uniform(random), 0.8 * uniform(random), 0.1 * uniform(random));
    const auto contacts = collide(box, terrain);
    expect_sound(contacts, box, terrain);
    for (const dContactGeom& contact : contacts) {
      ++contacts_seen;
      EXPECT_GT(contact.normal[2], 0.0) << "round " << round;
      EXPECT_LE(contact.depth, 0.18) << "at most the box's diagonal";
    }
  }
  EXPECT_GT(contacts_seen, 200);
}

TEST_F(BoxTest, ManySmallTrianglesAreCutOffAndCountedYetHoldTheBox) {
  const dGeomID floor = mesh_geom(box_shape(2, 2, 0.2, 50), space);
  const dGeomID box = dCreateBox(space, 0.6, 0.6, 0.1);
  dGeomSetPosition(box, 0.013, 0.017, 0.149);
  const auto contacts = collide(box, floor);
  EXPECT_EQ(stats().primitive_cut_off, 1u);
  ASSERT_GE(contacts.size(), 3u);
  for (const dContactGeom& contact : contacts) {
    EXPECT_NEAR(contact.normal[2], 1.0, 1e-9);
    EXPECT_NEAR(contact.depth, 0.001, 1e-9);
  }
  EXPECT_GT(spanned_area(contacts), 0.3 * 0.36);
}

// Its two sides are left in opposite directions: pushed both ways a body sticks in the plate.
TEST_F(BoxTest, ThroughAPlateItIsPushedOneWay) {
  for (const std::uint32_t cells : {1u, 4u, 8u}) {
    const dGeomID plate = mesh_geom(box_shape(1.0, 0.8, 0.1, cells), space);
    dGeomOddsMeshSetCarryMotion(plate, 0);
    for (const dGeomID body : {dCreateBox(space, 0.4, 0.4, 0.4), dCreateCylinder(space, 0.2, 0.4)}) {
      for (int round = 0; round < 300; ++round) {
        const double side = round % 2 == 0 ? 1.0 : -1.0;
        rotate(body, Vec3(uniform(random), uniform(random), 0.2 * uniform(random)), 0.3 * uniform(random));
        dGeomSetPosition(body, 0.1 * uniform(random), 0.1 * uniform(random), side * (0.06 + 0.04 * uniform(random)));
        const auto contacts = collide(plate, body);
        ASSERT_FALSE(contacts.empty());
        for (const dContactGeom& contact : contacts) {
          ASSERT_GT(-side * contact.normal[2], 0.5)
              << cells << " cells, class " << dGeomGetClass(body) << ", round " << round;
        }
      }
    }
  }
}

// Of an open mesh the front: ground holds what lies deep in it. Of one with both its sides the nearer.
TEST_F(BoxTest, ASheetOfOneLayerIsLeftAtItsFront) {
  for (const bool both_sides : {false, true}) {
    std::vector<mesh::Triangle> triangles = {{0, 1, 2}, {0, 2, 3}};
    if (both_sides) triangles.insert(triangles.end(), {{0, 2, 1}, {0, 3, 2}});
    auto sheet = mesh::TriangleMesh::make({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, std::move(triangles));
    const dGeomID mesh = mesh_geom(
        query::Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(sheet).value())).value(), space);
    for (const dGeomID body : {dCreateBox(space, 0.2, 0.2, 0.2), dCreateCylinder(space, 0.1, 0.2)}) {
      for (const double side : {1.0, -1.0}) {
        dGeomSetPosition(body, 0.2, 0.3, 0.08 * side);
        const auto contacts = collide(body, mesh);
        ASSERT_GE(contacts.size(), 3u);
        for (const dContactGeom& contact : contacts) {
          EXPECT_NEAR(contact.normal[2], both_sides ? side : 1.0, 1e-9);
          EXPECT_NEAR(contact.depth, both_sides || side > 0.0 ? 0.02 : 0.18, 1e-9);
        }
      }
    }
  }
}

// The first triangles may be those of a wall only: along its normal the box would go all of the length of what it
// stands on. It was pushed by up to 1.4 m, out of a cube of 1 m in which it lay by 1 cm.
// Its lowest corner is beside the sheet, and the deepest place over it where an edge of the box goes over the border.
// Of flat surface only corners were asked for, as the sides of a slab make the others known: a box sank in at the
// border.
TEST_F(BoxTest, LeaningOverTheBorderOfASheetItIsAsDeepAsItsEdgesThere) {
  auto made =
      mesh::TriangleMesh::make({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}, "sheet");
  const auto shape = query::Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(made).value()));
  const dGeomID sheet = mesh_geom(shape.value(), space);
  dGeomOddsMeshSetCarryMotion(sheet, 0);  // each collision stands alone
  const dGeomID box = dCreateBox(space, 0.3, 0.2, 0.1);
  for (int round = 0; round < 1000; ++round) {
    rotate(box, Vec3(uniform(random), uniform(random), 0.0), 0.03 * uniform(random));
    dGeomSetPosition(box, 1.0 + 0.05 * uniform(random), 0.5 * uniform(random), 0.05);
    double deepest = 0.0;
    for (int i = 0; i <= 1000; ++i) {
      const double t = 0.002 * i - 1.0;
      for (const Vec3& at : {Vec3(t, -1, -1), Vec3(t, 1, -1), Vec3(-1, t, -1), Vec3(1, t, -1)}) {
        dVector3 below;
        dGeomGetRelPointPos(box, 0.15 * at.x(), 0.1 * at.y(), 0.05 * at.z(), below);
        if (below[0] <= 1.0) deepest = std::max(deepest, -below[2]);
      }
    }
    if (deepest < 1e-4) continue;
    const auto contacts = collide(box, sheet, 8);
    ASSERT_FALSE(contacts.empty()) << "round " << round;
    expect_sound(contacts, box, sheet);
    EXPECT_GT(contacts[0].normal[2], 0.99) << "round " << round;
    EXPECT_NEAR(contacts[0].depth, deepest, 0.05 * deepest) << "round " << round;
  }
}

TEST_F(BoxTest, AWallThatIsAllThatIsKnownPushesItNoFartherThanOutOfTheMesh) {
  const dGeomID mesh = mesh_geom(box_shape(1, 1, 1, 1), space);
  const dGeomID box = dCreateBox(space, 1, 1, 1);
  dGeomOddsMeshSetBudget(mesh, dInfinity);
  dGeomOddsMeshSetCarryMotion(mesh, 0);
  int cut_off = 0;
  for (int round = 0; round < 200; ++round) {
    rotate(box, Vec3(0.01 * uniform(random), 0.01 * uniform(random), 1.0), 3.0 * uniform(random));
    dGeomSetPosition(box, 0.5 * uniform(random), 0.5 * uniform(random), 0.99 + 0.005 * uniform(random));
    for (unsigned long units = 1; units < 8; ++units) {
      dGeomOddsMeshSetWorkBudget(mesh, 0);
      const auto all = collide(box, mesh);
      ASSERT_FALSE(all.empty());
      oddsResetStats();
      dGeomOddsMeshSetWorkBudget(mesh, units);
      const auto contacts = collide(box, mesh);
      if (stats().primitive_cut_off == 0) continue;
      cut_off += contacts.empty() ? 0 : 1;
      for (const dContactGeom& contact : contacts)
        EXPECT_LE(contact.depth, all[0].depth + 1e-4) << round << " " << units;
    }
  }
  EXPECT_GT(cut_off, 100);
}

// What the time leaves of many pieces of surface is from opposite sides: on those of one a body would tip over.
TEST_F(BoxTest, InShortTimeItIsHeldOnOppositeSides) {
  const dGeomID floor = mesh_geom(box_shape(1.0, 1.0, 0.1, 40), space);
  const dGeomID body = dCreateBox(space, 0.4, 0.4, 0.2);
  dGeomSetPosition(body, 0.003, 0.002, 0.149);
  realtime::ManualClock clock(150);  // nanoseconds a look: about one at each node
  for (const double microseconds : {5.0, 12.0, 30.0}) {
    ASSERT_EQ(dGeomOddsMeshSetBudget(floor, microseconds), 1);
    ode::use_budget_clock(clock.clock());
    const auto contacts = collide(floor, body);
    ode::use_budget_clock({});
    bool sides[4] = {};
    for (const dContactGeom& contact : contacts) {
      EXPECT_LT(contact.normal[2], -0.99);
      EXPECT_NEAR(contact.depth, 0.001, 1e-9);
      sides[(contact.pos[0] > 0.0 ? 1 : 0) + (contact.pos[1] > 0.0 ? 2 : 0)] = true;
    }
    EXPECT_GE(contacts.size(), 2u);
    if (microseconds < 10.0) continue;  // no time to look elsewhere
    EXPECT_TRUE((sides[0] && sides[3]) || (sides[1] && sides[2])) << microseconds << " us";
  }
}

}  // namespace
}  // namespace odds::test
