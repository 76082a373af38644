// Contacts that come late follow the bodies, stay where they have come apart by little, and push gently at first.
#include "query/memory/late_manifold.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace odds::query {
namespace {

constexpr double size = 0.5;
constexpr double least = tolerances::late_least * size;
const Vec3 up = Vec3::UnitZ();

Contact contact_at(double x, double y, double depth) {
  Contact contact;
  contact.position = {x, y, 0.0};
  contact.normal = up;
  contact.depth = depth;
  return contact;
}

/// B, which lies below, has come nearer by `deeper` and has been turned about y by `tilt`.
math::Pose moved(double deeper, double tilt = 0.0) {
  math::Pose pose;
  pose.rotation = Eigen::AngleAxisd(tilt, Vec3::UnitY()).toRotationMatrix();
  pose.translation = deeper * up;
  return pose;
}

std::vector<Contact> written(LateManifold& manifold, const math::Pose& pose, std::size_t room = 8) {
  std::vector<Contact> contacts(room);
  contacts.resize(manifold.write(pose, size, contacts));
  return contacts;
}

TEST(LateManifold, FollowsTheBodies) {
  LateManifold manifold;
  EXPECT_FALSE(manifold.serves({}, size));
  manifold.keep(std::vector{contact_at(0.1, 0.1, 5e-6)}, {}, {}, size, 12);
  EXPECT_EQ(manifold.made_from(), 12u);
  manifold.age(moved(5e-6), size);
  const auto now = written(manifold, moved(5e-6));
  ASSERT_EQ(now.size(), 1u);
  EXPECT_NEAR(now[0].depth, 1e-5, 1e-12);
  EXPECT_FALSE(manifold.serves(moved(-2e-5), size)) << "it has come apart";
  EXPECT_TRUE(manifold.serves(moved(0.9 * tolerances::slid_motion * size), size));
  EXPECT_FALSE(manifold.serves(moved(1.1 * tolerances::slid_motion * size), size)) << "too far from where it was made";
  manifold.forget();
  EXPECT_FALSE(manifold.serves({}, size));
}

// A body that rocks from one edge to the other: the patch of one pose has the contacts of one edge only.
TEST(LateManifold, TheOtherEdgeHoldsAtOnce) {
  LateManifold manifold;
  manifold.keep(std::vector{contact_at(-0.1, 0.1, 1e-5), contact_at(-0.1, -0.1, 1e-5)}, moved(0), moved(0), size, 12);
  const math::Pose rocked = moved(0, -2e-4);
  manifold.age(rocked, size);
  manifold.keep(std::vector{contact_at(0.1, 0.1, 1e-5), contact_at(0.1, -0.1, 1e-5)}, rocked, rocked, size, 12);
  EXPECT_EQ(written(manifold, rocked).size(), 2u);
  manifold.age(moved(0), size);
  const auto back = written(manifold, moved(0));
  ASSERT_EQ(back.size(), 2u);
  for (const Contact& contact : back) EXPECT_LT(contact.position.x(), 0.0);
  const math::Pose level = moved(5e-5, -1e-4);
  manifold.age(level, size);
  EXPECT_EQ(written(manifold, level).size(), 4u);
}

TEST(LateManifold, ForgetsWhatHasGone) {
  for (const bool slides : {false, true}) {
    const double limit = (slides ? tolerances::late_slip : tolerances::late_gap) * size;
    for (const double share : {0.9, 1.1}) {
      LateManifold manifold;
      manifold.keep(std::vector{contact_at(-0.1, 0.0, 1e-5)}, {}, {}, size, 12);
      math::Pose pose = moved(slides ? -2e-5 : -1e-5 - share * limit);
      if (slides) pose.translation.y() = share * limit;
      manifold.keep(std::vector{contact_at(0.1, 0.0, 1e-5)}, pose, pose, size, 12);
      math::Pose again = pose;
      again.translation.z() = 1e-5;
      manifold.age(again, size);
      EXPECT_EQ(written(manifold, again).size(), share < 1.0 ? 2u : 1u) << slides;
    }
  }
}

TEST(LateManifold, EndsWhereBodiesTurn) {
  LateManifold manifold;
  Contact contact = contact_at(0.0, 0.0, 1e-5);
  manifold.keep(std::vector{contact}, {}, {}, size, 12);
  EXPECT_TRUE(manifold.serves(moved(0.0, 0.9 * tolerances::late_turn), size));
  EXPECT_FALSE(manifold.serves(moved(0.0, 1.1 * tolerances::late_turn), size));
}

math::Pose slid(double way) {
  math::Pose pose = moved(1e-5);
  pose.translation.y() = way * size;
  return pose;
}

// A tool that is dragged slides by a thousandth of its size in a run: what is known of a place is of another one soon.
TEST(LateManifold, MeasuresWhatSlides) {
  const auto measured = [](LateManifold& manifold, const math::Pose& pose, Seen seen) {
    int count = 0;
    manifold.measure_slid(pose, size, 0.0, [&](HeldContact& held) noexcept {
      ++count;
      if (seen != Seen::surface) return seen;
      Contact contact = held.at(pose);
      contact.depth = 2e-5;
      held = HeldContact(contact, pose);
      return seen;
    });
    return count;
  };
  for (const Seen seen : {Seen::surface, Seen::none, Seen::unknown}) {
    LateManifold manifold;
    manifold.keep(std::vector{contact_at(0.1, 0.1, 1e-5), contact_at(-0.1, 0.1, 1e-5)}, {}, {}, size, 12);
    EXPECT_EQ(measured(manifold, slid(0.9 * tolerances::slid_measured), seen), 0) << "it is where it was";
    const math::Pose far = slid(1.1 * tolerances::late_slip);
    manifold.age(far, size);
    EXPECT_FALSE(manifold.serves(far, size)) << "of another place";
    EXPECT_EQ(measured(manifold, far, seen), seen == Seen::unknown ? 1 : 2);
    EXPECT_EQ(manifold.serves(far, size), seen == Seen::surface);
    EXPECT_EQ(written(manifold, far).size(), seen == Seen::surface ? 2u : 0u);
    EXPECT_EQ(measured(manifold, far, seen), seen == Seen::unknown ? 1 : 0) << "once";
  }
  LateManifold manifold;
  manifold.keep(std::vector{contact_at(0.1, 0.1, 1e-5)}, {}, {}, size, 12);
  EXPECT_EQ(measured(manifold, slid(1.1 * tolerances::slid_slip), Seen::surface), 0) << "nobody knows where it is";
  EXPECT_FALSE(manifold.serves(slid(0.0), size)) << "and it is none any more";
}

// What a ray finds deeper than was thought came in since the last one: a run's share of it is given, and the rest
// slowly.
TEST(LateManifold, GivesAShareOfWhatIsMeasuredDeeper) {
  constexpr int runs = 4;
  const double deeper = 2e-3;
  LateManifold manifold;
  manifold.keep(std::vector{contact_at(0.1, 0.1, 1e-5)}, {}, {}, size, 12);
  const math::Pose far = slid(1.1 * tolerances::slid_measured);
  for (int run = 0; run < runs; ++run) {
    manifold.age(far, size);
    static_cast<void>(written(manifold, far));
  }
  const double before = written(manifold, far)[0].depth;
  manifold.measure_slid(far, size, 0.0, [&](HeldContact& held) noexcept {
    Contact contact = held.at(far);
    contact.depth += deeper;
    held = HeldContact(contact, far);
    return Seen::surface;
  });
  for (int run = 0; run < 3; ++run) {
    const auto now = written(manifold, far);
    ASSERT_EQ(now.size(), 1u);
    EXPECT_NEAR(now[0].depth, before + deeper / runs + run * tolerances::late_rise * size, 1e-9) << run;
    manifold.age(far, size);
  }
}

// The patch that comes is of where the bodies were when it was asked for: what was measured since is newer.
TEST(LateManifold, KeepsWhatWasMeasuredSinceItWasAsked) {
  for (const bool is_newer : {false, true}) {
    LateManifold manifold;
    manifold.keep(std::vector{contact_at(0.1, 0.1, 1e-5)}, {}, {}, size, 12);
    const math::Pose far = slid(1.1 * tolerances::late_slip);
    for (int run = 0; run < 3; ++run) manifold.age(far, size);
    if (is_newer) {
      manifold.measure_slid(far, size, 0.0, [&](HeldContact& held) noexcept {
        held = HeldContact(held.at(far), far);
        return Seen::surface;
      });
    }
    manifold.age(far, size);
    manifold.keep(std::vector{contact_at(-0.1, 0.1, 1e-5)}, far, far, size, 12, {.asked = 2});
    EXPECT_EQ(written(manifold, far).size(), is_newer ? 2u : 1u);
  }
}

TEST(LateManifold, TheDeepestComeFirst) {
  LateManifold manifold;
  std::vector<Contact> contacts;
  for (int i = 0; i < 8; ++i) contacts.push_back(contact_at(0.05 * (i - 4), 0.1, 1e-6 * (i + 1)));
  manifold.keep(contacts, {}, {}, size, 12);
  const auto now = written(manifold, {}, 3);
  ASSERT_EQ(now.size(), 3u);
  EXPECT_NEAR(now[0].depth, 8e-6, 1e-12);
  EXPECT_NEAR(now[2].depth, 6e-6, 1e-12);
}

// What came deep while nobody knew is not thrown out in a step.
TEST(LateManifold, GivesADepthNoFasterThanItsRate) {
  LateManifold manifold;
  const double deep = 0.01;
  manifold.keep(std::vector{contact_at(0.0, 0.0, deep)}, {}, {}, size, 12);
  EXPECT_FALSE(manifold.gives_all({}));
  double before = written(manifold, {})[0].depth;
  EXPECT_LE(before, least);
  int runs = 0;
  for (; !manifold.gives_all({}) && runs < 10000; ++runs) {
    manifold.age({}, size);
    const double now = written(manifold, {})[0].depth;
    EXPECT_LE(now, std::max(before, least) + 1.001 * tolerances::late_rise * size);
    EXPECT_GE(now, before);
    before = now;
  }
  EXPECT_NEAR(before, deep, 1e-12) << "all of it in the end";
  EXPECT_NEAR(runs, deep / (tolerances::late_rise * size), 10.0);
}

// A solver takes some steps to push out what came in one: of what came in four runs, a fourth is as much as came in
// one.
TEST(LateManifold, GivesTheShareOfARun) {
  const double deep = 0.01;
  for (const int runs : {0, 1, 4, 100, Lateness::long_ago}) {
    LateManifold manifold;
    manifold.keep(std::vector{contact_at(0.0, 0.0, deep)}, {}, {}, size, 12, {.asked = 0, .last = runs});
    EXPECT_NEAR(written(manifold, {})[0].depth, std::max(deep / std::max(runs, 1), least), 1e-12) << runs;
    EXPECT_EQ(manifold.gives_all({}), runs <= 1);
    manifold.forget();
    manifold.keep(std::vector{contact_at(0.0, 0.0, deep)}, {}, {}, size, 12, {.asked = 0, .last = runs, .turns = true});
    EXPECT_NEAR(written(manifold, {})[0].depth, least, 1e-12) << "what turns touches elsewhere all the time";
  }
}

// Of a body of half a metre: what is given at first, and after a second at 1 kHz.
TEST(LateManifold, PushesGently) {
  LateManifold manifold;
  manifold.keep(std::vector{contact_at(0.0, 0.0, 0.01)}, {}, {}, size, 12);
  const double first = written(manifold, {})[0].depth;
  EXPECT_GT(first, 1e-5);
  EXPECT_LT(first, 2e-5);
  for (int run = 0; run < 1000; ++run) manifold.age({}, size);
  const double after_a_second = written(manifold, {})[0].depth;
  EXPECT_GT(after_a_second, 2e-3);
  EXPECT_LT(after_a_second, 4e-3);
}

// A solver that takes back a fifth of a depth in a step makes a speed of it: 10 mm of depth would be 2 m/s.
TEST(LateManifold, PushesApartNoFasterThanItsRate) {
  constexpr double taken_back = 0.2;
  LateManifold manifold;
  const double deep = 0.01;
  manifold.keep(std::vector{contact_at(0.0, 0.0, deep)}, {}, {}, size, 12);
  double depth = deep;
  double fastest = 0.0;
  for (int run = 0; run < 10000 && depth > 1e-4 * deep; ++run) {
    manifold.age(moved(depth - deep), size);
    const double way = taken_back * written(manifold, moved(depth - deep))[0].depth;
    fastest = std::max(fastest, way);
    depth -= way;
  }
  EXPECT_LE(fastest, 1.3 * tolerances::late_rise * size);
  EXPECT_LE(depth, 1e-4 * deep) << "they do come apart";
}

// What presses bodies together against their contacts finds a resistance that grows with the depth, as ever; but what
// comes deeper while nothing holds it comes slowly into account.
TEST(LateManifold, GivesWhatIsPressedInAgainstItAtOnce) {
  for (const bool held : {true, false}) {
    LateManifold manifold;
    manifold.keep(std::vector{contact_at(0.0, 0.0, 1e-5)}, {}, {}, size, 12);
    if (held) static_cast<void>(written(manifold, {}));
    manifold.age(moved(1e-3), size);
    const double given = written(manifold, moved(1e-3))[0].depth;
    if (held) {
      EXPECT_NEAR(given, 1e-3 + 1e-5, 1e-9);
    } else {
      EXPECT_LE(given, std::max(least, 1e-5 + 1.001 * tolerances::late_rise * size));
    }
  }
}

// The patch that follows says the same: no step back to a small depth, no step up to a greater one.
TEST(LateManifold, ASuccessorGivesWhatItsPredecessorGave) {
  LateManifold manifold;
  manifold.keep(std::vector{contact_at(0.0, 0.0, 1e-3)}, {}, {}, size, 12);
  for (int i = 0; i < 50; ++i) {
    manifold.age({}, size);
    static_cast<void>(written(manifold, {}));
  }
  const double before = written(manifold, {})[0].depth;
  EXPECT_GT(before, 2.0 * least);
  manifold.keep(std::vector{contact_at(0.4 * tolerances::late_spacing * size, 0.0, 5e-3)}, {}, {}, size, 12);
  EXPECT_DOUBLE_EQ(written(manifold, {})[0].depth, before);
  EXPECT_EQ(written(manifold, {}).size(), 1u) << "instead of it, not beside it";
  manifold.keep(std::vector{contact_at(3.0 * tolerances::late_spacing * size, 0.0, 5e-3)}, {}, {}, size, 12);
  EXPECT_LE(written(manifold, {})[0].depth, least) << "elsewhere it is another contact";
}

// A contact that had slid too far to be written held nothing, though others did: what came deeper there comes slowly
// into account, of the contact that follows it, too.
TEST(LateManifold, WhatIsNotWrittenHoldsNothing) {
  LateManifold manifold;
  manifold.keep(std::vector{contact_at(0.0, 0.0, 1e-5)}, {}, {}, size, 12);
  math::Pose slid = moved(0.0);
  slid.translation.y() = 1.2 * tolerances::late_slip * size;
  for (int run = 1; run <= 10; ++run) {
    math::Pose deeper = slid;
    deeper.translation.z() = 1e-4 * run;
    manifold.age(deeper, size);
    EXPECT_TRUE(written(manifold, deeper).empty());
  }
  math::Pose last = slid;
  last.translation.z() = 1e-3;
  manifold.keep(std::vector{contact_at(0.0, 0.0, 1e-3)}, last, last, size, 12);
  EXPECT_LE(written(manifold, last)[0].depth, 1.001 * least);
}

}  // namespace
}  // namespace odds::query
