// What guesses, run after run, say together.
#include "query/known/hasty_memory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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
    memory.begin({}, Vec3::Zero(), 1e-3, 0.1);
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
    memory.begin({}, Vec3::Zero(), 1e-3, 0.1);
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
  memory.begin({}, Vec3::Zero(), slack, 0.1);
  memory.remember(std::vector{contact_at(0.1)}, {}, near);
  memory.begin({}, Vec3::Zero(), slack, 0.1);
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
  memory.begin(slid, slid.translation, slack, 0.1);
  EXPECT_EQ(memory.add_to(contacts, 1, &up, slid, near), 1u) << "it has slid away";
}

// A place at a wall goes on holding off the wall when the floor is touched.
TEST(HastyMemory, APlaceAcrossADirectionKeepsItsOwn) {
  HastyMemory memory;
  memory.begin({}, Vec3::Zero(), 1e-3, 0.1);
  memory.remember(std::vector{contact_at(0.1)}, {}, 0.01);
  std::vector<Contact> contacts(2);
  ASSERT_EQ(memory.add_to(contacts, 0, &side, {}, 0.01), 1u);
  EXPECT_EQ(contacts[0].normal, up);
  const Vec3 tilted = (up + side).normalized();
  ASSERT_EQ(memory.add_to(contacts, 0, &tilted, {}, 0.01), 1u);
  EXPECT_EQ(contacts[0].normal, tilted);
}

// Hits that are found one beside the other must not drive out the one place at the other end.
TEST(HastyMemory, KeepsThePlacesFarAway) {
  HastyMemory memory;
  const double near = 1e-4;
  memory.begin({}, Vec3::Zero(), 1e-3, 0.1);
  memory.remember(std::vector{contact_at(-0.2)}, {}, near);
  for (int i = 0; i < 30; ++i) memory.remember(std::vector{contact_at(0.2 + 1e-3 * i)}, {}, near);
  std::vector<Contact> contacts(most_contacts);
  const std::size_t all = memory.add_to(contacts, 0, &up, {}, near);
  ASSERT_EQ(all, most_contacts);
  const auto is_far = [](const Contact& contact) { return contact.position.x() < 0.0; };
  EXPECT_EQ(std::count_if(contacts.begin(), contacts.end(), is_far), 1);
}

// Beside contacts that are known a guess holds what comes deeper there, but pushes nothing out.
TEST(HastyMemory, HoldsBesideContactsThatPushTheSameWay) {
  HastyMemory memory;
  const double near = 0.01;
  const double most = 5e-5;
  memory.begin({}, Vec3::Zero(), 1e-3, 0.1);
  memory.remember(std::vector{contact_at(0.1)}, {}, near);
  const auto held_at = [&](double deeper, const Vec3& normal) {
    math::Pose pose;
    pose.translation = deeper * up;
    std::vector<Contact> contacts = {contact_at(-0.1), {}, {}, {}};
    contacts[0].normal = normal;
    const std::size_t all = memory.hold_beside(contacts, 1, pose, near, most);
    return all == 2 ? contacts[1].depth : 0.0;
  };
  EXPECT_EQ(held_at(0.0, up), 0.0) << "the depth that was guessed is not given";
  EXPECT_NEAR(held_at(2e-5, up), 2e-5, 1e-12);
  EXPECT_NEAR(held_at(2e-4, up), most, 1e-12);
  EXPECT_EQ(held_at(-2e-5, up), 0.0) << "it has parted";
  EXPECT_EQ(held_at(2e-5, side), 0.0) << "those push elsewhere";
  std::vector<Contact> none(4);
  EXPECT_EQ(memory.hold_beside(none, 0, {}, near, most), 0u);
  math::Pose deeper;
  deeper.translation = 2e-5 * up;
  std::vector<Contact> known = {contact_at(0.1 + 0.5 * near), {}};
  EXPECT_EQ(memory.hold_beside(known, 1, deeper, near, most), 1u) << "that is the same place";
}

}  // namespace
}  // namespace odds::query
