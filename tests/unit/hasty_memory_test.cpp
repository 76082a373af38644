// What guesses, run after run, say together.
#include "query/hasty_memory.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace odds::query {
namespace {

const Vec3 up = Vec3::UnitZ();
const Vec3 side = Vec3::UnitX();

// A brick's side that crosses the top of the one below: along the top's normal they overlap by micrometres.
TEST(Vote, OfAFaceOnAFaceIsWhateverTheSidesSay) {
  const Vote vote = Vote::of(-side, up, 0.1, 1e-6, 0.01, 1e-4, Vec3::Zero());
  EXPECT_GT(vote.direction.dot(up), 0.99);
  EXPECT_GT(vote.weight, 0.0);
}

TEST(Vote, OfFlushFacesIsWhatIsExpected) {
  const Vote undecided = Vote::of(-side, up, 1e-6, 2e-6, 0.01, 1e-3, Vec3::Zero());
  EXPECT_LT(undecided.direction.dot(up), 0.8) << "overlaps that are alike say nothing";
  const Vote decided = Vote::of(-side, up, 1e-6, 2e-6, 0.01, 1e-3, up);
  EXPECT_GT(decided.direction.dot(up), 0.99);
}

TEST(Vote, WithoutNormalsIsNone) {
  EXPECT_EQ(Vote::of(Vec3::Zero(), Vec3::Zero(), 0.1, 0.1, 0.01, 1e-4, Vec3::Zero()).weight, 0.0);
  EXPECT_EQ(Vote::of(up, up, 0.1, 0.1, 0.01, 1e-4, Vec3::Zero()).weight, 0.0) << "they say opposite things";
}

TEST(HastyMemory, WhatSidesSayCancelsOut) {
  HastyMemory memory;
  EXPECT_FALSE(memory.has_seen());
  for (int run = 0; run < 40; ++run) {
    memory.begin({}, 1e-3, 0.1);
    const double sign = run % 2 == 0 ? 1.0 : -1.0;
    memory.see((up + sign * side).normalized(), 1.0);
  }
  ASSERT_TRUE(memory.is_of_one_mind());
  EXPECT_GT(memory.direction().dot(up), 0.99);
  memory.see(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()), 1.0);
  EXPECT_GT(memory.direction().dot(up), 0.99) << "a number that is none is not seen";
}

TEST(HastyMemory, ContactsThatPushAgainstEachOtherAreNotOfOneMind) {
  HastyMemory memory;
  for (int run = 0; run < 40; ++run) {
    memory.begin({}, 1e-3, 0.1);
    memory.see(side, 1.0);
    memory.see(-side, 1.0);
  }
  EXPECT_FALSE(memory.is_of_one_mind());
}

Contact contact_at(double x) {
  Contact contact;
  contact.position = {x, 0, 0};
  contact.normal = up;
  contact.depth = 1e-5;
  return contact;
}

TEST(HastyMemory, AddsThePlacesOfRunsBefore) {
  HastyMemory memory;
  const double near = 0.01;
  const double slack = 1e-3;
  memory.begin({}, slack, 0.1);
  memory.remember(std::vector{contact_at(0.1)}, {}, near);
  memory.begin({}, slack, 0.1);
  std::vector<Contact> contacts = {contact_at(-0.1), {}, {}, {}};
  EXPECT_EQ(memory.add_to(contacts, 1, &up, {}, near), 2u);
  EXPECT_NEAR(contacts[1].position.x(), 0.1, 1e-12);
  contacts[0] = contact_at(0.1 + 0.5 * near);
  EXPECT_EQ(memory.add_to(contacts, 1, &up, {}, near), 1u) << "that is the same place";
  math::Pose apart;
  apart.translation = -1e-4 * up;
  contacts[0] = contact_at(-0.1);
  EXPECT_EQ(memory.add_to(contacts, 1, &up, apart, near), 1u) << "it has parted there";
  math::Pose slid;
  slid.translation = 2.0 * slack * Vec3::UnitY();
  memory.begin(slid, slack, 0.1);
  EXPECT_EQ(memory.add_to(contacts, 1, &up, slid, near), 1u) << "it has slid away";
}

}  // namespace
}  // namespace odds::query
