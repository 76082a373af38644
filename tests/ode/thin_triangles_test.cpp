// Triangles that are nothing but the rounding of their corners, as files have them where edges of unlike length meet:
// their normals point anywhere.
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "odds/math/random.hpp"
#include "ode/known_convexes.hpp"
#include "ode/ode_fixture.hpp"

namespace odds::test {
namespace {

/// A slab, 2 m x 2 m x 0.5 m, turned, some of whose edges have a corner on one side only: a triangle without area, but
/// for its corners, which are rounded to floats, closes it there.
std::shared_ptr<const query::Shape> slab_with_thin_triangles(const Mat3& turn, math::Random& random) {
  const mesh::TriangleMesh slab = make(mesh::made::Box{.x = 2.0, .y = 2.0, .z = 0.5}).value();
  std::vector<Vec3> corners(slab.vertices().begin(), slab.vertices().end());
  std::vector<mesh::Triangle> triangles(slab.triangles().begin(), slab.triangles().end());
  for (Vec3& corner : corners) corner = turn * corner;
  for (int i = 0; i < 9; ++i) {
    mesh::Triangle& cut = triangles[random.below(triangles.size())];
    const auto [a, b, c] = cut;
    if ((corners[b] - corners[a]).cross(corners[c] - corners[a]).norm() < 1e-6) continue;
    const auto between = static_cast<std::uint32_t>(corners.size());
    corners.push_back(corners[a] + random.uniform(0.1, 0.9) * (corners[b] - corners[a]));
    cut = {a, between, c};
    triangles.push_back({between, b, c});
    triangles.push_back({a, b, between});
  }
  for (Vec3& corner : corners) corner = corner.cast<float>().cast<double>();
  auto made = mesh::TriangleMesh::make(std::move(corners), std::move(triangles), "slab").value();
  return query::Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(made))).value();
}

class ThinTriangles : public OdeTest {};

// Those that were nearest to a capsule's axis, by the last bits of floats, said that it was in the slab: it was pushed
// through, by a metre.
TEST_F(ThinTriangles, DoNotDrawACapsuleThroughAFloor) {
  math::Random random(6);
  int turned = 0;
  for (int i = 0; i < 1000; ++i) {
    const Mat3 turn = random.rotation().toRotationMatrix();
    const Vec3 up = turn.col(2);
    const dGeomID slab = mesh_geom(slab_with_thin_triangles(turn, random));
    const dGeomID capsule = dCreateCapsule(nullptr, 0.2, 1.0);
    const Vec3 place = turn * Vec3(random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), 0.25 + 0.2 - 1e-3);
    dGeomSetPosition(capsule, place.x(), place.y(), place.z());
    const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
    const Vec3 axis = turn * Vec3(std::cos(angle), std::sin(angle), 0.0);
    dMatrix3 lying;
    dRFromZAxis(lying, axis.x(), axis.y(), axis.z());
    dGeomSetRotation(capsule, lying);
    const auto contacts = collide(slab, capsule);
    EXPECT_GE(contacts.size(), 1U) << i;
    for (const dContactGeom& contact : contacts) {
      turned += normal_of(contact).dot(up) > -0.9 ? 1 : 0;  // into the slab
      EXPECT_LT(contact.depth, 2e-3) << i;
    }
    dGeomDestroy(capsule);
    dGeomDestroy(slab);
  }
  EXPECT_EQ(turned, 0);
}

// Each was a patch of its own: a box stood on a flat top with one contact sideways, 1.8 mm deep, and cylinders and
// convexes were pushed along what the mean of such normals and the right ones was.
TEST_F(ThinTriangles, DoNotTurnTheWayOutOfAFlatTop) {
  math::Random random(7);
  const double half = 0.25;  // of all bodies; of the slab's height, too
  const ConvexCoin coin(space, half, 2.0 * half, 6);
  const std::array<dGeomID, 3> bodies = {dCreateBox(space, 2.0 * half, 2.0 * half, 2.0 * half),
                                         dCreateCylinder(space, half, 2.0 * half), coin.geom};
  int turned = 0;
  for (int i = 0; i < 3000; ++i) {
    const Mat3 turn = random.rotation().toRotationMatrix();
    const dGeomID slab = mesh_geom(slab_with_thin_triangles(turn, random));
    dGeomOddsMeshSetCarryMotion(slab, 0);  // each collision stands alone
    const dGeomID body = bodies[static_cast<std::size_t>(i) % bodies.size()];
    const Vec3 lean(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), 1.0);
    const Vec3 axis = turn * lean.normalized();
    dMatrix3 standing;
    dRFromZAxis(standing, axis.x(), axis.y(), axis.z());
    dGeomSetRotation(body, standing);
    const Vec3 place = turn * Vec3(random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), half + half - 1e-3);
    dGeomSetPosition(body, place.x(), place.y(), place.z());
    const auto contacts = collide(slab, body);
    EXPECT_GE(contacts.size(), 1U) << i;
    for (const dContactGeom& contact : contacts) {
      turned += normal_of(contact).dot(turn.col(2)) > -0.9999 ? 1 : 0;
      EXPECT_LT(contact.depth, 1e-3 + half * std::sqrt(2.0) * std::sin(lean.head<2>().norm())) << i;
    }
    dGeomDestroy(slab);
  }
  EXPECT_EQ(turned, 0);
}

}  // namespace
}  // namespace odds::test
