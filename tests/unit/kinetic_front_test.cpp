// What a kinetic front keeps between runs: the pairs that met stand first.
#include "query/wide/kinetic_front.hpp"

#include <gtest/gtest.h>

#include <set>

namespace odds::query::wide {
namespace {

constexpr math::Reaches reach{1.0, 1.0};

/// A front of `size` entries whose slots of A are their numbers, after a run from the roots.
KineticFront filled(std::uint32_t size) {
  KineticFront front(size + 8);
  front.move_to({}, reach);
  for (std::uint32_t i = 1; i < size; ++i) front.add({i, 0, 0}, 1.0);
  front.note_end({.explored = true});
  return front;
}

std::set<tree::Slot> slots(KineticFront& front, std::uint32_t count) {
  std::set<tree::Slot> found;
  for (std::uint32_t i = 0; i < count; ++i) found.insert(front.entry(i).a);
  return found;
}

TEST(KineticFront, KnowsTheMotionOfARunAlsoWhereNoneCameToASearch) {
  KineticFront front(64);
  math::Pose pose;
  front.begin_run();
  front.move_to(pose, reach);
  EXPECT_EQ(front.skin(), 0.0);
  pose.translation.x() = 0.01;
  front.begin_run();
  front.move_to(pose, reach);
  const double one_run = front.skin();
  EXPECT_GT(one_run, 0.01);
  pose.translation.x() += 0.1;
  for (int i = 0; i < 10; ++i) front.begin_run();
  front.move_to(pose, reach);
  EXPECT_NEAR(front.skin(), one_run, 1e-9);
}

TEST(KineticFront, WhatMetStandsFirst) {
  KineticFront front = filled(100);
  for (const std::uint32_t i : {7U, 40U, 99U}) front.set_met(i, true);
  front.note_end({.explored = true});
  ASSERT_EQ(front.crossing(), 3U);
  EXPECT_EQ(slots(front, 3), (std::set<tree::Slot>{7, 40, 99}));
  EXPECT_EQ(slots(front, front.size()).size(), 100U) << "an entry was lost or doubled";
}

TEST(KineticFront, WhatMeetsNoMoreStandsBehind) {
  KineticFront front = filled(100);
  for (const std::uint32_t i : {7U, 40U, 99U}) front.set_met(i, true);
  front.note_end({.explored = true});
  std::uint32_t parted = 0;
  while (front.entry(parted).a != 40) ++parted;
  front.set_met(parted, false);
  front.set_met(50, true);
  const tree::Slot newly = front.entry(50).a;
  front.note_end({.explored = true});
  ASSERT_EQ(front.crossing(), 3U);
  EXPECT_EQ(slots(front, 3), (std::set<tree::Slot>{7, 99, newly}));
  EXPECT_EQ(slots(front, front.size()).size(), 100U);
}

TEST(KineticFront, TheOrderInWhichTheyWereFoundDoesNotMatter) {
  KineticFront front = filled(100);
  for (const std::uint32_t i : {99U, 40U, 2U, 1U, 0U}) front.set_met(i, true);
  front.note_end({.explored = true});
  ASSERT_EQ(front.crossing(), 5U);
  EXPECT_EQ(slots(front, 5).size(), 5U);
  EXPECT_EQ(slots(front, front.size()).size(), 100U);
  for (std::uint32_t i = 0; i < 5; ++i) EXPECT_TRUE(front.entry(i).met);
}

TEST(KineticFront, ManyThatMeetAtOnceAllStandFirst) {
  KineticFront front = filled(400);
  for (std::uint32_t i = 100; i < 390; ++i) front.set_met(i, true);
  front.note_end({.explored = true});
  ASSERT_EQ(front.crossing(), 290U);
  const std::set<tree::Slot> first = slots(front, 290);
  EXPECT_EQ(*first.begin(), 100U);
  EXPECT_EQ(*first.rbegin(), 389U);
}

TEST(KineticFront, FindsWhatHasExpiredAndWhenTheNextWill) {
  constexpr std::uint32_t size = 53;  // six blocks and a rest
  for (std::uint32_t late = 0; late < size; ++late) {
    KineticFront front = filled(size);
    front.move_to({}, reach);
    for (std::uint32_t i = 0; i < size; ++i) front.set_expiry(i, i == late ? 0.01 : 0.02 + 1e-4 * i);
    front.note_end({.explored = true});
    const auto by = [](double way) { return math::Pose{Mat3::Identity(), Vec3(way, 0, 0)}; };
    EXPECT_TRUE(front.is_apart(by(0.0099), reach)) << late;
    EXPECT_FALSE(front.is_apart(by(0.0101), reach)) << late;
    front.move_to(by(0.015), reach);
    EXPECT_EQ(front.next_expired(0, size), late);
    EXPECT_EQ(front.next_expired(late + 1, size), size);
    front.set_expiry(late, 0.9);
    front.note_end({.explored = true});  // what was passed over tells the next: the first of the others
    const double next = 0.02 + (late == 0 ? 1e-4 : 0.0);
    EXPECT_TRUE(front.is_apart(by(next - 1e-5), reach)) << late;
    EXPECT_FALSE(front.is_apart(by(next + 1e-5), reach)) << late;
  }
}

TEST(KineticFront, IsNotApartWhileAnythingMeets) {
  KineticFront front = filled(20);
  front.move_to({}, reach);
  for (std::uint32_t i = 0; i < 20; ++i) front.set_expiry(i, 1.0);
  front.set_met(5, true);
  front.note_end({.explored = true});
  EXPECT_FALSE(front.is_apart({}, reach));
}

TEST(KineticFront, KnowsHowTheLastSearchWentUntilItStartsOver) {
  KineticFront front = filled(20);
  front.move_to({}, reach);
  front.note_end({.left_at = 7, .resume_at = 5, .starved = true, .looked_at = 3});
  EXPECT_TRUE(front.last().starved);
  EXPECT_EQ(front.left_at(), 7U);
  EXPECT_EQ(front.resume_at(), 5U);
  front.restart();
  EXPECT_EQ(front.size(), 0U);
  EXPECT_FALSE(front.last().starved);
  EXPECT_EQ(front.left_at(), 0U);
}

/// In how many of 40 runs, each farther along, a front of 100 entries starts from the roots.
int starts_over(const KineticFront::Outcome& outcome, double step) {
  KineticFront front = filled(100);
  int starts = 0;
  for (int run = 1; run <= 40; ++run) {
    front.move_to({Mat3::Identity(), Vec3(step * run, 0.0, 0.0)}, reach);
    if (front.size() == 1) {
      ++starts;
      for (std::uint32_t i = 1; i < 100; ++i) front.add({i, 0, 0}, KineticFront::at_once);
    }
    front.note_end(outcome);
  }
  return starts;
}

TEST(KineticFront, StartsOverWhereAllOfItIsStale) {
  const KineticFront::Outcome lost{.starved = true, .irreplaceable = true, .work = 25};
  EXPECT_GE(starts_over(lost, 0.02), 3) << "it has moved by 80 % of its reach and found nothing";
  EXPECT_LE(starts_over(lost, 0.02), 5) << "what was begun needs its time";
  EXPECT_EQ(starts_over(lost, 1e-3), 0) << "it has hardly moved";
  EXPECT_EQ(starts_over({.irreplaceable = true}, 0.02), 0) << "it had time to look at all";
  EXPECT_EQ(starts_over({.starved = true, .irreplaceable = true, .work = 25, .looked_at = 1, .still_met = 1}, 0.02), 0);
  EXPECT_EQ(starts_over({.starved = true}, 0.02), 0) << "a larger budget rests instead";
}

}  // namespace
}  // namespace odds::query::wide
