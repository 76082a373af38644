// Where balls and planes were met last: within so little work that a search alone finds next to nothing, they hold.
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "ode/geom/last_places.hpp"
#include "ode/world_fixture.hpp"

namespace odds::test {
namespace {

class RememberedPlaces : public WorldTest {
 protected:
  /// A body at rest that holds `geom`.
  dBodyID body_of(dGeomID geom, const dMass& mass, const Vec3& at) {
    const dBodyID body = dBodyCreate(world);
    dBodySetMass(body, &mass);
    dGeomSetBody(geom, body);
    dBodySetPosition(body, at.x(), at.y(), at.z());
    return body;
  }
};

/// With a node or none a search from the root finds nothing.
TEST_F(RememberedPlaces, AreFoundAgainByNextToNoWork) {
  const dGeomID ball = dCreateSphere(space, 0.2);
  dGeomSetPosition(ball, 0.72, 0.0, 0.95);
  const dGeomID capsule = dCreateCapsule(space, 0.1, 0.4);
  dGeomSetPosition(capsule, 0.0, -0.65, -0.9);
  const dGeomID plane = dCreatePlane(space, 0, 1, 0, -0.99);
  for (const dGeomID partner : {ball, capsule, plane}) {
    const dGeomID mesh = mesh_geom(sphere_shape(1.0, 60), space);
    dGeomOddsMeshSetUndecidedPolicy(mesh, ODDS_UNDECIDED_NO_CONTACT, 0.5);  // capsules keep no contacts
    for (const dReal carried : {1e-5, 0.0}) {
      dGeomOddsMeshSetCarryMotion(mesh, carried);
      dGeomOddsMeshSetWorkBudget(mesh, 0);
      const auto all = collide(mesh, partner);
      ASSERT_FALSE(all.empty()) << "class " << dGeomGetClass(partner);
      ASSERT_EQ(dGeomOddsMeshSetWorkBudget(mesh, 1), 1);
      const auto again = collide(mesh, partner);
      ASSERT_EQ(again.empty(), carried == 0.0) << "class " << dGeomGetClass(partner);
      if (again.empty()) continue;
      EXPECT_NEAR(again[0].depth, all[0].depth, 1e-9) << "class " << dGeomGetClass(partner);
    }
    dGeomDestroy(mesh);
  }
}

/// Held where it was met last, which is behind it by then, it would roll faster and faster.
TEST_F(RememberedPlaces, AFineBallThatRollsOnAPlaneIsNotDriven) {
  constexpr double radius = 0.1;
  constexpr double speed = 0.05;
  dCreatePlane(space, 0, 0, 1, 0);
  for (const unsigned long units : {24UL, 40UL, 60UL}) {
    const dGeomID ball = mesh_geom(sphere_shape(radius, 60), space);
    ASSERT_EQ(dGeomOddsMeshSetWorkBudget(ball, units), 1);
    dMass mass;
    dMassSetSphere(&mass, 500, radius);
    const dBodyID body = body_of(ball, mass, Vec3(0, 0, radius));
    dBodySetLinearVel(body, speed, 0, 0);
    dBodySetAngularVel(body, 0, speed / radius, 0);
    for (int i = 0; i < 3000; ++i) step();
    const dReal* const velocity = dBodyGetLinearVel(body);
    EXPECT_LT(Vec3(velocity[0], velocity[1], velocity[2]).norm(), 1.2 * speed) << units;
    dGeomDestroy(ball);
  }
}

/// Each collision alone finds corners that lie beside each other.
TEST_F(RememberedPlaces, AFineBottomIsHeldAllAround) {
  const dGeomID plane = dCreatePlane(space, 0, 0, 1, 0);
  const dGeomID box = mesh_geom(box_shape(0.2, 0.2, 0.2, 60), space);
  dGeomSetPosition(box, 0, 0, 0.1 - 1e-4);
  ASSERT_EQ(dGeomOddsMeshSetWorkBudget(box, 24), 1);
  std::vector<dContactGeom> contacts;
  for (int i = 0; i < 20; ++i) contacts = collide(box, plane);
  Vec3 lower = Vec3::Constant(1.0);
  Vec3 upper = Vec3::Constant(-1.0);
  for (const dContactGeom& contact : contacts) {
    EXPECT_NEAR(contact.depth, 1e-4, 1e-9);
    lower = lower.cwiseMin(position_of(contact));
    upper = upper.cwiseMax(position_of(contact));
  }
  EXPECT_GT((upper - lower).x(), 0.18);
  EXPECT_GT((upper - lower).y(), 0.18);
}

/// The same contacts wherever there is work for all, whatever was met before.
TEST_F(RememberedPlaces, WhereThereIsWorkForAllNothingIsTakenFromThem) {
  const dGeomID mesh = mesh_geom(sphere_shape(1.0, 30), space);
  const dGeomID ball = dCreateSphere(space, 0.2);
  const dGeomID plane = dCreatePlane(space, 0, 0, 1, -0.99);
  dGeomOddsMeshSetCarryMotion(mesh, 0);
  dGeomSetPosition(ball, 0.3, 0.4, 1.0);
  const auto of_ball = collide(mesh, ball);
  const auto of_plane = collide(mesh, plane);
  ASSERT_FALSE(of_ball.empty());
  ASSERT_FALSE(of_plane.empty());
  dGeomOddsMeshSetCarryMotion(mesh, 1e-3);
  const auto expect_the_same = [](const auto& a, const auto& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(position_of(a[i]), position_of(b[i]));
      EXPECT_EQ(a[i].depth, b[i].depth);
    }
  };
  for (int i = 0; i < 5; ++i) {
    dGeomSetPosition(ball, 0.9, -0.1 * i, 0.5);  // elsewhere
    static_cast<void>(collide(mesh, ball));
    dGeomSetPosition(ball, 0.3, 0.4, 1.0);
    expect_the_same(collide(mesh, ball), of_ball);
    dGeomPlaneSetParams(plane, 0, 1, 0, -0.98);
    static_cast<void>(collide(mesh, plane));
    dGeomPlaneSetParams(plane, 0, 0, 1, -0.99);
    expect_the_same(collide(mesh, plane), of_plane);
  }
}

TEST(LastPlaces, OfOnePartnerAreNotThoseOfAnother) {
  ode::LastPlaces met;
  std::array<std::uint32_t, ode::LastPlaces::most> places;
  std::vector<char> geoms(1000);
  const auto geom = [&](std::size_t i) { return reinterpret_cast<dGeomID>(&geoms[i]); };
  EXPECT_EQ(met.of(geom(0), places), 0U);
  const std::array<std::uint32_t, 3> some = {7, 0, 12};
  met.note(geom(0), some);
  ASSERT_EQ(met.of(geom(0), places), 3U);
  EXPECT_TRUE(std::equal(some.begin(), some.end(), places.begin()));
  EXPECT_EQ(met.of(geom(1), places), 0U);
  met.note(geom(0), std::span(some).first(1));
  EXPECT_EQ(met.of(geom(0), places), 1U);
  for (std::uint32_t i = 0; i < geoms.size(); ++i) met.note(geom(i), std::span(&i, 1));
  std::size_t known = 0;
  for (std::size_t i = 0; i < geoms.size(); ++i) {
    if (met.of(geom(i), places) == 0) continue;
    EXPECT_EQ(places[0], i);
    ++known;
  }
  EXPECT_GT(known, 20U);
}

/// Addresses differ from run to run; within work units contacts may not.
TEST(LastPlaces, DoNotDependOnAddresses) {
  for (const std::size_t apart : {8U, 16U, 112U, 4096U}) {
    ode::LastPlaces met;
    std::array<std::uint32_t, ode::LastPlaces::most> places;
    std::vector<char> geoms(ode::LastPlaces::most_partners * apart);
    const auto geom = [&](std::size_t i) { return reinterpret_cast<dGeomID>(&geoms[i * apart]); };
    for (int round = 0; round < 2; ++round) {
      for (std::uint32_t i = 0; i < ode::LastPlaces::most_partners; ++i) met.note(geom(i), std::span(&i, 1));
    }
    for (std::uint32_t i = 0; i < ode::LastPlaces::most_partners; ++i) {
      ASSERT_EQ(met.of(geom(i), places), 1U) << i << ", " << apart << " apart";
      EXPECT_EQ(places[0], i);
      EXPECT_EQ(met.turn(geom(i)), 2U);
    }
  }
}

TEST(LastPlaces, OfMorePartnersThanThereIsRoomForSomeAreKnown) {
  ode::LastPlaces met;
  std::array<std::uint32_t, ode::LastPlaces::most> places;
  std::vector<char> geoms(3 * ode::LastPlaces::most_partners);
  std::size_t known = 0;
  constexpr int rounds = 50;
  for (int round = 0; round < rounds; ++round) {
    for (std::uint32_t i = 0; i < geoms.size(); ++i) {
      const auto geom = reinterpret_cast<dGeomID>(&geoms[i]);
      if (round > 0) known += met.of(geom, places);
      met.note(geom, std::span(&i, 1));
    }
  }
  EXPECT_GT(known, rounds * geoms.size() / 5);
}

}  // namespace
}  // namespace odds::test
