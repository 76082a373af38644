// Mesh against sphere: ODE's own box-sphere as reference; internal edges; inside; sheets.
#include <cmath>
#include <random>

#include "odds/mesh/made/terrain.hpp"
#include "ode/budget_clock.hpp"
#include "ode/ode_fixture.hpp"

namespace odds::test {
namespace {

std::shared_ptr<const query::Shape> shape_from(std::vector<Vec3> vertices, std::vector<mesh::Triangle> triangles) {
  auto mesh = mesh::TriangleMesh::make(std::move(vertices), std::move(triangles));
  if (!mesh.ok()) throw std::runtime_error(mesh.error().message());
  return query::Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value())).value();
}

class SphereTest : public OdeTest {
 protected:
  std::mt19937 random{5};
};

TEST_F(SphereTest, AMeshBoxAnswersLikeOdesBox) {
  const dGeomID mesh = mesh_geom(box_shape(0.8, 1.0, 1.2, 4), space);
  const dGeomID box = dCreateBox(space, 0.8, 1.0, 1.2);
  const dGeomID sphere = dCreateSphere(space, 0.25);
  std::uniform_real_distribution<double> uniform(-0.9, 0.9);
  int hits = 0;
  int inside = 0;
  for (int round = 0; round < 1000; ++round) {
    const Vec3 center(uniform(random), uniform(random), uniform(random));
    dGeomSetPosition(sphere, center.x(), center.y(), center.z());
    const auto ours = collide(mesh, sphere);
    const auto odes = collide(box, sphere);
    ASSERT_EQ(ours.empty(), odes.empty()) << center.transpose();
    if (ours.empty()) continue;
    ++hits;
    expect_sound(ours, mesh, sphere);
    EXPECT_NEAR(ours[0].depth, odes[0].depth, 1e-9) << center.transpose();
    EXPECT_LT((normal_of(ours[0]) - normal_of(odes[0])).norm(), 1e-6) << center.transpose();
    const Vec3 gap = Vec3(0.4, 0.5, 0.6) - center.cwiseAbs();
    inside += gap.minCoeff() > 0.0;
    EXPECT_EQ(ours.size(), 1u) << "a box is convex: one place is nearest " << center.transpose();
  }
  EXPECT_GT(hits, 300);
  EXPECT_GT(inside, 100);
}

TEST_F(SphereTest, RotatedAndMovedMeshesAnswerTheSame) {
  const dGeomID mesh = mesh_geom(box_shape(0.8, 1.0, 1.2, 3), space);
  const dGeomID box = dCreateBox(space, 0.8, 1.0, 1.2);
  const dGeomID sphere = dCreateSphere(space, 0.3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int hits = 0;
  for (int round = 0; round < 300; ++round) {
    const Vec3 axis(uniform(random), uniform(random), 1.5);
    const double angle = 3.0 * uniform(random);
    for (const dGeomID geom : {mesh, box}) {
      rotate(geom, axis, angle);
      dGeomSetPosition(geom, 100, -50, 3);
    }
    dGeomSetPosition(sphere, 100 + 0.8 * uniform(random), -50 + 0.8 * uniform(random), 3 + 0.8 * uniform(random));
    const auto ours = collide(sphere, mesh);
    const auto odes = collide(sphere, box);
    ASSERT_EQ(ours.empty(), odes.empty());
    if (ours.empty()) continue;
    ++hits;
    EXPECT_NEAR(ours[0].depth, odes[0].depth, 1e-9);
    EXPECT_LT((normal_of(ours[0]) - normal_of(odes[0])).norm(), 1e-6);
  }
  EXPECT_GT(hits, 100);
}

TEST_F(SphereTest, OneThatOnlyTouchesHasAContactWithoutDepthForEachTriangleAsOdes) {
  const dGeomID square =
      mesh_geom(shape_from({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}), space);
  const dGeomID sphere = dCreateSphere(space, 4.0);
  const auto expect = [&](std::size_t count, const Vec3& normal) {
    const auto contacts = collide(square, sphere);
    ASSERT_EQ(contacts.size(), count);
    for (const dContactGeom& contact : contacts) {
      EXPECT_EQ(contact.depth, 0.0);
      EXPECT_EQ(normal_of(contact), normal);
    }
    if (count == 2) {
      EXPECT_NE(contacts[0].side1, contacts[1].side1);
    }
  };
  dGeomSetPosition(sphere, 0, 0, 4);  // the diagonal, which two triangles share
  expect(2, -Vec3::UnitZ());
  dGeomSetPosition(sphere, 0.5, -0.25, 4);
  expect(1, -Vec3::UnitZ());
  dGeomSetPosition(square, 10, 30, 40);
  dGeomSetPosition(sphere, 10, 30, 44);
  expect(2, -Vec3::UnitZ());
  dGeomSetPosition(sphere, 10, 30, std::nextafter(44.0, 45.0));
  EXPECT_TRUE(collide(square, sphere).empty());
}

TEST_F(SphereTest, RollingOverATessellatedFloorMeetsNoInternalEdge) {
  const dGeomID floor = mesh_geom(box_shape(2, 2, 0.2, 16), space);
  const dGeomID sphere = dCreateSphere(space, 0.1);
  for (int step = 0; step < 400; ++step) {
    const double x = -0.5 + 0.0025 * step;  // crosses edges and vertices exactly every 50 steps
    dGeomSetPosition(sphere, x, 0.125 + 0.3 * x, 0.199);
    const auto contacts = collide(floor, sphere);
    ASSERT_EQ(contacts.size(), 1u) << "at x = " << x;
    EXPECT_NEAR(contacts[0].normal[2], -1.0, 1e-9);
    EXPECT_NEAR(contacts[0].depth, 0.001, 1e-9);
  }
}

TEST_F(SphereTest, AGrooveGivesTwoContactsWithTheirOwnNormals) {
  // Two slopes of 45 degrees that meet along y at x = 0.
  const auto groove = shape_from({{-1, -1, 1}, {0, -1, 0}, {1, -1, 1}, {-1, 1, 1}, {0, 1, 0}, {1, 1, 1}},
                                 {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}});
  const dGeomID mesh = mesh_geom(groove, space);
  const dGeomID sphere = dCreateSphere(space, 0.3);
  dGeomSetPosition(sphere, 0, 0.2, 0.3 * std::sqrt(2.0) - 0.02);
  const auto contacts = collide(sphere, mesh);
  ASSERT_EQ(contacts.size(), 2u);
  expect_sound(contacts, sphere, mesh);
  for (const dContactGeom& contact : contacts) {
    EXPECT_NEAR(contact.normal[2], std::sqrt(0.5), 1e-9);
    EXPECT_NEAR(std::abs(contact.normal[0]), std::sqrt(0.5), 1e-9);
    EXPECT_NEAR(contact.depth, 0.02 * std::sqrt(0.5), 1e-9);
  }
  EXPECT_LT(contacts[0].normal[0] * contacts[1].normal[0], 0.0);
}

TEST_F(SphereTest, ARidgeGivesOneContact) {
  const auto ridge = shape_from({{-1, -1, -1}, {0, -1, 0}, {1, -1, -1}, {-1, 1, -1}, {0, 1, 0}, {1, 1, -1}},
                                {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}});
  const dGeomID mesh = mesh_geom(ridge, space);
  const dGeomID sphere = dCreateSphere(space, 0.3);
  dGeomSetPosition(sphere, 0.01, 0.3, 0.28);
  const auto contacts = collide(sphere, mesh);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR(contacts[0].depth, 0.3 - std::hypot(0.01, 0.28), 1e-9);
}

TEST_F(SphereTest, SwallowedDeepByAClosedMeshItIsPushedToTheNearestSurface) {
  const dGeomID mesh = mesh_geom(box_shape(1, 2, 3, 6), space);
  const dGeomID sphere = dCreateSphere(space, 0.01);
  dGeomSetPosition(sphere, 0.2, 0.1, 0.3);
  const auto contacts = collide(sphere, mesh);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR(contacts[0].normal[0], 1.0, 1e-9) << "out through the face at x = 0.5";
  EXPECT_NEAR(contacts[0].depth, 0.31, 1e-9);
}

TEST_F(SphereTest, InAConcavePocketTheSignIsRight) {
  // The groove closed to a solid below: above the groove is outside although inside the bounding box.
  const auto solid = shape_from({{-1, -1, 1},
                                 {0, -1, 0},
                                 {1, -1, 1},
                                 {-1, 1, 1},
                                 {0, 1, 0},
                                 {1, 1, 1},
                                 {-1, -1, -1},
                                 {1, -1, -1},
                                 {-1, 1, -1},
                                 {1, 1, -1}},
                                {{0, 1, 4},
                                 {0, 4, 3},
                                 {1, 2, 5},
                                 {1, 5, 4},
                                 {6, 8, 9},
                                 {6, 9, 7},
                                 {0, 3, 8},
                                 {0, 8, 6},
                                 {2, 7, 9},
                                 {2, 9, 5},
                                 {6, 7, 1},
                                 {6, 1, 0},
                                 {7, 2, 1},
                                 {8, 4, 9},
                                 {8, 3, 4},
                                 {9, 4, 5}});
  const dGeomID mesh = mesh_geom(solid, space);
  const dGeomID sphere = dCreateSphere(space, 0.05);
  dGeomSetPosition(sphere, 0, 0, 0.5);
  EXPECT_TRUE(collide(sphere, mesh).empty()) << "free in the groove";
  dGeomSetPosition(sphere, 0.001, 0, 0.03);
  for (const dContactGeom& contact : collide(sphere, mesh)) EXPECT_GT(contact.normal[2], 0.5);
  dGeomSetPosition(sphere, 0.3, 0, 0.1);
  const auto inside = collide(sphere, mesh);
  ASSERT_EQ(inside.size(), 1u);
  EXPECT_NEAR(inside[0].depth, 0.05 + 0.2 * std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(inside[0].normal[2], std::sqrt(0.5), 1e-9);
}

TEST_F(SphereTest, ASheetPushesToTheSideWhereTheCentreIs) {
  const auto sheet = shape_from({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
  const dGeomID mesh = mesh_geom(sheet, space);
  const dGeomID sphere = dCreateSphere(space, 0.1);
  for (const double side : {1.0, -1.0}) {
    dGeomSetPosition(sphere, 0.2, 0.3, 0.09 * side);
    const auto contacts = collide(sphere, mesh);
    ASSERT_EQ(contacts.size(), 1u);
    EXPECT_NEAR(contacts[0].normal[2], side, 1e-9);
    EXPECT_NEAR(contacts[0].depth, 0.01, 1e-9);
  }
}

// Whichever of the two triangles at one place was found first decided: half of all spheres were taken for inside, and
// pushed through the sheet.
TEST_F(SphereTest, ASheetWithBothItsSidesPushesToTheSideWhereTheCentreIs) {
  constexpr std::uint32_t cells = 8;
  const auto height = [](double x, double y) { return 0.2 * (x * x + y * y); };
  std::vector<Vec3> corners;
  std::vector<mesh::Triangle> triangles;
  for (std::uint32_t i = 0; i <= cells; ++i) {
    for (std::uint32_t k = 0; k <= cells; ++k) {
      const double x = 2.0 * i / cells - 1.0;
      const double y = 2.0 * k / cells - 1.0;
      corners.emplace_back(x, y, height(x, y));
      if (i == cells || k == cells) continue;
      const std::uint32_t a = i * (cells + 1) + k;
      const std::uint32_t b = a + cells + 1;
      for (const mesh::Triangle& front : {mesh::Triangle{a, b, b + 1}, mesh::Triangle{a, b + 1, a + 1}}) {
        triangles.push_back(front);
        triangles.push_back({front[0], front[2], front[1]});
      }
    }
  }
  const auto sheet = shape_from(corners, triangles);
  ASSERT_FALSE(sheet->is_solid());
  const dGeomID mesh = mesh_geom(sheet, space);
  const dGeomID sphere = dCreateSphere(space, 0.1);
  for (const double side : {1.0, -1.0}) {
    for (const double x : {-0.72, -0.31, 0.03, 0.44}) {
      const double y = 0.5 * x + 0.2;
      dGeomSetPosition(sphere, x, y, height(x, y) + 0.07 * side);
      const auto contacts = collide(sphere, mesh);
      ASSERT_FALSE(contacts.empty());
      for (const dContactGeom& contact : contacts) {
        EXPECT_GT(side * contact.normal[2], 0.5) << "at x = " << x;
        EXPECT_LT(contact.depth, 0.06) << "at x = " << x;
      }
    }
  }
}

TEST_F(SphereTest, ACentreExactlyOnTheSurfaceIsPushedOutward) {
  const dGeomID mesh = mesh_geom(box_shape(1, 1, 1, 4), space);
  const dGeomID sphere = dCreateSphere(space, 0.1);
  dGeomSetPosition(sphere, 0.1, 0.2, 0.5);
  const auto contacts = collide(sphere, mesh);
  ASSERT_GE(contacts.size(), 1u);
  EXPECT_NEAR(contacts[0].normal[2], 1.0, 1e-9);
  EXPECT_NEAR(contacts[0].depth, 0.1, 1e-9);
}

TEST_F(SphereTest, MoreTrianglesThanTheScratchHoldsStillGivesTheNearest) {
  mesh::made::Terrain fine;
  fine.cells = 120;
  const auto terrain = shape_of(fine);
  const dGeomID mesh = mesh_geom(terrain, space);
  const dGeomID sphere = dCreateSphere(space, 0.45);
  const Vec3 center(0.1, 0.05, 0.42);
  dGeomSetPosition(sphere, center.x(), center.y(), center.z());
  double nearest = 1e9;
  for (const Vec3& vertex : terrain->mesh().vertices()) nearest = std::min(nearest, (vertex - center).norm());
  const auto contacts = collide(mesh, sphere);
  ASSERT_LT(nearest, 0.45) << "the test's own premise";
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_GE(contacts[0].depth, 0.45 - nearest - 1e-12);
  EXPECT_LT(contacts[0].depth, 0.45 - nearest + 0.01);
  EXPECT_EQ(stats().primitive_cut_off, 1u);
}

// Where the search for the nearest triangle ended early, the side of another one was taken for that of the surface.
TEST_F(SphereTest, InACavityAnEarlyEndPushesNothingThroughTheWalls) {
  const auto outer = box_shape(2.0, 2.0, 2.0, 24);
  const auto inner = box_shape(1.9, 1.9, 1.9, 24);
  std::vector<Vec3> vertices(outer->mesh().vertices().begin(), outer->mesh().vertices().end());
  std::vector<mesh::Triangle> triangles(outer->mesh().triangles().begin(), outer->mesh().triangles().end());
  const auto first = static_cast<std::uint32_t>(vertices.size());
  vertices.insert(vertices.end(), inner->mesh().vertices().begin(), inner->mesh().vertices().end());
  for (const mesh::Triangle& t : inner->mesh().triangles()) {
    triangles.push_back({t[0] + first, t[2] + first, t[1] + first});
  }
  const dGeomID mesh = mesh_geom(shape_from(std::move(vertices), std::move(triangles)), space);
  const std::array<dGeomID, 3> bodies = {dCreateSphere(space, 0.05), dCreateCapsule(space, 0.05, 0.1),
                                         dCreateBox(space, 0.1, 0.1, 0.1)};
  std::uniform_real_distribution<double> uniform(-0.8, 0.8);
  for (const unsigned long units : {10UL, 20UL, 30UL, 50UL, 100UL}) {
    ASSERT_EQ(dGeomOddsMeshSetWorkBudget(mesh, units), 1);
    for (int i = 0; i < 3000; ++i) {
      const Vec3 place(uniform(random), uniform(random), uniform(random));
      for (const dGeomID body : bodies) {
        dGeomSetPosition(body, place.x(), place.y(), place.z());
        ASSERT_TRUE(collide(mesh, body).empty()) << units << " units, class " << dGeomGetClass(body);
      }
    }
  }
}

// Nor is a ball whose middle is under a face pushed farther in.
TEST_F(SphereTest, UnderAFaceAnEarlyEndPushesNothingIn) {
  const dGeomID mesh = mesh_geom(box_shape(2.0, 2.0, 2.0, 24), space);
  const std::array<dGeomID, 2> bodies = {dCreateSphere(space, 0.1), dCreateCapsule(space, 0.1, 0.05)};
  std::uniform_real_distribution<double> uniform(-0.8, 0.8);
  int found = 0;
  for (const unsigned long units : {10UL, 20UL, 50UL, 100UL, 1000UL}) {
    ASSERT_EQ(dGeomOddsMeshSetWorkBudget(mesh, units), 1);
    for (int i = 0; i < 500; ++i) {
      for (const dGeomID body : bodies) {
        dGeomSetPosition(body, uniform(random), uniform(random), 0.97);
        for (const dContactGeom& contact : collide(body, mesh)) {
          ++found;
          ASSERT_GE(contact.normal[2], -1e-9) << units << " units, class " << dGeomGetClass(body);
        }
      }
    }
  }
  EXPECT_GT(found, 900);
}

// A search that ends early knows no nearest place, but what is met first on the way to the one that it has.
TEST_F(SphereTest, DeepInASolidAnEarlyEndStillPushesItOut) {
  const dGeomID solid = mesh_geom(sphere_shape(1.0, 40), space);
  const dGeomID ball = dCreateSphere(space, 0.1);
  dGeomSetPosition(ball, 0.5, 0.1, 0.2);
  const double nearest = 1.0 - Vec3(0.5, 0.1, 0.2).norm();
  std::size_t early = 0;
  for (int units = 8; units < 200; ++units) {
    dGeomOddsMeshSetWorkBudget(solid, static_cast<std::uint64_t>(units));
    oddsResetStats();
    const auto contacts = collide(solid, ball);
    ASSERT_EQ(contacts.size(), 1u) << units;
    EXPECT_NEAR(position_of(contacts[0]).norm(), 1.0, 2e-3);
    EXPECT_LT(normal_of(contacts[0]).dot(position_of(contacts[0])), -0.5) << "into the solid";
    EXPECT_GE(contacts[0].depth, nearest + 0.1 - 2e-3);
    EXPECT_LE(contacts[0].depth, 1.3 * nearest + 0.1);
    early += stats().primitive_cut_off;
  }
  EXPECT_GT(early, 0u);
}

// More triangles meet at the tip than a collision looks at: those of one side spoke for all.
TEST_F(SphereTest, AboveTheTipOfAConeOfManySidesItIsOutside) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (const std::uint32_t sides : {16u, 65u, 96u, 200u, 1000u}) {
    std::vector<Vec3> vertices = {{0, 0, 1}, {0, 0, 0}};
    std::vector<mesh::Triangle> triangles;
    for (std::uint32_t i = 0; i < sides; ++i) {
      const double angle = 2.0 * M_PI * i / sides;
      vertices.emplace_back(0.2 * std::cos(angle), 0.2 * std::sin(angle), 0.0);
      const std::uint32_t next = 2 + (i + 1) % sides;
      triangles.push_back({2 + i, next, 0});
      triangles.push_back({next, 2 + i, 1});
    }
    const dGeomID mesh = mesh_geom(shape_from(std::move(vertices), std::move(triangles)), space);
    const dGeomID sphere = dCreateSphere(space, 0.3);
    for (int round = 0; round < 500; ++round) {
      const Vec3 from_tip(0.1 * uniform(random), 0.1 * uniform(random), 0.06 + 0.04 * uniform(random));
      if (from_tip.head<2>().norm() > 4.5 * from_tip.z()) continue;  // a side is nearer
      dGeomSetPosition(sphere, from_tip.x(), from_tip.y(), 1.0 + from_tip.z());
      const auto contacts = collide(mesh, sphere);
      ASSERT_EQ(contacts.size(), 1u);
      ASSERT_NEAR(contacts[0].depth, 0.3 - from_tip.norm(), 1e-9) << sides << " sides at " << from_tip.transpose();
      ASSERT_LT((normal_of(contacts[0]) + from_tip.normalized()).norm(), 1e-9);
    }
  }
}

// As of a site in coordinates of a country: the point that is nearest is off an edge or a corner by rounding.
TEST_F(SphereTest, FarFromTheOriginOfItsFrameAMeshHasTheSameInside) {
  const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 0.3, 0}, {0.9, 0.9, 1}};
  const std::vector<mesh::Triangle> triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  const dGeomID near = mesh_geom(shape_from(corners, triangles), space);
  const dGeomID sphere = dCreateSphere(space, 0.2);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (const double far : {1e5, 1e6, 1e8}) {
    const Vec3 offset = far * Vec3(0.731, 0.377, -0.211);
    std::vector<Vec3> moved;
    for (const Vec3& corner : corners) moved.push_back(corner + offset);
    const dGeomID mesh = mesh_geom(shape_from(std::move(moved), triangles), space);
    dGeomSetPosition(mesh, -offset.x(), -offset.y(), -offset.z());
    int hits = 0;
    for (int round = 0; round < 3000; ++round) {
      dGeomSetPosition(sphere, uniform(random), uniform(random), uniform(random));
      const auto expected = collide(near, sphere);
      const auto contacts = collide(mesh, sphere);
      hits += expected.empty() ? 0 : 1;
      const double depth = expected.empty() ? 0.0 : expected[0].depth;
      ASSERT_NEAR(contacts.empty() ? 0.0 : contacts[0].depth, depth, 1e-15 * far + 1e-6) << far << ", " << round;
    }
    EXPECT_GT(hits, 100);
  }
}

// Each of many places is compared with all that are nearer.
TEST_F(SphereTest, ManyPlacesKeepToTheBudget) {
  std::vector<Vec3> vertices;
  std::vector<mesh::Triangle> triangles;
  for (int i = 0; i < 200; ++i) {  // apart from each other, and each as far away as it pleases
    const double angle = 2.4 * i;
    const double z = 1.0 - (i + 0.5) / 100.0;
    const Vec3 out(std::sqrt(1.0 - z * z) * std::cos(angle), std::sqrt(1.0 - z * z) * std::sin(angle), z);
    const Vec3 side = 0.02 * out.unitOrthogonal();
    const Vec3 middle = (0.8 + 0.0005 * i) * out;
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (const Vec3& corner : {Vec3(middle + side), Vec3(middle + out.cross(side)), Vec3(middle - side)}) {
      vertices.push_back(corner);
    }
    triangles.push_back({first, first + 1, first + 2});
  }
  const dGeomID mesh = mesh_geom(shape_from(std::move(vertices), std::move(triangles)), space);
  const dGeomID sphere = dCreateSphere(space, 1.0);
  EXPECT_EQ(collide(mesh, sphere).size(), 8u);
  realtime::ManualClock clock(1000);  // a microsecond a look: one at the beginning, one for each triangle
  ode::use_budget_clock(clock.clock());
  ASSERT_EQ(dGeomOddsMeshSetBudget(mesh, 203), 1);
  const auto contacts = collide(mesh, sphere);
  ode::use_budget_clock({});
  EXPECT_LT(contacts.size(), 4u);
  EXPECT_EQ(stats().primitive_cut_off, 1u);
}

TEST_F(SphereTest, AnExhaustedBudgetIsCountedAndSound) {
  const dGeomID mesh = mesh_geom(sphere_shape(1, 20), space);
  const dGeomID sphere = dCreateSphere(space, 0.5);
  dGeomSetPosition(sphere, 1.2, 0, 0);
  ASSERT_EQ(dGeomOddsMeshSetWorkBudget(mesh, 2), 1);
  expect_sound(collide(mesh, sphere), mesh, sphere);
  EXPECT_EQ(stats().primitive_cut_off, 1u);
}

}  // namespace
}  // namespace odds::test
