// Mesh against registered convexes: a cube answers as ODE's box does; odd shapes on floors; what is refused and found
// out.
#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <numbers>
#include <random>

#include "odds/mesh/made/icosphere.hpp"
#include "ode/geom/convex_shape.hpp"
#include "ode/known_convexes.hpp"
#include "ode/ode_fixture.hpp"

namespace odds::test {
namespace {

// The arrays of dCreateConvex, which keeps pointers to them.
struct Arrays {
  std::vector<dReal> planes;
  std::vector<dReal> points;
  std::vector<unsigned> polygons;
  unsigned faces = 0;

  void add(const std::vector<unsigned>& corners) {
    polygons.push_back(static_cast<unsigned>(corners.size()));
    polygons.insert(polygons.end(), corners.begin(), corners.end());
    const Vec3 normal = (at(corners[1]) - at(corners[0])).cross(at(corners[2]) - at(corners[0])).normalized();
    for (int axis = 0; axis < 3; ++axis) planes.push_back(normal[axis]);
    planes.push_back(normal.dot(at(corners[0])));
    ++faces;
  }
  [[nodiscard]] Vec3 at(unsigned i) const { return {points[3 * i], points[3 * i + 1], points[3 * i + 2]}; }
  [[nodiscard]] unsigned count() const { return static_cast<unsigned>(points.size() / 3); }
};

Arrays cuboid(const Vec3& half) {
  Arrays arrays;
  for (int c = 0; c < 8; ++c) {
    for (int axis = 0; axis < 3; ++axis) arrays.points.push_back((c >> axis & 1) != 0 ? half[axis] : -half[axis]);
  }
  for (const auto& face : std::vector<std::vector<unsigned>>{
           {0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}) {
    arrays.add(face);
  }
  return arrays;
}

Arrays ball(double radius) {
  const auto mesh = make(mesh::made::Icosphere{.radius = radius, .frequency = 3}).value();
  Arrays arrays;
  for (const Vec3& v : mesh.vertices()) arrays.points.insert(arrays.points.end(), {v.x(), v.y(), v.z()});
  for (const mesh::Triangle& t : mesh.triangles()) arrays.add({t[0], t[1], t[2]});
  return arrays;
}

class ConvexTest : public OdeTest {
 protected:
  void TearDown() override {
    for (const dGeomID geom : known) oddsForgetGeom(geom);
    OdeTest::TearDown();
  }
  dGeomID convex_of(const Arrays& arrays) {
    const dGeomID geom = dCreateConvex(space, arrays.planes.data(), arrays.faces, arrays.points.data(), arrays.count(),
                                       arrays.polygons.data());
    EXPECT_EQ(oddsRegisterConvex(geom, arrays.points.data(), arrays.count(), arrays.polygons.data(), arrays.faces), 1)
        << oddsGetLastError();
    known.push_back(geom);
    return geom;
  }
  std::vector<dGeomID> known;
  std::mt19937 random{41};
  std::uniform_real_distribution<double> uniform{-1.0, 1.0};
};

// An edge of it across an edge of the surface, and the face that lies below the surface and that nothing cuts.
TEST_F(ConvexTest, ItsWayOutIsAsShortAsABoxs) {
  const Arrays arrays = cuboid(Vec3(0.3, 0.25, 0.2));
  const dGeomID convex = convex_of(arrays);
  const dGeomID box = dCreateBox(space, 0.6, 0.5, 0.4);
  const dGeomID mesh = mesh_geom(box_shape(1.0, 0.8, 0.6, 3), space);
  dGeomOddsMeshSetCarryMotion(mesh, 0);
  const auto deepest = [](const std::vector<dContactGeom>& contacts) {
    double depth = 0.0;
    for (const dContactGeom& contact : contacts) depth = std::max(depth, static_cast<double>(contact.depth));
    return depth;
  };
  int hits = 0;
  int longer = 0;
  for (int round = 0; round < 3000; ++round) {
    const Vec3 axis(uniform(random), uniform(random), uniform(random));
    const double angle = 3.0 * uniform(random);
    const Vec3 place(0.9 * uniform(random), 0.9 * uniform(random), 0.9 * uniform(random));
    for (const dGeomID geom : {convex, box}) {
      rotate(geom, axis, angle);
      dGeomSetPosition(geom, place.x(), place.y(), place.z());
    }
    const double ours = deepest(collide(convex, mesh));
    if (!(ours > 0.0)) continue;
    ++hits;
    longer += ours > 1.01 * deepest(collide(box, mesh)) ? 1 : 0;
  }
  EXPECT_GT(hits, 1000);
  EXPECT_LT(longer, hits / 300) << longer << " of " << hits;
}

// Under a tip that leans, the section that the floor makes has no depth: the tip is below the floor beside it.
TEST_F(ConvexTest, ATipIsAsDeepAsItGoesBelowTheFloor) {
  Arrays spike;
  for (const Vec3& corner :
       {Vec3(-0.3, -0.3, -0.3), Vec3(0.9, -0.3, -0.3), Vec3(-0.3, 0.9, -0.3), Vec3(-0.3, -0.3, 0.9)})
    spike.points.insert(spike.points.end(), corner.data(), corner.data() + 3);
  for (const auto& face : std::vector<std::vector<unsigned>>{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}})
    spike.add(face);
  const dGeomID convex = convex_of(spike);
  for (const std::uint32_t cells : {1u, 16u}) {
    const dGeomID floor = mesh_geom(box_shape(4, 4, 1, cells), space);
    dGeomOddsMeshSetCarryMotion(floor, 0);
    for (int round = 0; round < 300; ++round) {
      rotate(convex, Vec3(uniform(random), uniform(random), uniform(random)), 3.0 * uniform(random));
      dGeomSetPosition(convex, 0.5 * uniform(random), 0.5 * uniform(random), 0.0);
      dReal aabb[6];
      dGeomGetAABB(convex, aabb);
      const double depth = 0.01 + 0.005 * uniform(random);
      const dReal* const p = dGeomGetPosition(convex);
      dGeomSetPosition(convex, p[0], p[1], 0.5 - aabb[4] - depth);
      const auto contacts = collide(convex, floor);
      ASSERT_FALSE(contacts.empty()) << cells << " cells, round " << round;
      EXPECT_NEAR(contacts[0].depth, depth, 1e-6) << cells << " cells, round " << round;
      for (const dContactGeom& contact : contacts) {
        EXPECT_NEAR(contact.normal[2], 1.0, 1e-9) << cells << " cells, round " << round;
        EXPECT_NEAR(contact.pos[2], 0.5, 1e-9);
      }
    }
  }
}

TEST_F(ConvexTest, AConvexBoxAnswersLikeABox) {
  const Arrays arrays = cuboid(Vec3(0.25, 0.3, 0.35));
  const dGeomID convex = convex_of(arrays);
  const dGeomID box = dCreateBox(space, 0.5, 0.6, 0.7);
  const dGeomID mesh = mesh_geom(box_shape(0.8, 1.0, 1.2, 2), space);
  int hits = 0;
  int longer = 0;
  int shorter = 0;
  for (int round = 0; round < 500; ++round) {
    const Vec3 axis(uniform(random), uniform(random), uniform(random));
    const double angle = 3.0 * uniform(random);
    const Vec3 place(0.9 * uniform(random), uniform(random), 1.1 * uniform(random));
    for (const dGeomID geom : {convex, box}) {
      rotate(geom, axis, angle);
      dGeomSetPosition(geom, place.x(), place.y(), place.z());
    }
    const auto ours = collide(convex, mesh);
    const auto boxs = collide(box, mesh);
    expect_sound(ours, convex, mesh);
    ASSERT_EQ(ours.empty(), boxs.empty()) << "round " << round;
    if (ours.empty()) continue;
    ++hits;
    longer += ours[0].depth > 1.25 * boxs[0].depth + 1e-3 ? 1 : 0;
    shorter += ours[0].depth < 0.75 * boxs[0].depth - 1e-3 ? 1 : 0;
  }
  EXPECT_GT(hits, 200);
  EXPECT_LT(longer, hits / 20) << "a box tries all crossings of edges, a convex what the refinement finds";
  EXPECT_LT(shorter, hits / 20);
}

TEST_F(ConvexTest, OnATessellatedFloorItIsAsDeepAsItsLowestCorner) {
  const dGeomID floor = mesh_geom(box_shape(2, 2, 0.4, 16), space);
  for (const Arrays& arrays : {cuboid(Vec3(0.1, 0.15, 0.2)), ball(0.15)}) {
    const dGeomID convex = convex_of(arrays);
    for (int round = 0; round < 200; ++round) {
      rotate(convex, Vec3(uniform(random), uniform(random), uniform(random)), 3.0 * uniform(random));
      dGeomSetPosition(convex, 0.5 * uniform(random), 0.5 * uniform(random), 0.5);
      dReal aabb[6];
      dGeomGetAABB(convex, aabb);
      const dReal* p = dGeomGetPosition(convex);
      dGeomSetPosition(convex, p[0], p[1], p[2] - aabb[4] + 0.2 - 0.002);
      const auto contacts = collide(floor, convex);
      ASSERT_FALSE(contacts.empty()) << "round " << round;
      expect_sound(contacts, floor, convex);
      EXPECT_NEAR(contacts[0].depth, 0.002, 1e-9) << "round " << round;
      for (const dContactGeom& contact : contacts) EXPECT_NEAR(contact.normal[2], -1.0, 1e-9);
    }
  }
}

// A large triangle cut by all its sides has more corners than a piece keeps; of those left out none must be the
// deepest. A third of the coin was, once.
TEST_F(ConvexTest, ACoinOfManySidesIsAsDeepAsItsLowestCornerAllAround) {
  const dGeomID floor = mesh_geom(box_shape(2, 2, 0.2), space);
  dGeomOddsMeshSetCarryMotion(floor, 0);  // each collision stands alone
  constexpr double radius = 0.3;
  const ConvexCoin coin(space, radius, 0.05, 60);
  for (int round = 0; round < 300; ++round) {
    const Vec3 axis = Vec3(1e-3 * uniform(random), 1e-3 * uniform(random), 1.0).normalized();
    dMatrix3 leaning;
    dRFromZAxis(leaning, axis.x(), axis.y(), axis.z());
    dGeomSetRotation(coin.geom, leaning);
    const Vec3 center(0.5 * uniform(random), 0.5 * uniform(random), 0.125 - 1e-3);
    dGeomSetPosition(coin.geom, center.x(), center.y(), center.z());
    dQuaternion q;
    dGeomGetQuaternion(coin.geom, q);
    const double depth = 0.1 - (center.z() + coin.lowest(Quat(q[0], q[1], q[2], q[3])));
    const auto contacts = collide(floor, coin.geom);
    ASSERT_FALSE(contacts.empty()) << round;
    expect_sound(contacts, floor, coin.geom);
    EXPECT_NEAR(contacts[0].depth, depth, 0.01 * depth) << round;
    for (int i = 0; i < 12; ++i) {
      const Vec3 outwards(std::cos(i / 12.0 * 2.0 * std::numbers::pi), std::sin(i / 12.0 * 2.0 * std::numbers::pi),
                          0.0);
      double reach = 0.0;
      for (const dContactGeom& c : contacts) reach = std::max(reach, outwards.dot(position_of(c) - center));
      EXPECT_GT(reach, 0.8 * radius) << round << ", " << i;
    }
  }
}

TEST_F(ConvexTest, CrossedEdgesArePushedApartAcrossBoth) {
  const dGeomID mesh = mesh_geom(box_shape(1, 0.2, 0.2), space);
  rotate(mesh, Vec3(1, 0, 0), M_PI / 4);  // its upper edge runs along x
  const Arrays arrays = cuboid(Vec3(0.1, 0.5, 0.1));
  const dGeomID convex = convex_of(arrays);
  rotate(convex, Vec3(0, 1, 0), M_PI / 4);  // its lower edge runs along y
  dGeomSetPosition(convex, 0.13, 0.07, 0.2 * std::sqrt(2.0) - 0.01);
  const auto contacts = collide(convex, mesh);
  ASSERT_FALSE(contacts.empty());
  EXPECT_NEAR(contacts[0].normal[2], 1.0, 1e-3);
  EXPECT_NEAR(contacts[0].depth, 0.01, 1e-4);
  EXPECT_NEAR(contacts[0].pos[0], 0.13, 1e-3);
  EXPECT_NEAR(contacts[0].pos[1], 0.0, 1e-3);
}

// A quarter of those of 0.1 mm lacked the direction between two edges.
TEST_F(ConvexTest, SmallOnesAreHeldLikeLargeOnes) {
  const double small = std::ldexp(1.0, -13);
  const auto shape = [](double scale) {
    return shape_of(mesh::made::Icosphere{.radius = 0.6 * scale, .frequency = 4});
  };
  const std::array<dGeomID, 2> meshes = {mesh_geom(shape(1.0), space), mesh_geom(shape(small), space)};
  std::deque<Arrays> arrays;  // ODE keeps pointers to them
  int touching = 0;
  for (int round = 0; round < 200; ++round) {
    const Vec3 half(0.3 + 0.2 * uniform(random), 0.3 + 0.2 * uniform(random), 0.3 + 0.2 * uniform(random));
    const Vec3 place(uniform(random), uniform(random), uniform(random));
    const Vec3 axis(uniform(random), uniform(random), 1.5);
    const double angle = 3.0 * uniform(random);
    std::array<std::vector<dContactGeom>, 2> found;
    for (std::size_t i = 0; i < 2; ++i) {
      const double scale = i == 0 ? 1.0 : small;
      arrays.push_back(cuboid(scale * half));
      const dGeomID convex = convex_of(arrays.back());
      rotate(convex, axis, angle);
      dGeomSetPosition(convex, scale * place.x(), scale * place.y(), scale * place.z());
      found[i] = collide(convex, meshes[i]);
    }
    ASSERT_EQ(found[0].size(), found[1].size()) << "round " << round;
    touching += found[0].empty() ? 0 : 1;
    for (std::size_t k = 0; k < found[0].size(); ++k) {
      EXPECT_EQ(small * found[0][k].depth, found[1][k].depth) << "round " << round;
      EXPECT_EQ(normal_of(found[0][k]), normal_of(found[1][k])) << "round " << round;
    }
  }
  EXPECT_GT(touching, 50);
}

TEST_F(ConvexTest, SwallowedByAClosedMeshItIsPushedOut) {
  const dGeomID mesh = mesh_geom(box_shape(2, 2, 2, 4), space);
  const Arrays arrays = cuboid(Vec3(0.1, 0.1, 0.1));
  const dGeomID convex = convex_of(arrays);
  dGeomSetPosition(convex, 0.1, 0.2, 0.6);
  const auto contacts = collide(convex, mesh);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR(contacts[0].normal[2], 1.0, 1e-9);
  EXPECT_NEAR(contacts[0].depth, 0.5, 1e-9);
}

TEST_F(ConvexTest, WhatIsNoConvexSolidIsRefused) {
  Arrays arrays = cuboid(Vec3(1, 1, 1));
  const dGeomID geom = convex_of(arrays);
  const auto refused = [&](const Arrays& tried, unsigned points, unsigned faces) {
    EXPECT_EQ(oddsRegisterConvex(geom, tried.points.data(), points, tried.polygons.data(), faces), 0);
    return std::string(oddsGetLastError());
  };
  Arrays dented = arrays;
  dented.points[0] = dented.points[1] = dented.points[2] = 0.5;
  EXPECT_NE(refused(dented, 8, 6).find("not convex"), std::string::npos) << oddsGetLastError();
  Arrays infinite = arrays;
  infinite.points[4] = NAN;
  EXPECT_NE(refused(infinite, 8, 6).find("finite"), std::string::npos);
  Arrays wrong = arrays;
  wrong.polygons[1] = 8;
  EXPECT_NE(refused(wrong, 8, 6).find("range"), std::string::npos);
  Arrays flat = arrays;
  for (unsigned i = 0; i < 8; ++i) flat.points[3 * i + 2] = 0;
  EXPECT_NE(refused(flat, 8, 6), "");
  EXPECT_NE(refused(arrays, 3, 6), "");
  EXPECT_NE(refused(arrays, 8, 5).find("not closed"), std::string::npos) << "it had contacts beyond its open side";
  EXPECT_NE(refused(arrays, -1U, 6).find("oddsRegisterConvex: more than 4096 points"), std::string::npos);
  EXPECT_EQ(oddsRegisterConvex(nullptr, arrays.points.data(), 8, arrays.polygons.data(), 6), 0);
  EXPECT_EQ(oddsRegisterConvex(dCreateSphere(space, 1), arrays.points.data(), 8, arrays.polygons.data(), 6), 0);
}

TEST_F(ConvexTest, FacesMayBePartedWithoutSharedCorners) {
  Arrays arrays = cuboid(Vec3(1, 1, 1));
  arrays.points.insert(arrays.points.end(), {0, 1, 1});  // on an edge that only one of its faces knows of
  arrays.polygons.resize(arrays.polygons.size() - 5);    // the last one, of corners 4, 5, 7, 6
  arrays.planes.resize(arrays.planes.size() - 4);
  --arrays.faces;
  arrays.add({4, 5, 7, 8});
  arrays.add({4, 8, 6});
  convex_of(arrays);  // expects that it is taken
}

TEST_F(ConvexTest, AnotherGeomAtTheSameAddressIsFoundOut) {
  const dGeomID mesh = mesh_geom(box_shape(1, 1, 1), space);
  const Arrays arrays = cuboid(Vec3(0.3, 0.3, 0.3));
  const Arrays other = cuboid(Vec3(0.2, 0.3, 0.3));
  const dGeomID convex = convex_of(arrays);
  dGeomSetPosition(convex, 0.7, 0, 0);
  EXPECT_FALSE(collide(convex, mesh).empty());
  dGeomSetConvex(convex, other.planes.data(), other.faces, other.points.data(), other.count(), other.polygons.data());
  dGeomSetPosition(convex, 0.7, 0, 0);
  EXPECT_TRUE(collide(convex, mesh).empty());
  EXPECT_EQ(stats().changed_partners, 1u);
  EXPECT_EQ(oddsForgetGeom(convex), 1);
  EXPECT_EQ(oddsForgetGeom(convex), 0);
  EXPECT_TRUE(collide(convex, mesh).empty());
  EXPECT_EQ(stats().unsupported, 2u);
}

// ODE's box is that of its own rotation, which of a geom without a body is as rigid as the client made it.
TEST_F(ConvexTest, ARoundedRotationIsNoOtherGeom) {
  const dGeomID mesh = mesh_geom(box_shape(1, 1, 1), space);
  const Arrays arrays = cuboid(Vec3(0.3, 0.3, 0.3));
  const dGeomID convex = convex_of(arrays);
  const dQuaternion rounded = {0.9239, 0, 0, 0.3827};
  dGeomSetQuaternion(convex, rounded);
  dGeomSetPosition(convex, 0.7, 0, 0);
  EXPECT_FALSE(collide(convex, mesh).empty());
  const dMatrix3 by_hand = {0.7071, -0.7071, 0, 0, 0.7071, 0.7071, 0, 0, 0, 0, 1, 0};
  dGeomSetRotation(convex, by_hand);
  EXPECT_FALSE(collide(convex, mesh).empty());
  EXPECT_EQ(stats().changed_partners, 0u);
}

// dGeomSetConvex leaves ODE's box around the geom as it was until it moves, so that the new points seemed to be those
// of another geom.
TEST_F(ConvexTest, OtherPointsServeAtOnce) {
  const Arrays small = cuboid(Vec3::Constant(0.1));
  const Arrays large = cuboid(Vec3::Constant(0.3));
  const dWorldID world = dWorldCreate();
  for (const bool on_body : {false, true}) {
    const dGeomID mesh = mesh_geom(box_shape(1.0, 1.0, 1.0, 2), space);
    const dGeomID geom = convex_of(small);
    const Vec3 place(0.1, -0.2, 0.75);
    dBodyID body = nullptr;
    if (on_body) {
      body = dBodyCreate(world);
      dGeomSetBody(geom, body);
      dGeomSetOffsetPosition(geom, 0.01, 0.02, 0.03);
      dBodySetPosition(body, place.x() - 0.01, place.y() - 0.02, place.z() - 0.03);
      dBodySetLinearVel(body, 1.0, 2.0, 3.0);
    } else {
      dGeomSetPosition(geom, place.x(), place.y(), place.z());
    }
    dContactGeom contacts[8];
    EXPECT_EQ(dCollide(mesh, geom, 8, contacts, sizeof(dContactGeom)), 0);
    dGeomSetConvex(geom, large.planes.data(), large.faces, large.points.data(), large.count(), large.polygons.data());
    ASSERT_EQ(oddsRegisterConvex(geom, large.points.data(), large.count(), large.polygons.data(), large.faces), 1);
    EXPECT_GT(dCollide(mesh, geom, 8, contacts, sizeof(dContactGeom)), 0) << on_body;
    EXPECT_NEAR(contacts[0].depth, 0.05, 1e-9);
    const dReal* const at = dGeomGetPosition(geom);
    EXPECT_NEAR((Vec3(at[0], at[1], at[2]) - place).norm(), 0.0, 1e-15);
    if (body != nullptr) {
      EXPECT_EQ(dBodyGetLinearVel(body)[2], 3.0);
    }
    oddsForgetGeom(geom);
    known.clear();
    dGeomDestroy(geom);
    dGeomDestroy(mesh);
  }
  dWorldDestroy(world);
}

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"  // transforms are old, and still used
// Where no space cleans the transform, ODE leaves the box of the geom within it where it was.
TEST_F(ConvexTest, InATransformThatIsInNoSpaceItIsNoOtherGeomWhereverThatGoes) {
  const Arrays arrays = cuboid(Vec3(0.3, 0.25, 0.2));
  const dGeomID transform = dCreateGeomTransform(nullptr);
  const dGeomID mesh = mesh_geom(box_shape(1, 1, 1, 3), space);
  const dGeomID convex = convex_of(arrays);
  dSpaceRemove(space, convex);
  dGeomTransformSetGeom(transform, convex);
  for (const double z : {0.6, 0.55, 5.0, 0.6}) {
    dGeomSetPosition(transform, 0, 0, z);
    EXPECT_EQ(collide(mesh, transform).empty(), z > 1.0) << z;
  }
  EXPECT_EQ(stats().changed_partners, 0u);
  const Arrays larger = cuboid(Vec3(0.4, 0.25, 0.2));
  dGeomSetConvex(convex, larger.planes.data(), larger.faces, larger.points.data(), larger.count(),
                 larger.polygons.data());
  dGeomGetAABB(transform, std::array<dReal, 6>{}.data());
  dGeomSetPosition(transform, 0, 0, 0.5);
  dGeomGetAABB(transform, std::array<dReal, 6>{}.data());
  EXPECT_TRUE(collide(mesh, transform).empty());
  EXPECT_EQ(stats().changed_partners, 1u) << "and another one is";
  dGeomDestroy(transform);
  oddsForgetGeom(convex);
  dGeomDestroy(convex);
  known.clear();
}
#pragma GCC diagnostic pop

TEST_F(ConvexTest, AnExhaustedBudgetIsCountedAndSound) {
  const dGeomID mesh = mesh_geom(sphere_shape(1, 20), space);
  const Arrays arrays = cuboid(Vec3(0.5, 0.5, 0.5));
  const dGeomID convex = convex_of(arrays);
  dGeomSetPosition(convex, 1.2, 0, 0);
  ASSERT_EQ(dGeomOddsMeshSetWorkBudget(mesh, 2), 1);
  expect_sound(collide(mesh, convex), mesh, convex);
  EXPECT_EQ(stats().primitive_cut_off, 1u);
}

// Climbing along edges finds the corner that looking at all of them does.
TEST(ConvexShapes, TheFarthestCornerIsFarthestOfAll) {
  std::mt19937 random(17);
  std::normal_distribution<double> normal;
  for (const std::uint32_t frequency : {1u, 3u, 7u}) {
    const auto ball = make(mesh::made::Icosphere{.frequency = frequency}).value();
    std::vector<Vec3> points(ball.vertices().begin(), ball.vertices().end());
    for (Vec3& point : points) point = Vec3(2.0 * point.x() + 5.0, point.y(), 0.3 * point.z());  // long and flat
    std::vector<unsigned> polygons;
    for (const mesh::Triangle& t : ball.triangles()) polygons.insert(polygons.end(), {3u, t[0], t[1], t[2]});
    const auto shape = ode::ConvexShape::make(points, polygons.data(), ball.triangles().size());
    ASSERT_TRUE(shape.ok()) << shape.error().message();
    for (int i = 0; i < 2000; ++i) {
      Vec3 direction(normal(random), normal(random), normal(random));
      if (i % 5 == 0) direction[i % 3] = 0.0;
      if (i % 7 == 0) direction = i % 2 == 0 ? Vec3::Unit(i % 3) : Vec3(-Vec3::Unit(i % 3));
      double farthest = -std::numeric_limits<double>::infinity();
      for (const Vec3& point : points) farthest = std::max(farthest, direction.dot(point));
      EXPECT_NEAR(direction.dot(shape.value()->farthest(direction)), farthest, 1e-12);
    }
  }
}

// Of more corners than there is room for, the lowest are kept.
TEST(ConvexShapes, FeaturesAreTheLowestCorners) {
  const auto ball = make(mesh::made::Icosphere{.frequency = 7}).value();
  std::vector<Vec3> points(ball.vertices().begin(), ball.vertices().end());
  std::vector<unsigned> polygons;
  for (const mesh::Triangle& t : ball.triangles()) polygons.insert(polygons.end(), {3u, t[0], t[1], t[2]});
  const auto shape = ode::ConvexShape::make(points, polygons.data(), ball.triangles().size()).value();
  const Vec3 up = Vec3(0.2, -0.3, 1.0).normalized();
  ode::Features features;
  shape->add_features(up, 1.0, features);
  ASSERT_EQ(features.corner_count, ode::Features::most);
  std::vector<double> heights;
  for (const Vec3& point : points) heights.push_back(up.dot(point));
  std::sort(heights.begin(), heights.end());
  for (std::size_t i = 0; i < features.corner_count; ++i) {
    EXPECT_LE(up.dot(features.corners[i]), heights[features.corner_count - 1]);
  }
}

}  // namespace
}  // namespace odds::test
