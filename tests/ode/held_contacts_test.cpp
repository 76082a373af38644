// Contacts held from tick to tick: they move with the bodies, and a body whose budget is short stays where it lies.
#include "ode/geom/held_contacts.hpp"

#include <algorithm>
#include <limits>

#include "odds/query/pair.hpp"
#include "odds/realtime/clock.hpp"
#include "ode/ode_fixture.hpp"
#include "ode/vectors.hpp"

namespace odds::test {
namespace {

using ode::HeldContacts;

query::Contact contact_at(const Vec3& position, const Vec3& normal, double depth) {
  return {position, normal, depth, 3, 4};
}
math::Pose moved(const Vec3& by) { return {Mat3::Identity(), by}; }

TEST(HeldContacts, DepthFollowsTheBodies) {
  HeldContacts held;
  const query::Contact found[] = {contact_at({0.1, 0.2, 0.5}, -Vec3::UnitZ(), 0.01)};
  held.keep(found, {}, true, true);
  const auto same = held.at({}, 1.0);
  ASSERT_EQ(same.size(), 1U);
  EXPECT_NEAR(same[0].depth, 0.01, 1e-15);
  EXPECT_NEAR((same[0].position - found[0].position).norm(), 0.0, 1e-15);
  // The normal points into A: B, which stands above, comes 2 mm lower.
  EXPECT_NEAR(held.at(moved({0, 0, -0.002}), 1.0)[0].depth, 0.012, 1e-15);
  EXPECT_NEAR(held.at(moved({0.005, 0, 0.003}), 1.0)[0].depth, 0.007, 1e-15);
  EXPECT_EQ(held.at(moved({0, 0, 0.0115}), 1.0)[0].depth, 0.0) << "parted by a little";
  EXPECT_TRUE(held.at(moved({0, 0, 0.02}), 1.0).empty()) << "parted";
  EXPECT_TRUE(held.at({}, 1.0).empty()) << "let go for good";
  held.keep(found, {}, true, true);
  EXPECT_TRUE(held.at(moved({0.03, 0, 0}), 1.0).empty()) << "slid off";
}

TEST(HeldContacts, WhatIsKeptTakesThePlaceOfAll) {
  HeldContacts held;
  const query::Contact careful[] = {contact_at({0, 0, 0}, Vec3::UnitZ(), 0.001),
                                    contact_at({0.5, 0, 0}, Vec3::UnitZ(), 0.003)};
  held.keep(careful, {}, true, true);
  EXPECT_TRUE(held.better_than_rough());
  const auto two = held.at({}, 1.0);
  ASSERT_EQ(two.size(), 2U);
  EXPECT_EQ(two[0].depth, 0.003) << "deepest first";
  EXPECT_EQ(two[0].triangle_a, 3U);
  std::vector<query::Contact> many(20, careful[0]);
  held.keep(many, {}, false, false);
  EXPECT_FALSE(held.better_than_rough());
  EXPECT_EQ(held.at({}, 1.0).size(), HeldContacts::most);
  held.keep({}, {}, true, true);
  EXPECT_TRUE(held.at({}, 1.0).empty());
}

// As many as can be, found with care while a body touched on one side only, kept out what its other side sank into: it
// tipped until a collision saw all again, which threw it back.
TEST(HeldContacts, OfManyTheShallowestMakesRoomForADeeperOne) {
  HeldContacts held;
  std::vector<query::Contact> on_one_side;
  for (std::size_t i = 0; i < HeldContacts::most; ++i) {
    on_one_side.push_back(contact_at({-0.1, 0.1 * static_cast<double>(i), 0}, -Vec3::UnitZ(), 0.0));
  }
  held.keep(on_one_side, {}, true, true);
  // About the line on which they lie: 0.4 mm at the other side.
  const math::Pose tipped = {Eigen::AngleAxisd(0.002, Vec3::UnitY()).toRotationMatrix(), Vec3(0, 0, -0.0002)};
  const query::Contact found[] = {contact_at({0.1, 0.3, 0}, -Vec3::UnitZ(), 0.0004)};
  const auto given = held.with_part(found, tipped, 1.0, {});
  const auto is_there = [](const query::Contact& c) { return c.position.x() > 0.05 && c.depth > 0.0003; };
  EXPECT_TRUE(std::any_of(given.begin(), given.end(), is_there));
  EXPECT_EQ(given.size(), HeldContacts::most);
}

/// How many runs that find one contact hold another, 1 m beside it and apart by `gap`, before it is let go; and how
/// often they ask whether it is still there.
struct Lasting {
  int runs = 0;
  int asked = 0;
  double shortest_motion = std::numeric_limits<double>::infinity();  ///< that was asked about, towards the mesh
};
Lasting lasting(bool is_still_there, double gap) {
  struct Asked {
    bool answer;
    Lasting count;
  } asked{is_still_there, {}};
  const HeldContacts::StillMeets meets = {[](void* self, std::uint32_t triangle, const Vec3& motion) noexcept {
                                            auto& of = *static_cast<Asked*>(self);
                                            EXPECT_EQ(triangle, 7U);
                                            ++of.count.asked;
                                            of.count.shortest_motion = std::min(of.count.shortest_motion, -motion.z());
                                            return of.answer;
                                          },
                                          &asked};
  HeldContacts held;
  query::Contact beside = contact_at({0.5, 0, 0}, -Vec3::UnitZ(), 0.001);
  beside.triangle_a = 7;
  const query::Contact first[] = {contact_at({-0.5, 0, 0}, -Vec3::UnitZ(), 0.001), beside};
  held.keep(first, {}, false, false);
  const math::Pose apart = moved({0, 0, 0.001 + gap});
  const query::Contact again[] = {contact_at({-0.5, 0, 0}, -Vec3::UnitZ(), 0.0)};
  for (int run = 1; run <= 5 * HeldContacts::most_added; ++run) {
    const int asked_before = asked.count.asked;
    const auto given = held.with_part(again, apart, 1.0, meets);
    EXPECT_LE(asked.count.asked, asked_before + 1);
    if (given.size() == 2) asked.count.runs = run;
  }
  return asked.count;
}

// On hills within 5 to 10 us bodies rocked: a contact on which they stood was let go because no run had come by, they
// sank in there until one did, and were thrown back.
TEST(HeldContacts, WhatIsStillThereIsHeldThoughNoRunFindsItAgain) {
  for (const double gap : {-0.0005, 0.0, 1e-6, 0.001}) {
    const Lasting there = lasting(true, gap);
    EXPECT_EQ(there.runs, 5 * HeldContacts::most_added) << gap;
    EXPECT_GE(there.asked, 3);
    EXPECT_LE(there.asked, 5) << "once in a while";
    EXPECT_GT(there.shortest_motion, gap) << "what is apart by a hair is there";
    EXPECT_LT(there.shortest_motion, std::max(gap, 0.0) + 2.0 * HeldContacts::rest);
    const Lasting gone = lasting(false, gap);
    EXPECT_EQ(gone.runs, HeldContacts::most_added) << gap;
    EXPECT_EQ(gone.asked, 1);
  }
}

TEST(HeldContacts, CareGrowsStaleWhereBodiesMove) {
  HeldContacts held;
  const query::Contact careful[] = {contact_at({0, 0, 0}, Vec3::UnitZ(), 0.001)};
  held.keep(careful, {}, true, true);
  const math::Pose slid = moved({2.0 * HeldContacts::rest, 0, 0});
  for (int run = 0; run < HeldContacts::most_runs; ++run) {
    EXPECT_EQ(held.at(slid, 1.0).size(), 1U);
    EXPECT_TRUE(held.better_than_rough());
  }
  EXPECT_EQ(held.at(slid, 1.0).size(), 1U) << "where there is nothing else";
  EXPECT_FALSE(held.better_than_rough());
}

TEST(HeldContacts, CareDoesNotGrowStaleAtRest) {
  HeldContacts held;
  const query::Contact careful[] = {contact_at({0, 0, 0}, Vec3::UnitZ(), 0.001)};
  held.keep(careful, {}, true, true);
  const math::Pose trembling = moved({0.5 * HeldContacts::rest, 0, 0});
  for (int run = 0; run < 1000; ++run) {
    EXPECT_EQ(held.at(trembling, 1.0).size(), 1U);
    EXPECT_TRUE(held.better_than_rough());
  }
  const math::Pose turned{Eigen::AngleAxisd(1e-3, Vec3::UnitX()).toRotationMatrix(), Vec3::Zero()};
  static_cast<void>(held.at(turned, 1.0));
  EXPECT_FALSE(held.better_than_rough()) << "the contact has not moved, but a metre from it the body has";
}

// A body at rest hops by micrometres. A run without time after such a hop knows two pairs of triangles, whose direction
// is a guess.
TEST(HeldContacts, AHopForgetsNothing) {
  HeldContacts held;
  const query::Contact careful[] = {contact_at({0, 0, 0}, Vec3::UnitZ(), 0.001)};
  const query::Contact guessed[] = {contact_at({0, 0, 0}, Vec3::UnitX(), 0.0001)};
  query::Answer clear;
  query::Answer made;
  made.verdict = query::Verdict::hit;
  made.contacts = careful;
  query::Answer rough = made;
  rough.contacts = guessed;
  rough.contacts_complete = false;
  rough.contact_pairs = 2;
  EXPECT_EQ(held.best_of(made, {}, 1.0).size(), 1U);
  EXPECT_TRUE(held.best_of(clear, moved({0, 0, -0.00101}), 1.0).empty()) << "apart is apart";
  const auto given = held.best_of(rough, moved({0, 0, -0.0008}), 1.0);
  ASSERT_EQ(given.size(), 1U);
  EXPECT_EQ(given[0].normal, Vec3::UnitZ());
  EXPECT_NEAR(given[0].depth, 0.0002, 1e-12);
  // What a proof of being apart contradicts is let go, and so is what is far apart.
  EXPECT_TRUE(held.best_of(clear, moved({0.01, 0, -0.0005}), 1.0).empty());
  EXPECT_EQ(held.best_of(rough, moved({0.01, 0, -0.0005}), 1.0)[0].normal, Vec3::UnitX());
  EXPECT_EQ(held.best_of(made, {}, 1.0).size(), 1U);
  EXPECT_TRUE(held.best_of(clear, moved({0, 0, -0.1}), 1.0).empty());
  EXPECT_EQ(held.best_of(rough, {}, 1.0)[0].normal, Vec3::UnitX());
}

// A run that had time for a pair of triangles touches here, the next one there: a box stands on all that were found.
TEST(HeldContacts, AFewAtATimeAddUp) {
  HeldContacts held;
  query::Answer answer;
  answer.verdict = query::Verdict::hit;
  answer.contacts_complete = false;
  answer.contact_pairs = 2;
  query::Contact found[1];
  answer.contacts = found;
  const auto give = [&](double x, double y, const math::Pose& pose) {
    found[0] = contact_at({x, y, 0}, Vec3::UnitZ(), 0.001);
    return held.best_of(answer, pose, 1.0);
  };
  EXPECT_EQ(give(0.5, 0.5, {}).size(), 1U);
  EXPECT_EQ(give(-0.5, 0.5, {}).size(), 2U);
  EXPECT_EQ(give(0.5 + 0.5 * HeldContacts::same_place, 0.5, {}).size(), 2U) << "the same place";
  for (int i = 0; i < 20; ++i) EXPECT_LE(give(0.5 - 0.05 * i, -0.5, {}).size(), HeldContacts::most);
  const auto deeper = give(0.0, 0.0, moved({0, 0, 0.0005}));
  ASSERT_EQ(deeper.size(), HeldContacts::most);
  EXPECT_NEAR(deeper.front().depth, 0.0015, 1e-12) << "what is held goes with the bodies";
  EXPECT_NEAR(deeper.back().depth, 0.001, 1e-12) << "what was found has its own depth";
  EXPECT_EQ(give(0.3, 0.3, moved({2.0 * HeldContacts::most_slip, 0, 0.0005})).size(), 1U) << "the others slid off";
}

TEST(HeldContacts, WhatNoRunFindsAgainIsLetGo) {
  // A careful contact, then a body that rocks onto another edge, of which each run finds a little.
  HeldContacts held;
  const query::Contact careful[] = {contact_at({0.5, 0, 0}, Vec3::UnitZ(), 0.001)};
  const query::Contact guessed[] = {contact_at({0, 0, 0}, Vec3::UnitX(), 0.001)};
  query::Contact found[] = {contact_at({-0.5, 0, 0}, Vec3::UnitZ(), 0.002)};
  query::Answer rough;
  rough.verdict = query::Verdict::hit;
  rough.contacts_complete = false;
  rough.contact_pairs = 2;
  rough.contacts = found;
  held.keep(careful, {}, true, true);
  int given = 0;
  const math::Pose rocked = moved({0, 0.5 * HeldContacts::most_slip, 0});
  for (int run = 0; run < 60; ++run) {
    const auto contacts = held.best_of(rough, rocked, 1.0);
    given += std::any_of(contacts.begin(), contacts.end(), [](const auto& c) { return c.position.x() < 0.0; }) ? 1 : 0;
    EXPECT_TRUE(run < 59 || contacts.size() == 1U) << "the old edge is long gone";
  }
  EXPECT_GE(given, 60 - HeldContacts::most_runs - 1) << "care is preferred for a while, and only once";
  // A guess in a wrong direction does not grow into a wall.
  held.keep(guessed, {}, false, false);
  for (int run = 1; run <= 20; ++run) {
    const auto contacts = held.best_of(rough, moved({0.001 * run, 0, 0}), 1.0);
    for (const query::Contact& contact : contacts) EXPECT_GT(contact.normal.z(), 0.9);
  }
}

TEST(HeldContacts, WhereNothingIsDecidedThePlaneOfTheLastTouchHolds) {
  HeldContacts held;
  const query::Contact found[] = {contact_at({0, 0, 0}, Vec3::UnitZ(), 0.001)};
  held.keep(found, {}, true, true);
  const query::Answer undecided = [] {
    query::Answer answer;
    answer.basis = query::Basis::budget;
    return answer;
  }();
  const double far = 0.9 * HeldContacts::most_slip_undecided;
  const auto given = held.best_of(undecided, moved({far, 0, 0.0004}), 1.0);
  ASSERT_EQ(given.size(), 1U) << "farther than a contact slides that can be made anew";
  EXPECT_NEAR(given[0].depth, 0.0014, 1e-12) << "it goes on to follow the bodies";
  EXPECT_TRUE(held.best_of(undecided, moved({1.2 * HeldContacts::most_slip_undecided, 0, 0}), 1.0).empty());
}

// A body that was put beyond what it had touched, where no budget told that they were apart, was pulled back by all of
// the way that it had gone.
TEST(HeldContacts, WhatHasComeFartherThanHalfOfTheSizeIsLetGo) {
  HeldContacts held;
  const query::Contact found[] = {contact_at({0, 0, 0}, Vec3::UnitZ(), 0.001)};
  held.keep(found, {}, true, true);
  query::Answer undecided;
  undecided.basis = query::Basis::budget;
  EXPECT_EQ(held.best_of(undecided, moved({0, 0, 0.9 * HeldContacts::most_come}), 1.0).size(), 1U);
  EXPECT_TRUE(held.best_of(undecided, moved({0, 0, 1.1 * HeldContacts::most_come}), 1.0).empty());
  EXPECT_TRUE(held.best_of(undecided, {}, 1.0).empty()) << "let go for good";
}

// A torus that lay on the ground and was turned over was pushed into it by what had held it up.
TEST(HeldContacts, WhatIsTurnedOverIsLetGo) {
  const query::Contact found[] = {contact_at({0, 0, 0}, Vec3::UnitZ(), 0.001)};
  query::Answer undecided;
  undecided.basis = query::Basis::budget;
  const auto given_after = [&](double angle, const Vec3& axis) {
    HeldContacts held;
    held.keep(found, {}, true, true);
    return held.best_of(undecided, {Eigen::AngleAxisd(angle, axis).toRotationMatrix(), Vec3::Zero()}, 1.0).size();
  };
  EXPECT_EQ(given_after(3.0, Vec3::UnitX()), 0U);
  EXPECT_EQ(given_after(0.2, Vec3::UnitX()), 1U) << "it rocks";
  EXPECT_EQ(given_after(3.0, Vec3::UnitZ()), 1U) << "it spins where it lies";
}

/// What is given where two contacts of a finished run are held, and a starved one, 20 runs later and after `motion`,
/// finds one that pushes along x.
std::vector<query::Contact> given_beside_two(const Vec3& motion) {
  HeldContacts held;
  const query::Contact complete[] = {contact_at({0, 0, 0}, -Vec3::UnitZ(), 0.004),
                                     contact_at({0.5, 0, 0}, -Vec3::UnitZ(), 0.004)};
  held.keep(complete, {}, true, true);
  for (int run = 0; run < 20; ++run) static_cast<void>(held.at(moved(0.5 * motion), 1.0));
  const query::Contact sideways[] = {contact_at({0.2, 0.1, 0}, Vec3::UnitX(), 0.02)};
  query::Answer few;
  few.verdict = query::Verdict::hit;
  few.basis = query::Basis::proved;
  few.contacts = sideways;
  few.contacts_complete = false;
  few.contact_pairs = 3;
  const auto given = held.best_of(few, moved(motion), 1.0);
  return {given.begin(), given.end()};
}

TEST(HeldContacts, AllOfAFinishedRunOutweighAFewOfAStarvedOne) {
  const auto towards = given_beside_two({0.002, 0, -0.001});
  ASSERT_EQ(towards.size(), 3U) << "there may be another wall, which nobody has measured";
  EXPECT_NEAR(towards[0].depth, 0.005, 1e-12);
  EXPECT_NEAR(towards[1].depth, 0.005, 1e-12);
  EXPECT_EQ(towards[2].depth, 0.0);
  EXPECT_EQ(towards[2].normal, Vec3(Vec3::UnitX()));
  EXPECT_EQ(given_beside_two({-0.002, 0, -0.001}).size(), 2U) << "nothing has come deeper there";
  const auto far = given_beside_two({1.5 * HeldContacts::most_trusted, 0, -0.001});
  ASSERT_EQ(far.size(), 1U) << "of elsewhere";
  EXPECT_EQ(far[0].normal, Vec3(Vec3::UnitX()));
}

math::Pose pose_of(dBodyID body) {
  return {ode::matrix_of(dBodyGetRotation(body)), ode::vector_of(dBodyGetPosition(body))};
}

/// How a crate of 1 m fares that is let go over another, whose contacts are made inside a budget, by a clock that moves
/// only when it is read.
struct Fall {
  double highest = 0.0;
  double sideways = 0.0;
  double at_last = 0.0;  ///< height
};
Fall drop_crate(query::Budget budget, double height) {
  const dWorldID world = dWorldCreate();
  dWorldSetGravity(world, 0, 0, -9.81);
  const dJointGroupID joints = dJointGroupCreate(0);
  const auto crate = box_shape(1, 1, 1);
  auto pair = std::move(query::Pair::make(crate, crate)).value();
  HeldContacts held;
  const dBodyID body = dBodyCreate(world);
  dMass mass;
  dMassSetBox(&mass, 400.0, 1.0, 1.0, 1.0);
  dBodySetMass(body, &mass);
  dBodySetPosition(body, 0.1, 0.05, height);
  Fall fall;
  for (int step = 0; step < 600; ++step) {
    const math::Pose pose = pose_of(body);
    const query::Answer& answer = pair.run(pose, {.budget = budget, .max_contacts = 8});
    for (const query::Contact& found : held.best_of(answer, pose, crate->mesh().size())) {
      dContact contact = {};
      std::copy_n(found.position.data(), 3, contact.geom.pos);
      std::copy_n(found.normal.data(), 3, contact.geom.normal);
      contact.geom.depth = found.depth;
      contact.surface.mode = dContactApprox1;
      contact.surface.mu = 0.6;
      dJointAttach(dJointCreateContact(world, joints, &contact), nullptr, body);
    }
    dWorldQuickStep(world, 0.001);
    dJointGroupEmpty(joints);
    const dReal* at = dBodyGetPosition(body);
    fall.highest = std::max(fall.highest, at[2]);
    fall.sideways = std::max(fall.sideways, std::hypot(at[0], at[1]));
    fall.at_last = at[2];
  }
  dJointGroupDestroy(joints);
  dWorldDestroy(world);
  return fall;
}

class StarvedCrate : public OdeTest {};

TEST_F(StarvedCrate, IsNeverThrown) {
  for (const double budget_us : {3.0, 5.0, 8.0, 10.0, 12.0, 15.0, 20.0, 40.0}) {
    for (const std::int64_t reading_ns : {30, 70, 200}) {
      realtime::ManualClock clock(reading_ns);
      const Fall fall = drop_crate({.microseconds = budget_us, .clock = clock.clock()}, 1.2);
      SCOPED_TRACE(testing::Message() << budget_us << " us, " << reading_ns << " ns a reading");
      EXPECT_LT(fall.highest, 1.4);
      EXPECT_LT(fall.sideways, 0.5);
    }
  }
}

TEST_F(StarvedCrate, DoesNotSinkIn) {
  // Never seen apart, so that no depth is ever known.
  for (const std::uint64_t units : {60U, 100U, 200U, 400U}) {
    const Fall fall = drop_crate(query::Budget::work(units), 0.99999);
    EXPECT_GT(fall.at_last, 0.98) << units << " units";
    EXPECT_LT(fall.highest, 1.01) << units << " units";
  }
}

}  // namespace
}  // namespace odds::test
