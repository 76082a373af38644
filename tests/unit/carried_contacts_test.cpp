// Contacts of bodies that have hardly moved: carried along, proved, and never where they would be wrong.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"
#include "query/known/carried_contacts.hpp"

namespace odds::query {
namespace {

std::shared_ptr<const Shape> made_brick() {
  auto mesh = mesh::made::make_shape("box:x=0.2,y=0.1,z=0.065,cells=4").value();
  return Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh))).value();
}

/// Two bricks of 0.2 m, the upper one 0.1 mm deep in the lower.
class Bricks : public ::testing::Test {
 protected:
  static constexpr double carried = 1e-5;
  const std::shared_ptr<const Shape> brick = made_brick();
  Pair pair = std::move(Pair::make(brick, brick)).value();
  const math::Pose resting{Mat3::Identity(), {0.013, 0.007, -0.0649}};

  static math::Pose moved(const math::Pose& pose, const Vec3& way) { return {pose.rotation, pose.translation + way}; }
  const Answer& run(const math::Pose& pose) { return pair.run(pose, {.max_contacts = 4, .carry_motion = carried}); }
};

TEST_F(Bricks, AreMadeAnewUnlessAsked) {
  static_cast<void>(pair.run(resting, {.max_contacts = 4}));
  EXPECT_FALSE(pair.run(resting, {.max_contacts = 4}).contacts_carried);
}

TEST_F(Bricks, AtRestKeepTheirContactsAtAFractionOfTheWork) {
  const Answer made = run(resting);
  ASSERT_FALSE(made.contacts_carried);
  ASSERT_EQ(made.contacts.size(), 4U);
  const std::vector<Contact> contacts(made.contacts.begin(), made.contacts.end());
  const Answer& answer = run(resting);
  EXPECT_TRUE(answer.contacts_carried);
  EXPECT_TRUE(answer.contacts_complete);
  EXPECT_EQ(answer.verdict, Verdict::hit);
  EXPECT_EQ(answer.basis, Basis::proved);
  EXPECT_EQ(answer.probability, 1.0);
  EXPECT_LE(answer.cost.node_pairs + answer.cost.triangle_pairs, 8U);
  EXPECT_EQ(pair.crossings().size(), 1U) << "what proved it";
  ASSERT_EQ(answer.contacts.size(), contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    EXPECT_LT((answer.contacts[i].position - contacts[i].position).norm(), 1e-15);
    EXPECT_EQ(answer.contacts[i].normal, contacts[i].normal);
    EXPECT_NEAR(answer.contacts[i].depth, contacts[i].depth, 1e-15);
  }
}

TEST_F(Bricks, DepthsFollowTheMotionAsIfMadeAnew) {
  static_cast<void>(run(resting));
  auto other = std::move(Pair::make(brick, brick)).value();
  const double step = 0.4 * carried * brick->mesh().size();
  for (const Vec3& way : {Vec3(0, 0, step), Vec3(0, 0, -step), Vec3(step, 0, 0)}) {
    for (const double turn : {0.0, step / brick->mesh().size()}) {
      const Mat3 turned = Eigen::AngleAxisd(turn, Vec3::UnitY()).toRotationMatrix();
      const math::Pose pose{turned, moved(resting, way).translation};
      const Answer& answer = run(pose);
      ASSERT_TRUE(answer.contacts_carried);
      const Answer& anew = other.run(pose, {.max_contacts = 4});
      // The surface of A along its normal through the place of each contact, as B has moved there.
      for (const Contact& contact : answer.contacts) {
        const Vec3 before = resting * (pose.inverse() * contact.position);
        const double come = (contact.position - before).dot(contact.normal);
        EXPECT_NEAR(contact.depth, 1e-4 + come, 1e-3 * step);
      }
      EXPECT_NEAR(answer.contacts.front().depth, anew.contacts.front().depth, step);
    }
  }
}

TEST_F(Bricks, ThatMoveFartherHaveTheirContactsMadeAnew) {
  const double size = brick->mesh().size();
  for (const Vec3& way : {Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)}) {
    static_cast<void>(run(resting));
    EXPECT_FALSE(run(moved(resting, 1.01 * carried * size * way)).contacts_carried);
  }
  static_cast<void>(run(resting));
  const math::Pose turned{Eigen::AngleAxisd(2.0 * carried, Vec3::UnitX()).toRotationMatrix(), resting.translation};
  EXPECT_FALSE(run(turned).contacts_carried) << "what is far from the contact has moved";
}

// Many small steps are not one small step.
TEST_F(Bricks, CreepingAddsUp) {
  static_cast<void>(run(resting));
  const double step = 0.2 * carried * brick->mesh().size();
  int carried_runs = 0;
  for (int i = 1; i <= 100; ++i) carried_runs += run(moved(resting, {i * step, 0, 0})).contacts_carried ? 1 : 0;
  EXPECT_LE(carried_runs, 85);
  EXPECT_GE(carried_runs, 60);
}

TEST_F(Bricks, ThatHavePartedAreClear) {
  const math::Pose touching{Mat3::Identity(), {0.013, 0.007, -0.065 + 1e-7}};
  ASSERT_EQ(run(touching).verdict, Verdict::hit);
  const Answer& answer = run(moved(touching, {0, 0, -3e-7}));
  EXPECT_FALSE(answer.contacts_carried);
  EXPECT_EQ(answer.verdict, Verdict::clear);
  EXPECT_EQ(answer.basis, Basis::proved);
}

TEST_F(Bricks, AnotherQuestionIsAnsweredAnew) {
  static_cast<void>(run(resting));
  EXPECT_FALSE(pair.run(resting, {.max_contacts = 8, .carry_motion = carried}).contacts_carried);
  static_cast<void>(run(resting));
  pair.reset();
  EXPECT_FALSE(run(resting).contacts_carried);
  EXPECT_FALSE(pair.run(resting, {.max_contacts = 1, .carry_motion = carried}).contacts_carried);
}

TEST_F(Bricks, WhatWasMadeInAHurryIsNotCarried) {
  int hurried = 0;
  for (std::uint64_t units = 16; units < 1024; units += 16) {
    const Request request{.budget = Budget::work(units), .max_contacts = 4, .carry_motion = carried};
    pair.reset();
    const Answer& answer = pair.run(resting, request);
    if (answer.contacts.empty() || answer.contacts_complete) continue;
    ++hurried;
    EXPECT_FALSE(pair.run(resting, request).contacts_carried) << units << " units";
  }
  EXPECT_GT(hurried, 3);
}

// Bodies that rest where no run has time for all of the rim.
TEST_F(Bricks, PartsThatPushAsBeforeAreCarriedAsParts) {
  int carried_parts = 0;
  for (std::uint64_t units = 128; units < 1024; units += 16) {
    const Request request{.budget = Budget::work(units), .max_contacts = 4, .carry_motion = carried};
    pair.reset();
    std::size_t made_from = 0;
    for (int i = 0; i < 16; ++i) {
      const Answer& answer = pair.run(resting, request);
      if (answer.contacts_complete) break;
      if (!answer.contacts_carried) {
        made_from = answer.contact_pairs;
        continue;
      }
      EXPECT_GE(i, CarriedContacts::runs_of_rest) << "bodies that move on have no rest";
      EXPECT_EQ(answer.contact_pairs, made_from);
      EXPECT_EQ(answer.basis, Basis::proved);
      for (const Contact& contact : answer.contacts) EXPECT_GT(std::abs(contact.normal.z()), 0.999);
      ++carried_parts;
    }
    if (made_from == 0) continue;
    EXPECT_FALSE(pair.run(moved(resting, {0, 0, 2.0 * carried * brick->mesh().size()}), request).contacts_carried);
  }
  EXPECT_GT(carried_parts, 20);
}

TEST_F(Bricks, AMotionOutOfRangeIsRefused) {
  for (const double bad : {-1e-9, 1.01, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(pair.run(resting, {.max_contacts = 4, .carry_motion = bad}).basis, Basis::budget);
  }
}

}  // namespace
}  // namespace odds::query
