// Mesh against plane: exact depths, and contacts that span the footprint.
#include <algorithm>
#include <cmath>
#include <random>

#include "odds/math/pose.hpp"
#include "ode/ode_fixture.hpp"

namespace odds::test {
namespace {

math::Pose pose_of(dGeomID geom) {
  const dReal* p = dGeomGetPosition(geom);
  const dReal* r = dGeomGetRotation(geom);
  math::Pose pose;
  pose.translation = Vec3(p[0], p[1], p[2]);
  pose.rotation << r[0], r[1], r[2], r[4], r[5], r[6], r[8], r[9], r[10];
  return pose;
}

Vec3 random_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Vec3(normal(random), normal(random), normal(random)).normalized();
}

class PlaneTest : public OdeTest {
 protected:
  std::mt19937 random{11};
};

TEST_F(PlaneTest, DeepestVertexAndAllDepthsAreExact) {
  const auto shape = sphere_shape(0.5, 6);
  const dGeomID mesh = mesh_geom(shape, space);
  std::uniform_real_distribution<double> uniform(-0.6, 0.6);
  int hits = 0;
  for (int round = 0; round < 300; ++round) {
    const Vec3 normal = random_direction(random);
    const double offset = uniform(random);
    const dGeomID plane = dCreatePlane(nullptr, normal.x(), normal.y(), normal.z(), offset);
    rotate(mesh, random_direction(random), 3.0 * uniform(random));
    dGeomSetPosition(mesh, uniform(random), uniform(random), uniform(random));
    const math::Pose pose = pose_of(mesh);
    double deepest = -1.0;
    for (const Vec3& vertex : shape->mesh().vertices()) deepest = std::max(deepest, offset - normal.dot(pose * vertex));
    const auto contacts = collide(mesh, plane);
    EXPECT_EQ(contacts.empty(), deepest < 0.0);
    expect_sound(contacts, mesh, plane);
    if (!contacts.empty()) {
      ++hits;
      EXPECT_NEAR(contacts[0].depth, deepest, 2e-6 * shape->mesh().size()) << "first among equals";
    }
    for (const dContactGeom& contact : contacts) {
      EXPECT_NEAR(contact.depth, offset - normal.dot(position_of(contact)), 1e-12);
      EXPECT_LT((normal_of(contact) - normal).norm(), 1e-12);
      const Vec3 local = pose.inverse() * position_of(contact);
      const auto& triangle = shape->mesh().triangles()[static_cast<std::size_t>(contact.side1)];
      const auto is_it = [&](std::uint32_t v) { return (shape->mesh().vertices()[v] - local).norm() < 1e-12; };
      EXPECT_TRUE(std::any_of(triangle.begin(), triangle.end(), is_it)) << "a vertex of the triangle that side1 names";
    }
    dGeomDestroy(plane);
  }
  EXPECT_GT(hits, 100);
}

TEST_F(PlaneTest, AMeshBoxIsAsDeepAsOdesBox) {
  const dGeomID mesh = mesh_geom(box_shape(0.4, 0.6, 0.8, 5), space);
  const dGeomID box = dCreateBox(space, 0.4, 0.6, 0.8);
  const dGeomID plane = dCreatePlane(space, 0, 0, 1, 0);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int round = 0; round < 300; ++round) {
    for (const dGeomID geom : {mesh, box}) dGeomSetPosition(geom, 0, 0, 0.35);
    const Vec3 axis = random_direction(random);
    const double angle = 3.0 * uniform(random);
    for (const dGeomID geom : {mesh, box}) rotate(geom, axis, angle);
    const auto ours = collide(mesh, plane);
    const auto odes = collide(box, plane);
    ASSERT_EQ(ours.empty(), odes.empty());
    if (ours.empty()) continue;
    const auto depth = [](const dContactGeom& x, const dContactGeom& y) { return x.depth < y.depth; };
    EXPECT_NEAR(std::max_element(ours.begin(), ours.end(), depth)->depth,
                std::max_element(odes.begin(), odes.end(), depth)->depth, 2e-6);
  }
}

TEST_F(PlaneTest, AFlatBottomIsHeldAtItsFourCornersOnly) {
  const dGeomID mesh = mesh_geom(box_shape(0.4, 0.6, 0.2, 10), space);
  const dGeomID plane = dCreatePlane(space, 0, 0, 1, 0);
  dGeomSetPosition(mesh, 3, 4, 0.099);
  rotate(mesh, Vec3(0, 0, 1), 0.4);
  const auto contacts = collide(mesh, plane);
  ASSERT_EQ(contacts.size(), 4u) << "points between the corners add nothing";
  for (const dContactGeom& contact : contacts) {
    EXPECT_NEAR(contact.depth, 0.001, 1e-12);
    EXPECT_NEAR((position_of(contact) - Vec3(3, 4, -0.001)).norm(), std::hypot(0.2, 0.3), 1e-9);
  }
}

TEST_F(PlaneTest, TwoContactsOfFourAreTheFarthestApart) {
  const dGeomID mesh = mesh_geom(box_shape(0.4, 0.6, 0.2, 3), space);
  const dGeomID plane = dCreatePlane(space, 0, 0, 1, 0);
  dGeomSetPosition(mesh, 0, 0, 0.099);
  const auto contacts = collide(mesh, plane, 2);
  ASSERT_EQ(contacts.size(), 2u);
  EXPECT_NEAR((position_of(contacts[0]) - position_of(contacts[1])).norm(), std::hypot(0.4, 0.6), 1e-9);
}

TEST_F(PlaneTest, EdgeTwoContactsCornerOne) {
  const dGeomID mesh = mesh_geom(box_shape(1, 1, 1, 4), space);
  const dGeomID plane = dCreatePlane(space, 0, 0, 1, 0);
  rotate(mesh, Vec3(1, 0, 0), M_PI / 4);
  dGeomSetPosition(mesh, 0, 0, std::sqrt(0.5) - 0.01);
  auto contacts = collide(mesh, plane);
  ASSERT_EQ(contacts.size(), 2u);
  for (const dContactGeom& contact : contacts) EXPECT_NEAR(contact.depth, 0.01, 1e-9);
  rotate(mesh, Vec3(1, -1, 0), std::acos(std::sqrt(1.0 / 3.0)));  // a diagonal stands upright
  const math::Pose pose = pose_of(mesh);
  double lowest = 0.0;
  for (int c = 0; c < 8; ++c) {
    lowest = std::min(lowest, (pose.rotation * Vec3(c & 1 ? .5 : -.5, c & 2 ? .5 : -.5, c & 4 ? .5 : -.5)).z());
  }
  dGeomSetPosition(mesh, 0, 0, -lowest - 0.01);
  contacts = collide(mesh, plane);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR(contacts[0].depth, 0.01, 1e-9);
}

// The deepest vertex lies within the others' outline here; beyond its sides lay vertices that were taken already.
TEST_F(PlaneTest, NoVertexIsGivenTwice) {
  const dGeomID plane = dCreatePlane(space, 0, 0, 1, 0);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int full = 0;
  for (const dGeomID mesh : {mesh_geom(box_shape(1, 1.4, 1.8), space), mesh_geom(sphere_shape(0.9, 6), space)}) {
    for (int round = 0; round < 300; ++round) {
      rotate(mesh, random_direction(random), 3.0 * uniform(random));
      dGeomSetPosition(mesh, 0, 0, uniform(random));
      const auto contacts = collide(mesh, plane);
      full += contacts.size() == 8 ? 1 : 0;
      for (std::size_t i = 0; i < contacts.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
          ASSERT_GT((position_of(contacts[i]) - position_of(contacts[k])).norm(), 1e-6) << i << " and " << k;
        }
      }
    }
  }
  EXPECT_GT(full, 100);
}

// Each corner of its lower side has one of the upper side right above it.
TEST_F(PlaneTest, APlateWhollyBelowIsHeldByItsLowerSide) {
  std::uniform_real_distribution<double> uniform(-3.0, 3.0);
  for (int round = 0; round < 100; ++round) {
    const math::Pose in_mesh = {Eigen::AngleAxisd(uniform(random), random_direction(random)).toRotationMatrix(),
                                Vec3(uniform(random), uniform(random), uniform(random))};
    const auto plate = box_shape(1, 0.8, 0.04);
    std::vector<Vec3> vertices;
    for (const Vec3& vertex : plate->mesh().vertices()) vertices.push_back(in_mesh * vertex);
    auto turned =
        mesh::TriangleMesh::make(vertices, {plate->mesh().triangles().begin(), plate->mesh().triangles().end()});
    const dGeomID mesh =
        mesh_geom(query::Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(turned).value())).value());
    const Vec3 normal = in_mesh.rotation.col(2);
    const dGeomID plane =
        dCreatePlane(nullptr, normal.x(), normal.y(), normal.z(), normal.dot(in_mesh.translation) + 0.05);
    const auto contacts = collide(mesh, plane);
    EXPECT_EQ(contacts.size(), 4u);
    for (const dContactGeom& contact : contacts) EXPECT_NEAR(contact.depth, 0.07, 1e-9);
    dGeomDestroy(mesh);
    dGeomDestroy(plane);
  }
}

TEST_F(PlaneTest, VerticesThatNoTriangleUsesDoNotTouch) {
  auto mesh = mesh::TriangleMesh::make({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -5}}, {{0, 1, 2}});
  ASSERT_TRUE(mesh.ok());
  auto shape = query::Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value()));
  ASSERT_TRUE(shape.ok());
  const dGeomID geom = mesh_geom(shape.value(), space);
  const dGeomID plane = dCreatePlane(space, 0, 0, 1, -1);
  EXPECT_TRUE(collide(geom, plane).empty());
}

// More vertices lie below than are gathered: each contact is searched for then.
TEST_F(PlaneTest, AFineBodyDeepBelowIsHeldAroundItsOutline) {
  const auto shape = sphere_shape(1, 60);
  const dGeomID mesh = mesh_geom(shape, space);
  ASSERT_EQ(dGeomOddsMeshSetBudget(mesh, 1e9), 1);
  std::uniform_real_distribution<double> uniform(-0.8, 0.0);
  for (int round = 0; round < 50; ++round) {
    const Vec3 normal = random_direction(random);
    const double offset = uniform(random);
    const dGeomID plane = dCreatePlane(nullptr, normal.x(), normal.y(), normal.z(), offset);
    rotate(mesh, random_direction(random), 3.0 * uniform(random));
    const math::Pose pose = pose_of(mesh);
    double deepest = -1.0;
    for (const Vec3& vertex : shape->mesh().vertices()) deepest = std::max(deepest, offset - normal.dot(pose * vertex));
    const auto contacts = collide(mesh, plane, 8);
    ASSERT_EQ(contacts.size(), 8u);
    EXPECT_NEAR(contacts[0].depth, deepest, 2e-6 * shape->mesh().size());
    const double radius = std::sqrt(1.0 - offset * offset);
    for (std::size_t i = 1; i < contacts.size(); ++i) {
      const Vec3 place = position_of(contacts[i]);
      EXPECT_NEAR(contacts[i].depth, offset - normal.dot(place), 1e-12);
      const double out = (place - normal.dot(place) * normal).norm();
      EXPECT_GT(out, radius - 0.1) << "on the outline, but for a triangle's length and what is rough of many";
    }
    dGeomDestroy(plane);
  }
}

// As STL files have it: no vertex is common to two triangles.
TEST_F(PlaneTest, AMeshThatRepeatsItsVerticesHasTheSameContacts) {
  const auto shape = sphere_shape(1, 12);
  std::vector<Vec3> vertices;
  std::vector<mesh::Triangle> triangles;
  for (const mesh::Triangle& t : shape->mesh().triangles()) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (const std::uint32_t v : t) vertices.push_back(shape->mesh().vertices()[v]);
    triangles.push_back({first, first + 1, first + 2});
  }
  auto repeated = mesh::TriangleMesh::make(vertices, triangles);
  const dGeomID mesh = mesh_geom(shape, space);
  const dGeomID other = mesh_geom(
      query::Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(repeated).value())).value(), space);
  for (const dGeomID geom : {mesh, other}) ASSERT_EQ(dGeomOddsMeshSetBudget(geom, 1e9), 1);
  std::uniform_real_distribution<double> uniform(-0.95, -0.5);
  for (int round = 0; round < 100; ++round) {
    const Vec3 normal = random_direction(random);
    const dGeomID plane = dCreatePlane(nullptr, normal.x(), normal.y(), normal.z(), uniform(random));
    const auto contacts = collide(mesh, plane);
    const auto of_other = collide(other, plane);
    ASSERT_EQ(contacts.size(), of_other.size());
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      EXPECT_LT((position_of(contacts[i]) - position_of(of_other[i])).norm(), 1e-12) << round;
    }
    dGeomDestroy(plane);
  }
}

// What is taken of many may be a little less far out than another, which then made a corner of it point inwards.
TEST_F(PlaneTest, OfManyVerticesNoneIsGivenTwice) {
  constexpr std::uint32_t cells = 60;
  std::vector<Vec3> vertices;
  std::vector<mesh::Triangle> triangles;
  for (std::uint32_t i = 0; i <= cells; ++i) {
    for (std::uint32_t k = 0; k <= cells; ++k) {
      vertices.emplace_back(1.0 * i / cells, 1.0 * k / cells, 0.02 * std::sin(0.9 * i) * std::cos(1.3 * k));
      const std::uint32_t v = i * (cells + 1) + k;
      if (i == cells || k == cells) continue;
      triangles.push_back({v, v + cells + 1, v + 1});
      triangles.push_back({v + 1, v + cells + 1, v + cells + 2});
    }
  }
  auto sheet = mesh::TriangleMesh::make(std::move(vertices), std::move(triangles));
  const dGeomID mesh = mesh_geom(
      query::Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(sheet).value())).value(), space);
  ASSERT_EQ(dGeomOddsMeshSetBudget(mesh, 1e9), 1);
  const dGeomID plane = dCreatePlane(space, 0, 0, 1, 0);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int round = 0; round < 400; ++round) {
    rotate(mesh, random_direction(random), 3.0 * uniform(random));
    const Vec3 middle = pose_of(mesh).rotation * Vec3(0.5, 0.5, 0.0);
    dGeomSetPosition(mesh, 0, 0, 0.3 * uniform(random) - middle.z());
    const auto contacts = collide(mesh, plane);
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        ASSERT_GT((position_of(contacts[i]) - position_of(contacts[k])).norm(), 1e-6)
            << round << ": " << i << ", " << k;
      }
    }
  }
}

// Of 1,681 vertices that are all as deep as each other; which of them hold the body must not depend on the last bits.
TEST_F(PlaneTest, AFineBottomThatStandsIsHeldAtItsFourCornersOnly) {
  const dGeomID mesh = mesh_geom(box_shape(1, 1, 0.1, 40), space);
  const dGeomID plane = dCreatePlane(space, 0, 0, 1, 0);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  ASSERT_EQ(dGeomOddsMeshSetWorkBudget(mesh, 600), 1) << "no leaf is looked at for being as deep as another";
  for (int round = 0; round < 200; ++round) {
    const math::Pose turned = {Eigen::AngleAxisd(0.7 + 1e-9 * uniform(random), Vec3::UnitZ()).toRotationMatrix(),
                               Vec3::Zero()};
    rotate(mesh, Vec3::UnitZ(), 0.7 + 1e-9 * uniform(random));
    dGeomSetPosition(mesh, 0, 0, 0.05 - 1e-4 * (1.0 + 0.5 * uniform(random)));
    const auto contacts = collide(mesh, plane);
    ASSERT_EQ(contacts.size(), 4u);
    for (const dContactGeom& contact : contacts) {
      const Vec3 local = turned.rotation.transpose() * position_of(contact);
      EXPECT_NEAR(std::abs(local.x()), 0.5, 1e-6);
      EXPECT_NEAR(std::abs(local.y()), 0.5, 1e-6);
    }
  }
  EXPECT_EQ(stats().primitive_cut_off, 0u);
}

TEST_F(PlaneTest, AShortBudgetStillFindsOneNearlyAsDeepAsAny) {
  const auto shape = sphere_shape(1, 60);
  const dGeomID mesh = mesh_geom(shape, space);
  std::uniform_real_distribution<double> uniform(-0.999, 0.5);
  for (const unsigned long units : {100UL, 300UL}) {
    ASSERT_EQ(dGeomOddsMeshSetWorkBudget(mesh, units), 1);
    for (int round = 0; round < 100; ++round) {
      const Vec3 normal = random_direction(random);
      const double offset = uniform(random);
      const dGeomID plane = dCreatePlane(nullptr, normal.x(), normal.y(), normal.z(), offset);
      double deepest = -1.0;
      for (const Vec3& vertex : shape->mesh().vertices()) deepest = std::max(deepest, offset - normal.dot(vertex));
      const auto contacts = collide(mesh, plane);
      dGeomDestroy(plane);
      ASSERT_EQ(contacts.empty(), deepest < 0.0);
      if (contacts.empty()) continue;
      EXPECT_LE(contacts[0].depth, deepest + 1e-12);
      EXPECT_GT(contacts[0].depth, deepest - 0.05) << "metres, of 1; units: " << units;
    }
  }
  EXPECT_GT(stats().primitive_cut_off, 50u);
}

TEST_F(PlaneTest, AnExhaustedWorkBudgetIsCountedAndStillSound) {
  const dGeomID mesh = mesh_geom(sphere_shape(1, 20), space);
  const dGeomID plane = dCreatePlane(space, 0, 0, 1, 0);
  ASSERT_EQ(dGeomOddsMeshSetWorkBudget(mesh, 30), 1);
  const auto contacts = collide(mesh, plane);
  EXPECT_EQ(stats().primitive_cut_off, 1u);
  expect_sound(contacts, mesh, plane);
}

}  // namespace
}  // namespace odds::test
