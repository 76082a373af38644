// What is remembered of the direction of a patch, and what a run without time makes of it.
#include "query/known/known_direction.hpp"

#include <gtest/gtest.h>

#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"
#include "odds/realtime/clock.hpp"

namespace odds::query {
namespace {

math::Pose moved(const Vec3& by) { return {Mat3::Identity(), by}; }

TEST(KnownDirection, APatchOfTheWholeRimDecides) {
  KnownDirection known;
  EXPECT_EQ(known.at({}, 1.0), nullptr);
  known.note(Vec3::Zero(), Vec3::UnitZ(), {}, 1.0, true);
  ASSERT_NE(known.at({}, 1.0), nullptr);
  EXPECT_EQ(*known.at({}, 1.0), Vec3::UnitZ());
  known.note(Vec3::Zero(), Vec3::UnitX(), {}, 1.0, true);
  EXPECT_EQ(*known.at({}, 1.0), Vec3::UnitX());
  known.forget();
  EXPECT_EQ(known.at({}, 1.0), nullptr);
}

TEST(KnownDirection, PatchesOfPartsVote) {
  KnownDirection known;
  for (int i = 1; i < KnownDirection::enough; ++i) {
    known.note(Vec3::Zero(), Vec3::UnitZ(), {}, 1.0, false);
    EXPECT_EQ(known.at({}, 1.0), nullptr) << i << " votes";
  }
  for (int i = 0; i < 3; ++i) known.note(Vec3::Zero(), Vec3::UnitZ(), {}, 1.0, false);
  ASSERT_NE(known.at({}, 1.0), nullptr);
  known.note(Vec3::Zero(), Vec3::UnitX(), {}, 1.0, false);
  ASSERT_NE(known.at({}, 1.0), nullptr) << "one of them errs";
  EXPECT_EQ(*known.at({}, 1.0), Vec3::UnitZ());
  for (int i = 0; i < 20; ++i) known.note(Vec3::Zero(), Vec3::UnitX(), {}, 1.0, false);
  EXPECT_EQ(*known.at({}, 1.0), Vec3::UnitX()) << "it has changed";
}

TEST(KnownDirection, HoldsForBodiesThatHaveHardlyMoved) {
  KnownDirection known;
  known.note({0.5, 0, 0}, Vec3::UnitZ(), {}, 1.0, true);
  EXPECT_NE(known.at(moved({0.9 * KnownDirection::near, 0, 0}), 1.0), nullptr);
  EXPECT_EQ(known.at(moved({1.1 * KnownDirection::near, 0, 0}), 1.0), nullptr);
  const math::Pose turned{Eigen::AngleAxisd(2.0 * KnownDirection::near, Vec3::UnitY()).toRotationMatrix(), {0, 0, 0}};
  EXPECT_EQ(known.at(turned, 1.0), nullptr);
  known.note({0.5, 0, 0}, Vec3::UnitX(), turned, 1.0, false);
  EXPECT_EQ(known.at(turned, 1.0), nullptr) << "votes of elsewhere do not count";
}

// The walls of flush bricks touch the faces in a rim of which any few pieces say sideways.
TEST(StarvedBricks, ArePushedAsBeforeTheStall) {
  auto mesh = mesh::made::make_shape("box:x=0.2,y=0.1,z=0.065,cells=8").value();
  const auto brick = Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh))).value();
  auto pair = std::move(Pair::make(brick, brick)).value();
  const math::Pose resting{Mat3::Identity(), {1e-3, 2e-3, 5e-5 - 0.065}};
  int hurried = 0;
  for (const std::int64_t reading_ns : {40, 100, 250}) {
    for (double budget_us = 1.0; budget_us < 60.0; budget_us += 1.0) {
      pair.reset();
      ASSERT_TRUE(pair.run(resting, {.max_contacts = 8}).contacts_complete);
      realtime::ManualClock clock(reading_ns);
      const Answer& answer =
          pair.run(resting, {.budget = {.microseconds = budget_us, .clock = clock.clock()}, .max_contacts = 8});
      if (answer.contacts.empty() || answer.contacts_complete) continue;
      hurried += answer.contact_pairs <= 48 ? 1 : 0;
      for (const Contact& contact : answer.contacts) {
        EXPECT_GT(std::abs(contact.normal.z()), 0.999) << budget_us << " us, " << reading_ns << " ns a reading";
      }
    }
  }
  EXPECT_GT(hurried, 20);
}

}  // namespace
}  // namespace odds::query
