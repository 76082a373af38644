// ODE's contact contract: byte stride, flags, caps, unused fields, order, unsupported partners.
#include <cmath>
#include <cstdarg>
#include <cstring>
#include <functional>
#include <random>

#include "ode/ode_fixture.hpp"

namespace odds::test {
namespace {

// One overlapping partner of each supported class for a mesh box of side 1 at the origin.
class ContactRules : public OdeTest {
 protected:
  void SetUp() override {
    OdeTest::SetUp();
    const auto shape = box_shape(1, 1, 1, 4);
    mesh = mesh_geom(shape, space);
    const dGeomID other = mesh_geom(shape, space);
    dGeomSetPosition(other, 0.2, 0.1, 0.97);
    const dGeomID plane = dCreatePlane(space, 0, 0, 1, -0.45);
    const dGeomID sphere = dCreateSphere(space, 0.3);
    dGeomSetPosition(sphere, 0.1, 0.2, 0.75);
    const dGeomID box = dCreateBox(space, 0.4, 0.4, 0.4);
    dGeomSetPosition(box, 0, 0.1, 0.68);
    const dGeomID capsule = dCreateCapsule(space, 0.2, 0.3);
    dGeomSetPosition(capsule, -0.1, 0.1, 0.8);
    const dGeomID cylinder = dCreateCylinder(space, 0.2, 0.3);
    dGeomSetPosition(cylinder, 0.1, -0.1, 0.63);
    const dGeomID ray = dCreateRay(space, 3);
    dGeomRaySet(ray, 0.1, 0.2, 2, 0, 0, -1);
    partners = {other, plane, sphere, box, capsule, cylinder, ray};
  }
  dGeomID mesh = nullptr;
  std::vector<dGeomID> partners;
};

TEST_F(ContactRules, EveryPartnerGivesSoundContactsInBothOrders) {
  for (const dGeomID partner : partners) {
    const auto forward = collide(mesh, partner);
    const auto backward = collide(partner, mesh);
    EXPECT_FALSE(forward.empty()) << "class " << dGeomGetClass(partner);
    ASSERT_EQ(forward.size(), backward.size());
    expect_sound(forward, mesh, partner);
    expect_sound(backward, partner, mesh);
    for (std::size_t i = 0; i < forward.size(); ++i) {
      EXPECT_LT((normal_of(forward[i]) + normal_of(backward[i])).norm(), 1e-12);
      EXPECT_EQ(forward[i].side1, backward[i].side2);
    }
  }
}

TEST_F(ContactRules, SkipIsAByteStrideAndNothingElseIsWritten) {
  constexpr int odd_stride = static_cast<int>(sizeof(dContactGeom)) + 40;
  constexpr unsigned char untouched = 0xa5;
  for (const dGeomID partner : partners) {
    const auto expected = collide(mesh, partner, 8);
    std::vector<unsigned char> bytes(static_cast<std::size_t>(8 * odd_stride), untouched);
    const int count = dCollide(mesh, partner, 8, reinterpret_cast<dContactGeom*>(bytes.data()), odd_stride);
    ASSERT_EQ(static_cast<std::size_t>(count), expected.size());
    for (int i = 0; i < count; ++i) {
      dContactGeom contact;
      std::memcpy(&contact, bytes.data() + i * odd_stride, sizeof contact);
      EXPECT_EQ(contact.g1, mesh);
      EXPECT_EQ(contact.g2, partner);
      EXPECT_NEAR(normal_of(contact).norm(), 1.0, 1e-9);
      for (int b = static_cast<int>(sizeof(dContactGeom)); b < odd_stride; ++b)
        EXPECT_EQ(bytes[static_cast<std::size_t>(i * odd_stride + b)], untouched);
    }
    for (std::size_t b = static_cast<std::size_t>(count * odd_stride); b < bytes.size(); ++b)
      EXPECT_EQ(bytes[b], untouched);
  }
}

TEST_F(ContactRules, NeverMoreThanAskedFor) {
  for (const dGeomID partner : partners) {
    for (int room = 1; room <= 8; ++room) {
      std::vector<dContactGeom> contacts(9);
      std::memset(static_cast<void*>(contacts.data()), 0x5a, contacts.size() * sizeof(dContactGeom));
      const int count = dCollide(mesh, partner, room, contacts.data(), sizeof(dContactGeom));
      EXPECT_GE(count, 1);
      EXPECT_LE(count, room);
      for (std::size_t i = static_cast<std::size_t>(count); i < contacts.size(); ++i) {
        EXPECT_EQ(reinterpret_cast<const unsigned char*>(&contacts[i])[0], 0x5a) << "wrote beyond the count";
      }
    }
  }
}

TEST_F(ContactRules, TheGeomsOwnLimitHoldsToo) {
  for (const dGeomID partner : partners) {
    for (int most = 0; most <= 8; ++most) {
      ASSERT_EQ(dGeomOddsMeshSetMaxContacts(mesh, most), 1);
      EXPECT_LE(collide(mesh, partner, 64).size(), static_cast<std::size_t>(most));
    }
    EXPECT_LE(collide(mesh, partner, 0xffff).size(), 8u);
  }
}

TEST_F(ContactRules, UnimportantContactsAreNotFewer) {
  for (const dGeomID partner : partners) {
    EXPECT_EQ(collide(mesh, partner, 16, CONTACTS_UNIMPORTANT).size(), collide(mesh, partner, 16).size());
    EXPECT_EQ(collide(partner, mesh, 16, CONTACTS_UNIMPORTANT).size(), collide(partner, mesh, 16).size());
    EXPECT_EQ(collide(mesh, partner, 1, CONTACTS_UNIMPORTANT).size(), 1u);
  }
}

TEST_F(ContactRules, NoPlaceIsGivenTwice) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const dGeomID ball = mesh_geom(sphere_shape(0.8, 6), space);
  dGeomOddsMeshSetCarryMotion(ball, 0);
  int found = 0;
  for (const dGeomID partner : {dCreateBox(space, 0.4, 0.5, 0.6), dCreateCylinder(space, 0.3, 0.6)}) {
    for (int round = 0; round < 500; ++round) {
      rotate(partner, Vec3(uniform(random), uniform(random), 1.5), 3.0 * uniform(random));
      dGeomSetPosition(partner, uniform(random), uniform(random), uniform(random));
      const auto contacts = collide(ball, partner);
      found += static_cast<int>(contacts.size());
      for (std::size_t i = 0; i < contacts.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
          if (normal_of(contacts[i]).dot(normal_of(contacts[k])) < 0.9999) continue;
          ASSERT_GT((position_of(contacts[i]) - position_of(contacts[k])).norm(), 1e-9) << i << " and " << k;
        }
      }
    }
  }
  EXPECT_GT(found, 2000);
}

// Each corner of the lower side of a plate has one of the upper side right above it.
TEST_F(ContactRules, OfPlacesAboveEachOtherTheDeeperIsGiven) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const dGeomID plate = mesh_geom(box_shape(1, 0.8, 0.2), space);
  dGeomOddsMeshSetCarryMotion(plate, 0);
  const dGeomID box = dCreateBox(space, 4, 4, 1);
  for (int round = 0; round < 300; ++round) {
    const Vec3 axis(uniform(random), uniform(random), 1.5);
    const double angle = 3.0 * uniform(random);
    for (const dGeomID geom : {plate, box}) rotate(geom, axis, angle);
    const Vec3 place = Eigen::AngleAxisd(angle, axis.normalized()) * Vec3(uniform(random), uniform(random), 0.35);
    dGeomSetPosition(plate, place.x(), place.y(), place.z());
    const auto contacts = collide(plate, box);
    EXPECT_FALSE(contacts.empty());
    for (const dContactGeom& contact : contacts) EXPECT_NEAR(contact.depth, 0.25, 1e-9);
  }
}

// The normals of all of its surface cancel each other: what rounding left of them chose the way out.
TEST_F(ContactRules, AMeshWithinABodyIsLeftTheShortestWay) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto shape = sphere_shape(0.1, 2);
  const dGeomID ball = mesh_geom(shape, space);
  dGeomOddsMeshSetCarryMotion(ball, 0);
  for (const dGeomID body : {dCreateBox(space, 4, 4, 1), dCreateCylinder(space, 2, 1)}) {
    for (int round = 0; round < 200; ++round) {
      const Mat3 turn =
          Eigen::AngleAxisd(3.0 * uniform(random), Vec3(uniform(random), uniform(random), 1.5).normalized())
              .toRotationMatrix();
      dMatrix3 rotation = {};
      for (int i = 0; i < 9; ++i) rotation[4 * (i / 3) + i % 3] = turn(i / 3, i % 3);
      dGeomSetRotation(body, rotation);
      const Vec3 place = turn * Vec3(0.5 * uniform(random), 0.5 * uniform(random), 0.3 * uniform(random));
      dGeomSetPosition(ball, place.x(), place.y(), place.z());
      double shortest = HUGE_VAL;
      for (const double side : {-1.0, 1.0}) {
        double way = 0.0;
        for (const Vec3& vertex : shape->mesh().vertices()) {
          way = std::max(way, 0.5 - side * turn.col(2).dot(place + vertex));
        }
        shortest = std::min(shortest, way);
      }
      const auto contacts = collide(ball, body);
      ASSERT_FALSE(contacts.empty());
      EXPECT_NEAR(contacts[0].depth, shortest, 1e-9) << "class " << dGeomGetClass(body) << ", round " << round;
    }
  }
}

TEST_F(ContactRules, TheFirstContactIsTheDeepest) {
  const dGeomID plane = partners[1];
  const dGeomID box = partners[3];
  rotate(mesh, Vec3(1, 0.3, 0), 0.05);
  for (const dGeomID partner : {plane, box}) {
    const auto contacts = collide(mesh, partner);
    ASSERT_GE(contacts.size(), 2u);
    for (const dContactGeom& contact : contacts) EXPECT_LE(contact.depth, contacts[0].depth + 1e-5);
    const auto single = collide(mesh, partner, 1);
    ASSERT_EQ(single.size(), 1u);
    EXPECT_EQ(single[0].depth, contacts[0].depth) << "every prefix is a usable set";
    EXPECT_EQ(position_of(single[0]), position_of(contacts[0]));
  }
}

TEST_F(ContactRules, DepthsNeverExceedTheOverlapAlongTheNormal) {
  for (const dGeomID partner : {partners[2], partners[3]}) {
    for (const dContactGeom& contact : collide(mesh, partner)) {
      EXPECT_NEAR(contact.depth, partner == partners[2] ? 0.05 : 0.02, 1e-9);
      EXPECT_NEAR(contact.normal[2], -1.0, 1e-9);
    }
  }
}

std::vector<std::string> messages;
void keep_message(int, const char* format, va_list arguments) {
  char text[512];
  vsnprintf(text, sizeof text, format, arguments);
  messages.emplace_back(text);
}

TEST_F(ContactRules, PartnersThatWereNotMadeKnownAreToldOncePerClassAndCounted) {
  messages.clear();
  dMessageFunction* const before = dGetMessageHandler();
  dSetMessageHandler(&keep_message);
  const double vertices[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const double s = std::sqrt(1.0 / 3.0);
  const double planes[] = {0, 0, -1, 0, 0, -1, 0, 0, -1, 0, 0, 0, s, s, s, s};
  const unsigned polygons[] = {3, 0, 2, 1, 3, 0, 1, 3, 3, 0, 3, 2, 3, 1, 2, 3};
  const float heights[] = {0, 0, 0, 0};
  const dHeightfieldDataID field = dGeomHeightfieldDataCreate();
  dGeomHeightfieldDataBuildSingle(field, heights, 1, 4, 4, 2, 2, 1, 0, 1, 0);
  const std::vector<dGeomID> unsupported = {dCreateConvex(space, planes, 4, vertices, 4, polygons),
                                            dCreateHeightfield(space, field, 1)};
  const std::vector<std::string> names = {"convex", "heightfield"};
  const std::vector<std::string> remedies = {"oddsRegisterConvex", "oddsSetStandIn"};
  for (int repeat = 0; repeat < 3; ++repeat) {
    for (const dGeomID geom : unsupported) {
      EXPECT_TRUE(collide(mesh, geom).empty());
      EXPECT_TRUE(collide(geom, mesh).empty());
    }
  }
  EXPECT_EQ(stats().unsupported, 3u * 2u * 2u);
  ASSERT_EQ(messages.size(), names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_NE(messages[i].find(names[i]), std::string::npos) << messages[i];
    EXPECT_NE(messages[i].find("not supported"), std::string::npos) << messages[i];
    EXPECT_NE(messages[i].find(remedies[i]), std::string::npos) << messages[i];
  }
  dSetMessageHandler(before);
  for (const dGeomID geom : unsupported) dGeomDestroy(geom);
  dGeomHeightfieldDataDestroy(field);
}

}  // namespace
}  // namespace odds::test
