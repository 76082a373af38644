// Corners within the other body, beside guesses of short budgets.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>

#include "odds/math/tolerances.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"
#include "query/known/corner_contacts.hpp"
#include "support/shapes.hpp"
#include "support/short_request.hpp"

namespace odds::query {
namespace {

using testing::short_request;

constexpr double size = 1.0;  // metres

math::Pose raised(double z) {
  math::Pose pose;
  pose.translation = {0.0, 0.0, z};
  return pose;
}

/// A corner of B, `depth` below the surface of A at z = 0: B is pushed up, A down.
Contact corner_at(double x, double depth) { return {{x, 0.0, -0.5 * depth}, {0.0, 0.0, -1.0}, depth, 7, 8}; }

CornerContacts holding(const Contact& contact) {
  CornerContacts corners;
  corners.note_normal(contact.normal);
  corners.add(contact, raised(0.0), size);
  return corners;
}

std::size_t written(CornerContacts& corners, const math::Pose& pose, std::array<Contact, 8>& contacts,
                    std::size_t made = 0) {
  return corners.put_before(contacts, made, pose, size, tolerances::hasty_spacing * size);
}

TEST(CornerContacts, PushGentlyAndNoHarderThanAGuessMay) {
  const double depth = 0.1;
  CornerContacts corners = holding(corner_at(0.0, depth));
  std::array<Contact, 8> contacts;
  ASSERT_EQ(written(corners, raised(0.0), contacts), 1u);
  EXPECT_DOUBLE_EQ(contacts[0].depth, tolerances::late_least * size);
  double last = 0.0;
  for (int run = 0; run < 2000; ++run) {
    corners.age(raised(0.0), size);
    corners.add(corner_at(0.0, depth), raised(0.0), size);  // measured again
    ASSERT_EQ(written(corners, raised(0.0), contacts), 1u);
    EXPECT_GE(contacts[0].depth, last);
    last = contacts[0].depth;
  }
  EXPECT_DOUBLE_EQ(last, tolerances::hasty_deepest * size);
}

TEST(CornerContacts, FollowTheBodies) {
  CornerContacts corners = holding(corner_at(0.0, 1e-3));
  std::array<Contact, 8> contacts;
  corners.age(raised(-1e-3), size);
  ASSERT_EQ(written(corners, raised(-1e-3), contacts), 1u);
  EXPECT_NEAR(contacts[0].position.z(), -1e-3, 1e-12) << "half-way between the surface and the corner 2 mm below it";
  // What has come apart does not push; what has gone far is forgotten.
  corners.age(raised(2e-3), size);
  EXPECT_EQ(written(corners, raised(2e-3), contacts), 0u);
  EXPECT_FALSE(corners.empty());
  corners.age(raised(2e-3 + tolerances::late_gap * size), size);
  EXPECT_TRUE(corners.empty());
}

TEST(CornerContacts, AreForgottenUnlessTheyAreMeasuredAgain) {
  CornerContacts corners = holding(corner_at(0.0, 1e-3));
  int runs = 0;
  for (; runs < 100 && !corners.empty(); ++runs) corners.age(raised(0.0), size);
  EXPECT_GT(runs, CornerContacts::after_a_find);
  EXPECT_LT(runs, 32);
}

TEST(CornerContacts, AreLookedForNowAndThen) {
  CornerContacts corners;
  EXPECT_TRUE(corners.is_due());
  corners.note_none();
  for (int run = 1; run <= CornerContacts::after_none; ++run) {
    EXPECT_FALSE(corners.is_due()) << run;
    corners.age(raised(0.0), size);
  }
  EXPECT_TRUE(corners.is_due());
}

TEST(CornerContacts, TakeThePlaceOfGuessesThere) {
  std::array<Contact, 8> contacts;
  for (std::size_t i = 0; i < contacts.size(); ++i) contacts[i] = corner_at(0.1 * static_cast<double>(i), 1e-4);
  CornerContacts corners = holding(corner_at(0.31, 1e-3));
  EXPECT_EQ(written(corners, raised(0.0), contacts, 5), 5u) << "one for the one at 0.3";
  EXPECT_NEAR(contacts[0].position.x(), 0.31, 1e-12);
  EXPECT_NEAR(contacts[1].position.x(), 0.0, 1e-12) << "the others in their order";
  for (std::size_t i = 1; i < 5; ++i) EXPECT_GT(std::abs(contacts[i].position.x() - 0.31), 0.02);
  for (std::size_t i = 0; i < contacts.size(); ++i) contacts[i] = corner_at(0.1 * static_cast<double>(i), 1e-4);
  EXPECT_EQ(written(corners, raised(0.0), contacts, 8), 8u);
  corners = holding(corner_at(2.0, 1e-3));
  EXPECT_EQ(written(corners, raised(0.0), contacts, 8), 8u) << "no more than there is room for";
  EXPECT_EQ(corners.put_before({}, 0, raised(0.0), size, 0.02), 0u);
}

TEST(CornerContacts, DoNotPushAgainstTheRest) {
  CornerContacts corners = holding(corner_at(0.0, 1e-3));
  std::array<Contact, 8> contacts;
  corners.note_normal(Vec3::UnitX());
  EXPECT_EQ(written(corners, raised(0.0), contacts), 0u);
}

/// Guesses are where the surfaces cross, on a circle about the lowest place of a ball that has sunk into a floor.
TEST(CornerContacts, OfABallThatHasSunkInAreFoundWithinSomeRuns) {
  const auto floor = Shape::build(std::make_shared<const mesh::TriangleMesh>(
                                      mesh::made::make_shape("made:box:x=8,y=8,z=2,cells=24").value()))
                         .value();
  const auto ball = Shape::build(testing::wavy_sphere(48, 0.0)).value();  // of radius 1
  const double depth = 0.01;
  const math::Pose pose = raised(2.0 - depth);
  for (const double microseconds : {3.0, 5.0, 10.0}) {
    realtime::ManualClock clock(100);
    auto pair = std::move(Pair::make(floor, ball, {.late_contacts = true})).value();
    bool held = false;
    for (int run = 0; run < 12 && !held; ++run) {
      const Answer& answer = pair.run(pose, short_request(clock, microseconds));
      if (answer.contacts_late) break;  // the test is of what comes before
      held = std::any_of(answer.contacts.begin(), answer.contacts.end(), [depth](const Contact& contact) {
        return contact.position.head<2>().norm() < 0.06 && contact.position.z() < 1.0 - 0.4 * depth &&
               contact.normal.z() < -0.99 && contact.depth > 0.0;
      });
    }
    EXPECT_TRUE(held) << microseconds << " us";
  }
}

}  // namespace
}  // namespace odds::query
