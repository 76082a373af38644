// Absurd input at the border to ODE: never a crash, never a number that is not finite.
#include <cmath>
#include <limits>

#include "ode/partners_fixture.hpp"

namespace odds::test {
namespace {

class Border : public OdeTest {
 protected:
  void SetUp() override {
    OdeTest::SetUp();
    mesh = mesh_geom(box_shape(1, 1, 1, 3), space);
  }
  void expect_sound_in_both_orders(dGeomID partner) const {
    expect_sound(collide(mesh, partner), mesh, partner);
    expect_sound(collide(partner, mesh), partner, mesh);
  }
  dGeomID mesh = nullptr;
};

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

TEST_F(Border, PosesThatAreNoPosesGiveNoContactsAndAreCounted) {
  Partners partners(nullptr);
  for (const dGeomID partner : partners.all) {
    SCOPED_TRACE(dGeomGetClass(partner));
    for (const double x : {not_a_number, infinity, -infinity, 1e300}) {
      const auto before = stats().bad_poses;
      dGeomSetPosition(partner, x, 0, 0);
      EXPECT_TRUE(collide(mesh, partner).empty()) << x;
      EXPECT_TRUE(collide(partner, mesh).empty()) << x;
      EXPECT_EQ(stats().bad_poses, before + 2) << x;
      dGeomSetPosition(partner, 0, 0, 0);
    }
    dMatrix3 twisted = {NAN, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    dGeomSetRotation(partner, twisted);
    expect_sound_in_both_orders(partner);
    dRSetIdentity(twisted);
    dGeomSetRotation(partner, twisted);
    dGeomSetPosition(partner, 0.3, 0.1, 0.4);
    EXPECT_FALSE(collide(mesh, partner).empty()) << "and works again with a pose";
  }
  dGeomSetPosition(mesh, NAN, 0, 0);
  for (const dGeomID partner : partners.all) expect_sound_in_both_orders(partner);
  const dGeomID plane = dCreatePlane(space, 0, 0, 1, 0);
  expect_sound_in_both_orders(plane);
  dGeomSetPosition(mesh, 0, 0, 0);
}

TEST_F(Border, SizesBeyondAllReason) {
  for (const double size : {1e-300, 1e-30, 1e-12, 1e6, 1e30, 1e150, 1e300}) {
    SCOPED_TRACE(size);
    const dGeomID ray = dCreateRay(space, size);
    dGeomRaySet(ray, 0.1, 0.2, 3, 0, 0, -1);
    for (const dGeomID partner :
         {dCreateSphere(space, size), dCreateBox(space, size, size, size), dCreateBox(space, size, 0.1, 0.1),
          dCreateCapsule(space, size, 0.5), dCreateCapsule(space, 0.1, size), dCreateCylinder(space, size, 0.5),
          dCreateCylinder(space, 0.1, size), ray}) {
      SCOPED_TRACE(dGeomGetClass(partner));
      if (partner != ray) dGeomSetPosition(partner, 0.1, 0.2, 0.49);
      expect_sound_in_both_orders(partner);
      dGeomDestroy(partner);
    }
  }
}

// The squares of such lengths are infinite, and libccd went round in circles: no budget ended that.
TEST_F(Border, ThinBodiesOfAWidthWhoseSquareIsInfiniteAreDoneWith) {
  for (const double wide : {1e155, 1e200, 1e300}) {
    for (const double thin : {1e-150, 1e-3, 1.0}) {
      for (const double angle : {0.0, 0.3, 1.2}) {
        SCOPED_TRACE(testing::Message() << wide << " m wide, " << thin << " m thick, turned by " << angle);
        for (const dGeomID partner : {dCreateCylinder(space, wide, thin), dCreateBox(space, wide, wide, thin)}) {
          dGeomSetPosition(partner, -0.35, 0.33, -0.2);
          rotate(partner, Vec3(0.3, 0.5, 0.8).normalized(), angle);
          expect_sound_in_both_orders(partner);
          dGeomDestroy(partner);
        }
      }
    }
  }
}

TEST_F(Border, FarFromTheOriginAndExactlyOnEdges) {
  Partners partners(nullptr);
  for (const double far : {0.0, 1e6, 1e12}) {
    dGeomSetPosition(mesh, far, far, far);
    for (const dGeomID partner : partners.all) {
      for (const double x : {-0.5, 0.0, 0.5}) {
        for (const double z : {-0.5, 0.5, 0.7}) {
          dGeomSetPosition(partner, far + x, far + 0.5, far + z);
          expect_sound_in_both_orders(partner);
        }
      }
    }
  }
}

TEST_F(Border, AMeshOfSliversAndPoints) {
  auto sharp = mesh::TriangleMesh::make({{0, 0, 0}, {1, 0, 0}, {0.5, 1e-13, 0}, {0.3, 0.2, 0.1}, {1, 1, 0}, {0, 0, 0}},
                                        {{0, 1, 2}, {3, 3, 3}, {0, 1, 1}, {0, 4, 1}, {0, 5, 4}, {2, 4, 1}});
  ASSERT_TRUE(sharp.ok()) << sharp.error().message();
  auto shape = query::Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(sharp).value()));
  ASSERT_TRUE(shape.ok());
  const dGeomID slivers = mesh_geom(shape.value(), space);
  Partners partners(nullptr);
  for (const dGeomID partner : partners.all) {
    for (const double z : {-0.1, 0.0, 0.05}) {
      dGeomSetPosition(partner, 0.5, 0.1, z);
      expect_sound(collide(slivers, partner), slivers, partner);
      expect_sound(collide(partner, slivers), partner, slivers);
    }
  }
}

// A contact without a direction makes ODE's solver abort.
TEST_F(Border, ABallAboutATriangleThatIsALineOrAPointHasADirection) {
  auto sharp = mesh::TriangleMesh::make({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 5, 0}, {6, 5, 0}, {5, 6, 0}, {0, 0, 9}},
                                        {{0, 1, 2}, {3, 4, 5}, {6, 6, 6}});
  ASSERT_TRUE(sharp.ok()) << sharp.error().message();
  auto shape = query::Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(sharp).value()));
  ASSERT_TRUE(shape.ok());
  const dGeomID slivers = mesh_geom(shape.value(), space);
  const dGeomID ball = dCreateSphere(space, 0.3);
  for (const Vec3& place : {Vec3(0.5, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 9)}) {
    dGeomSetPosition(ball, place.x(), place.y(), place.z());
    const auto contacts = collide(slivers, ball);
    EXPECT_EQ(contacts.size(), 1u) << place.transpose();
    expect_sound(contacts, slivers, ball);
    for (const dContactGeom& contact : contacts) EXPECT_TRUE(contact.side1 != 0 || contact.normal[0] == 0.0);
  }
}

TEST_F(Border, ASecondInitAndCloseOfTheClientChangesNothing) {
  Partners partners(nullptr);
  for (const dGeomID partner : partners.all) dGeomSetPosition(partner, 0.3, 0.1, 0.4);
  const auto count_all = [&] {
    std::size_t contacts = 0;
    for (const dGeomID partner : partners.all) contacts += collide(mesh, partner).empty() ? 0 : 1;
    return contacts;
  };
  EXPECT_EQ(count_all(), partners.all.size());
  dInitODE();
  EXPECT_EQ(count_all(), partners.all.size());
  dCloseODE();
  EXPECT_EQ(count_all(), partners.all.size());
}

}  // namespace
}  // namespace odds::test
