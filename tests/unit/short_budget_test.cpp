// Budgets that are too short for a contact patch: the work goes on from run to run.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "odds/math/tolerances.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"
#include "support/allocation_counter.hpp"
#include "support/shapes.hpp"
#include "support/short_request.hpp"

namespace odds::query {
namespace {

using testing::short_request;

std::shared_ptr<const Shape> knot() {
  auto mesh = mesh::made::make_shape("made:torus_knot:along=200,across=12");
  return Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value())).value();
}

/// Two of them cross in more places than are kept for work over several runs.
std::shared_ptr<const Shape> fine_knot() {
  auto mesh = mesh::made::make_shape("made:torus_knot:along=1200,across=40");
  return Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value())).value();
}

std::shared_ptr<const Shape> ball() { return Shape::build(testing::wavy_sphere(24, 0.0)).value(); }

/// Whose contacts take a while, but cross in fewer places than are kept.
std::shared_ptr<const Shape> fine_ball() { return Shape::build(testing::wavy_sphere(60, 0.02)).value(); }

math::Pose at(double x, double y = 0.0) {
  math::Pose pose;
  pose.translation = {x, y, 0.0};
  return pose;
}

/// Two balls of radius 1 that overlap by `depth`.
math::Pose deep(double depth) { return at(2.0 - depth); }

constexpr int most_runs = 2000;

/// Runs until contacts are late; how many that took, none if they never were.
std::optional<int> runs_until_late(Pair& pair, const math::Pose& pose, const Request& request) {
  for (int run = 1; run <= most_runs; ++run) {
    const Answer& answer = pair.run(pose, request);
    EXPECT_TRUE(answer.contacts.size() <= 4u);
    for (const Contact& contact : answer.contacts) {
      EXPECT_TRUE(contact.position.allFinite() && std::isfinite(contact.depth));
      EXPECT_NEAR(contact.normal.norm(), 1.0, 1e-9);
    }
    if (answer.contacts_late) return run;
  }
  return std::nullopt;
}

TEST(ShortBudget, BringsTheContactsOfAnExactRunLate) {
  for (const double microseconds : {3.0, 5.0, 10.0, 20.0, 49.0}) {
    realtime::ManualClock clock(50);
    const auto shape = ball();
    auto pair = std::move(Pair::make(shape, shape, {.late_contacts = true})).value();
    const math::Pose pose = deep(1e-3);
    const auto runs = runs_until_late(pair, pose, short_request(clock, microseconds));
    ASSERT_TRUE(runs.has_value()) << microseconds;
    auto careful = std::move(Pair::make(shape, shape)).value();
    Request all;
    all.method = Method::exact;
    all.max_contacts = 4;
    const double deepest = careful.run(pose, all).contacts.front().depth;
    const Answer& late = pair.run(pose, short_request(clock, microseconds));
    ASSERT_FALSE(late.contacts.empty());
    EXPECT_EQ(late.verdict, Verdict::hit);
    EXPECT_EQ(late.basis, Basis::proved);
    // Those of bodies that are pressed together, at the depth that they have now.
    const double press = tolerances::late_press * shape->mesh().size();
    for (const Contact& contact : late.contacts) {
      EXPECT_NEAR(contact.position.x(), 1.0, press) << microseconds << " us";
      EXPECT_LT(contact.position.tail<2>().norm(), std::sqrt(2.0 * (deepest + press)));
      EXPECT_LT(contact.normal.x(), -0.99);
      EXPECT_GT(contact.depth, 0.0);
      EXPECT_LE(contact.depth, deepest + 1e-9);
    }
  }
}

// A lid that stands on one edge and falls shut: when the other one touches, it is held there in the same run. In a
// longer budget that is so of one that slides; what rests is asked about as it lies.
TEST(ShortBudget, KnowsWhatIsAboutToTouch) {
  // With a hole: flat faces without one are known in every run (see FlushContacts).
  auto mesh = mesh::made::make_shape("made:plate_with_hole:side=1,thickness=0.2,peg_radius=0.05,clearance=1e-3");
  const auto box = Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value())).value();
  const double press = tolerances::late_press * box->mesh().size();
  const auto lid = [](double tilt, double sunk) {
    math::Pose pose;
    pose.rotation = Eigen::AngleAxisd(tilt, Vec3::UnitY()).toRotationMatrix();
    pose.translation.z() = 0.2 - sunk + 0.5 * std::sin(tilt);
    return pose;
  };
  struct Case {
    double budget_us;
    std::int64_t tick_ns;
    bool still;
    bool knows;
  };
  for (const auto& [budget_us, tick_ns, still, knows] : {Case{10.0, 50, true, true}, Case{10.0, 50, false, true},
                                                         Case{60.0, 500, true, false}, Case{60.0, 500, false, true}}) {
    realtime::ManualClock clock(tick_ns);
    auto pair = std::move(Pair::make(box, box, {.late_contacts = true})).value();
    const Request request = short_request(clock, budget_us);
    const double far = 2.0 * tolerances::late_still * box->mesh().size();
    // One edge is in by a little; the other one is open by less than what the bodies are pressed together by.
    for (int run = 0; run < 400; ++run) {
      math::Pose pose = lid(0.4 * press, 1e-5);
      if (!still) pose.translation.x() = run % 2 == 0 ? far : 0.0;
      static_cast<void>(pair.run(pose, request));
    }
    const Answer& shut = pair.run(lid(0.0, 1e-5), request);
    ASSERT_TRUE(shut.contacts_late);
    const auto is_there = [&shut](double side) {
      return std::any_of(shut.contacts.begin(), shut.contacts.end(),
                         [side](const Contact& contact) { return side * contact.position.x() > 0.4; });
    };
    EXPECT_TRUE(is_there(1.0) || is_there(-1.0));
    EXPECT_EQ(is_there(1.0) && is_there(-1.0), knows) << budget_us << (still ? ", still" : ", slides");
  }
}

// Gears turn by more than their backlash from run to run: of a front next to nothing lasts, and it takes all of a run
// to see that. Whether teeth within their backlash meet is seen sooner from the roots; where nobody knows, ODE is given
// a contact that is likely only.
TEST(ShortBudget, DecidesFromTheRootsWhereBodiesTurnFast) {
  constexpr int teeth_a = 24;
  constexpr int teeth_b = 36;
  const auto gear = [](int teeth) {
    auto mesh = mesh::made::make_shape("made:gear:module=0.002,backlash=1e-4,teeth=" + std::to_string(teeth)).value();
    return Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh))).value();
  };
  constexpr std::int64_t look_ns = 140;
  realtime::ManualClock clock(look_ns);
  auto pair = std::move(Pair::make(gear(teeth_a), gear(teeth_b), {.late_contacts = true})).value();
  const Request request = short_request(clock, 20.0);
  int undecided = 0;
  constexpr int runs = 1000;
  for (int run = 0; run < runs; ++run) {
    constexpr double within_backlash = 1.7e-3;  // radians
    const double turned = 5e-3 * run;
    const auto about_z = [](double angle) { return Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix(); };
    const math::Pose first{about_z(turned), Vec3::Zero()};
    const math::Pose second{about_z(std::numbers::pi / teeth_b - turned * teeth_a / teeth_b + within_backlash),
                            Vec3(0.001 * (teeth_a + teeth_b), 0.0, 0.0)};
    undecided += pair.run(first.inverse() * second, request).basis == Basis::budget ? 1 : 0;
  }
  EXPECT_LT(undecided, 6 * runs / 10) << "of the front alone: nine of ten";
}

// A longer budget has more for the work: fewer runs.
TEST(ShortBudget, TakesFewerRunsWithMoreTime) {
  int before = most_runs;
  for (const double microseconds : {4.0, 10.0, 30.0}) {
    realtime::ManualClock clock(50);
    const auto shape = fine_ball();
    auto pair = std::move(Pair::make(shape, shape, {.late_contacts = true})).value();
    const auto runs = runs_until_late(pair, deep(0.04), short_request(clock, microseconds));
    ASSERT_TRUE(runs.has_value());
    EXPECT_LE(*runs, before);
    before = *runs;
  }
  EXPECT_GT(before, 1);
}

// Pairs share the memory of their work. Those that waited for it had rough contacts only, for as long as others worked.
TEST(ShortBudget, PairsOfACrowdDoNotWaitForEachOther) {
  const auto shape = fine_ball();
  const auto runs_of = [&shape](std::size_t count) {
    realtime::ManualClock clock(150);
    const Request request = short_request(clock, 5.0);
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < count; ++i) {
      pairs.push_back(std::move(Pair::make(shape, shape, {.late_contacts = true})).value());
    }
    std::vector<bool> is_late(count);
    for (int run = 1; run <= most_runs; ++run) {
      for (std::size_t i = 0; i < count; ++i)
        is_late[i] = pairs[i].run(deep(0.04), request).contacts_late || is_late[i];
      if (std::all_of(is_late.begin(), is_late.end(), [](bool late) { return late; })) return run;
    }
    return most_runs;
  };
  const int alone = runs_of(1);
  ASSERT_GT(alone, 10);
  ASSERT_LT(alone, most_runs / 4);
  EXPECT_LT(runs_of(40), 2 * alone);
}

TEST(ShortBudget, GivesTheWholeDepthInTheEnd) {
  realtime::ManualClock clock(50);
  const auto shape = ball();
  auto pair = std::move(Pair::make(shape, shape, {.late_contacts = true})).value();
  const math::Pose pose = deep(2e-3);
  const double guess = 1.01 * tolerances::unmeasured_depth * shape->mesh().size();
  const double share = 0.51 * 2e-3;  // of what came in two runs or more
  double depth = 0.0;
  int late = 0;
  for (int run = 0; run < most_runs; ++run) {
    const Answer& answer = pair.run(pose, short_request(clock, 10.0));
    late += answer.contacts_late ? 1 : 0;
    depth = answer.contacts.empty() ? 0.0 : answer.contacts.front().depth;
    if (late > 1) continue;
    EXPECT_LE(depth, answer.contacts_late ? share : guess) << run;
  }
  EXPECT_NEAR(depth, 2e-3, 4e-4) << "the tessellated balls' own";
}

// What is dragged is new ground all the time, and is pushed out of it as far as it has come in.
TEST(ShortBudget, GivesTheDepthOfWhatSlides) {
  for (const double microseconds : {20.0, 60.0}) {
    realtime::ManualClock clock(100);
    const auto shape = fine_ball();
    const double size = shape->mesh().size();
    auto pair = std::move(Pair::make(shape, shape, {.late_contacts = true})).value();
    auto careful = std::move(Pair::make(shape, shape)).value();
    Request all;
    all.method = Method::exact;
    all.max_contacts = 4;
    double given = 0.0;
    double deep_in = 0.0;
    for (int run = 0; run < 400; ++run) {
      const double angle = 1e-3 * run;
      const math::Pose pose = at((2.0 - 2e-3) * std::cos(angle), (2.0 - 2e-3) * std::sin(angle));
      const Answer& answer = pair.run(pose, short_request(clock, microseconds));
      if (run < 100) continue;
      for (const Contact& contact : answer.contacts) EXPECT_LT(contact.depth, 0.02 * size);
      given += answer.contacts.empty() ? 0.0 : answer.contacts.front().depth;
      const Answer& exact = careful.run(pose, all);
      deep_in += exact.contacts.empty() ? 0.0 : exact.contacts.front().depth;
    }
    EXPECT_GT(given, (microseconds < 50.0 ? 0.05 : 0.3) * deep_in) << microseconds << " us";
  }
}

// Rays for late contacts leave the hit its proof, and end on ground whose triangles lie along the axes.
TEST(ShortBudget, ProvesWhatSlidesAndKeepsItsContacts) {
  const auto shape_of = [](const std::string& name) {
    return Shape::build(std::make_shared<const mesh::TriangleMesh>(mesh::made::make_shape(name).value())).value();
  };
  const auto ground = shape_of("made:box:x=1,y=1,z=0.1,cells=64");
  const auto tool = shape_of("made:icosphere:radius=0.05,frequency=8");
  const double size = tool->mesh().size();
  for (const double microseconds : {3.0, 5.0, 10.0}) {
    realtime::ManualClock clock(40);
    auto pair = std::move(Pair::make(ground, tool, {.late_contacts = true})).value();
    const auto pose = [&](double way) {
      math::Pose above;
      above.translation = {0.011 + way, 0.007, 0.1 - 2e-4 * size};
      return above;
    };
    ASSERT_TRUE(runs_until_late(pair, pose(0.0), short_request(clock, microseconds)).has_value()) << microseconds;
    constexpr int runs = 600;
    int proved = 0;
    int held = 0;
    for (int run = 1; run <= runs; ++run) {
      const Answer& answer = pair.run(pose(3e-4 * size * run), short_request(clock, microseconds));
      proved += answer.basis == Basis::proved && answer.verdict == Verdict::hit ? 1 : 0;
      held += answer.contacts_late && !answer.contacts.empty() ? 1 : 0;
    }
    EXPECT_EQ(proved, runs) << microseconds;
    EXPECT_GT(held, runs * 9 / 10) << microseconds;
  }
}

// A guess holds, but does not push a body away.
TEST(ShortBudget, GuessesAreHardlyDeep) {
  realtime::ManualClock clock(50);
  const auto shape = knot();
  auto pair = std::move(Pair::make(shape, shape, {.late_contacts = true})).value();
  const double size = shape->mesh().size();
  int guesses = 0;
  double most = tolerances::unmeasured_depth * size;
  for (int run = 0; run < 200; ++run) {
    const Answer& answer = pair.run(at(0.3 * size, 0.02 * run * size), short_request(clock, 4.0));
    if (answer.contacts_late || answer.contacts_complete) continue;
    for (const Contact& contact : answer.contacts) {
      ++guesses;
      EXPECT_LE(contact.depth, most * 1.000001);
    }
    if (!answer.contacts.empty()) most += tolerances::hasty_rise * size;  // if they sink
  }
  EXPECT_GT(guesses, 10);
}

TEST(ShortBudget, CanBeToldNotTo) {
  realtime::ManualClock clock(50);
  const auto shape = ball();
  auto without_memory = std::move(Pair::make(shape, shape)).value();
  EXPECT_FALSE(runs_until_late(without_memory, deep(1e-3), short_request(clock)).has_value());
  auto pair = std::move(Pair::make(shape, shape, {.late_contacts = true})).value();
  Request request = short_request(clock);
  request.late_contacts = false;
  EXPECT_FALSE(runs_until_late(pair, deep(1e-3), request).has_value());
}

TEST(ShortBudget, IsEveryOneThatAPatchTakesLongerThan) {
  realtime::ManualClock clock(500);
  const auto shape = fine_ball();
  auto pair = std::move(Pair::make(shape, shape, {.late_contacts = true})).value();
  const Request shorter = short_request(clock, 60.0);
  const Answer& first = pair.run(deep(0.04), shorter);
  ASSERT_FALSE(first.contacts.empty());
  EXPECT_FALSE(first.contacts_complete);
  EXPECT_FALSE(first.contacts_late);
  EXPECT_TRUE(runs_until_late(pair, deep(0.04), shorter).has_value());

  auto patient = std::move(Pair::make(shape, shape, {.late_contacts = true})).value();
  for (int run = 0; run < 5; ++run) {
    const Answer& whole = patient.run(deep(0.04), short_request(clock, 1e6));
    EXPECT_TRUE(whole.contacts_complete && !whole.contacts_late) << run;
  }
}

// As soon as there is time enough again, contacts are those of the run.
TEST(ShortBudget, IsNoneOfABudgetThatHasBecomeLongEnough) {
  realtime::ManualClock clock(500);
  const auto shape = fine_ball();
  auto pair = std::move(Pair::make(shape, shape, {.late_contacts = true})).value();
  ASSERT_TRUE(runs_until_late(pair, deep(0.04), short_request(clock, 60.0)).has_value());
  bool complete = false;
  for (int run = 0; run < most_runs; ++run) {
    const Answer& answer = pair.run(deep(0.04 + 1e-3 * (run % 2)), short_request(clock, 1e6));
    complete = answer.contacts_complete && !answer.contacts_late;
  }
  EXPECT_TRUE(complete);
}

TEST(ShortBudget, IsNotOneOfWork) {
  const auto shape = ball();
  auto pair = std::move(Pair::make(shape, shape, {.late_contacts = true})).value();
  Request request;
  request.method = Method::incremental;
  request.max_contacts = 4;
  request.budget = Budget::work(40);
  EXPECT_FALSE(runs_until_late(pair, deep(1e-3), request).has_value());
}

// Contacts of where the bodies were are no use where they are.
TEST(ShortBudget, ForgetsWhereTheBodiesWere) {
  realtime::ManualClock clock(50);
  const auto shape = ball();
  auto pair = std::move(Pair::make(shape, shape, {.late_contacts = true})).value();
  ASSERT_TRUE(runs_until_late(pair, deep(1e-3), short_request(clock)).has_value());
  const math::Pose elsewhere = at(0.0, 2.0 - 1e-3);
  for (int run = 0; run < most_runs; ++run) {
    const Answer& answer = pair.run(elsewhere, short_request(clock));
    for (const Contact& contact : answer.contacts) {
      EXPECT_GT(contact.position.y(), 0.5) << "of run " << run;
    }
    if (answer.contacts_late) return;
  }
  FAIL() << "no contacts there";
}

TEST(ShortBudget, MayBeGivenUpAtAnyMoment) {
  const auto shape = fine_ball();
  for (int runs = 0; runs < 40; runs += 3) {
    realtime::ManualClock clock(50);
    auto pair = std::move(Pair::make(shape, shape, {.late_contacts = true})).value();
    const math::Pose pose = deep(0.04);
    for (int run = 0; run < runs; ++run) static_cast<void>(pair.run(pose, short_request(clock)));
    if (runs % 2 == 0) continue;  // destroyed in the middle of it
    pair.reset();
    EXPECT_FALSE(pair.run(pose, short_request(clock)).contacts_late);
    Pair moved = std::move(pair);
    EXPECT_TRUE(runs_until_late(moved, pose, short_request(clock)).has_value());
  }
}

TEST(ShortBudget, MoreQuestionsThanThereIsMemoryForTakeTurns) {
  realtime::ManualClock clock(50);
  const auto shape = ball();
  std::vector<Pair> pairs;
  for (int i = 0; i < 40; ++i) pairs.push_back(std::move(Pair::make(shape, shape, {.late_contacts = true})).value());
  std::vector<bool> late(pairs.size(), false);
  const support::AllocationCounter counter;
  for (int run = 0; run < most_runs; ++run) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      late[i] = pairs[i].run(deep(1e-3), short_request(clock)).contacts_late || late[i];
    }
  }
  EXPECT_EQ(counter.allocations(), 0u);
  EXPECT_EQ(std::count(late.begin(), late.end(), true), 40);
}

// A pair that parts in the middle of the work does not keep its memory from others for long.
TEST(ShortBudget, WhatHasPartedGivesItsMemoryBack) {
  realtime::ManualClock clock(50);
  const auto shape = fine_ball();
  const double size = shape->mesh().size();
  std::vector<Pair> parted;
  for (int i = 0; i < 40; ++i) {
    parted.push_back(std::move(Pair::make(shape, shape, {.late_contacts = true})).value());
    for (int run = 0; run < 3; ++run) static_cast<void>(parted.back().run(deep(0.04), short_request(clock)));
    if (i % 2 == 0) {
      parted.back().note_apart(at(3.0 * size));
    } else {
      for (int run = 0; run < 20; ++run)
        static_cast<void>(parted.back().run(at(3.0 * size), short_request(clock, 20.0)));
    }
  }
  auto pair = std::move(Pair::make(shape, shape, {.late_contacts = true})).value();
  EXPECT_TRUE(runs_until_late(pair, deep(0.04), short_request(clock)).has_value());
}

// A part of the crossings, found in the order of a search, says little of where the bodies touch.
TEST(ShortBudget, IsAsWithoutWhereMoreCrossThanAreKept) {
  realtime::ManualClock clock(50);
  const auto shape = fine_knot();
  auto pair = std::move(Pair::make(shape, shape, {.hit_capacity = 64, .late_contacts = true})).value();
  EXPECT_FALSE(runs_until_late(pair, at(0.3 * shape->mesh().size()), short_request(clock, 20.0)).has_value());
}

// Directions of contacts of before say nothing of those of now.
TEST(ShortBudget, GuessesForgetTheOtherSide) {
  for (const double microseconds : {4.0, 6.0, 10.0}) {
    realtime::ManualClock clock(50);
    const auto shape = ball();
    auto pair = std::move(Pair::make(shape, shape, {.late_contacts = true})).value();
    for (int run = 0; run < 10; ++run) static_cast<void>(pair.run(at(1.999), short_request(clock, microseconds)));
    pair.note_apart(at(-3.0));
    for (int run = 0; run < 40; ++run) {
      for (const Contact& contact : pair.run(at(-1.999), short_request(clock, microseconds)).contacts) {
        EXPECT_GT(contact.normal.x(), 0.5) << "run " << run << " at " << microseconds << " us";
      }
    }
  }
}

TEST(ShortBudget, AWorkBudgetBesideItHolds) {
  realtime::ManualClock clock(1);
  const auto shape = knot();
  auto pair = std::move(Pair::make(shape, shape, {.late_contacts = true})).value();
  Request request = short_request(clock, 49.0);
  request.budget.work_units = 200;
  EXPECT_FALSE(runs_until_late(pair, at(0.3 * shape->mesh().size()), request).has_value());
}

TEST(ShortBudget, EachRunMayBeInAnotherThread) {
  const auto shape = fine_ball();
  auto pair = std::move(Pair::make(shape, shape, {.late_contacts = true})).value();
  realtime::ManualClock clock(50);
  const math::Pose pose = deep(0.04);
  bool late = false;
  for (int run = 0; run < most_runs && !late; ++run) {
    std::thread([&] { late = pair.run(pose, short_request(clock)).contacts_late; }).join();
  }
  EXPECT_TRUE(late);
}

TEST(ShortBudget, EndsInTime) {
  const auto shape = knot();
  auto pair = std::move(Pair::make(shape, shape, {.late_contacts = true})).value();
  constexpr std::int64_t step_ns = 50;
  realtime::ManualClock clock(step_ns);
  for (int run = 0; run < 600; ++run) {
    const double offset = 0.3 + 1e-4 * run;
    const Answer& answer = pair.run(at(offset * shape->mesh().size()), short_request(clock, 4.0 + run % 20));
    EXPECT_LE(answer.cost.overshoot_us, 10.0 * step_ns * 1e-3);
  }
}

}  // namespace
}  // namespace odds::query
