// When searches start from a kinetic front, and when from the roots.
#include "query/wide/front_worth.hpp"

#include <gtest/gtest.h>

#include "odds/math/random.hpp"
#include "odds/query/pair.hpp"
#include "support/shapes.hpp"

namespace odds::query::wide {
namespace {

constexpr Work little{40, 2};
constexpr Work much{4000, 200};
constexpr KineticFront::Outcome ended{.explored = true};

math::Pose at(double x) {
  math::Pose pose;
  pose.translation.x() = x;
  return pose;
}

/// Runs of bodies that move by `step` each, where a search from the front costs `front` and one from the roots `roots`.
/// Returns how many were from the roots.
int runs_from_roots(FrontWorth& worth, int runs, double step, const Work& front, const Work& roots, double& x) {
  int from_roots = 0;
  for (int i = 0; i < runs; ++i) {
    x += step;
    if (worth.prefers_roots(at(x), 1.0, true)) {
      ++from_roots;
      worth.note_roots(roots, true);
    } else {
      worth.note_front(front, 10, worth.is_stale() || i == 0, ended);
    }
  }
  return from_roots;
}

TEST(FrontWorth, AFrontThatSparesWorkIsUsed) {
  FrontWorth worth;
  double x = 0.0;
  worth.note_front(much, 10, true, ended);  // as dear as the roots, when it is new
  EXPECT_LE(runs_from_roots(worth, 5000, 1e-5, little, much, x), 5000 / 200) << "but for a look now and then";
}

TEST(FrontWorth, AFrontThatCostsMoreRestsAndIsSeldomTried) {
  FrontWorth worth;
  double x = 0.0;
  const int from_roots = runs_from_roots(worth, 5000, 1e-2, much, little, x);
  EXPECT_GT(from_roots, 4900);
  EXPECT_LT(from_roots, 5000);
}

TEST(FrontWorth, ItIsTriedAsSoonAsTheBodiesMoveSlower) {
  FrontWorth worth;
  double x = 0.0;
  ASSERT_GT(runs_from_roots(worth, 1000, 1e-2, much, little, x), 900);
  const int from_roots = runs_from_roots(worth, 1000, 1e-4, little, much, x);
  EXPECT_LT(from_roots, 20);
}

TEST(FrontWorth, WhatIsOfBeforeARestIsStale) {
  FrontWorth worth;
  double x = 0.0;
  while (!worth.prefers_roots(at(x += 1e-2), 1.0, true))
    worth.note_front(much, 10, false, ended), worth.note_roots(little, true);
  EXPECT_TRUE(worth.is_stale());
  while (worth.prefers_roots(at(x), 1.0, true)) worth.note_roots(little, true);  // they stand still
  EXPECT_TRUE(worth.is_stale());
  worth.note_front(much, 10, true, ended);
  EXPECT_FALSE(worth.is_stale());
}

TEST(FrontWorth, BodiesThatJumpNowAndThenDoNotHurry) {
  FrontWorth worth;
  double x = 0.0;
  worth.note_front(much, 10, true, ended);
  int from_roots = 0;
  for (int place = 0; place < 100; ++place) {
    from_roots += runs_from_roots(worth, 20, 1e-5, little, much, x);
    ASSERT_FALSE(worth.is_stale());
    EXPECT_FALSE(worth.prefers_roots(at(x += 1.0), 1.0, true)) << place;
    ASSERT_TRUE(worth.is_stale());
    worth.note_front({20 * much.node_pairs, 20 * much.triangle_pairs}, 10, true, ended);
  }
  EXPECT_LE(from_roots, 2000 / 200);
}

TEST(FrontWorth, AWrongGuessOfTheRootsIsCorrected) {
  FrontWorth worth;
  double x = 0.0;
  // New where the search was over at once; then it would take long.
  static_cast<void>(worth.prefers_roots(at(x), 1.0, true));
  worth.note_front(little, 10, true, ended);
  constexpr Work between{400, 20};
  const int from_roots = runs_from_roots(worth, 2000, 1e-4, between, much, x);
  EXPECT_GT(from_roots, 0);
  EXPECT_LT(from_roots, 20);
}

TEST(FrontWorth, ASearchFromTheRootsThatItsBudgetEndsIsSeldomRepeated) {
  FrontWorth worth;
  double x = 0.0;
  ASSERT_GT(runs_from_roots(worth, 20, 1e-2, much, little, x), 0);
  int from_roots = 0;
  int restarts = 0;
  for (int i = 0; i < 5000; ++i) {
    if (worth.prefers_roots(at(x += 1e-2), 1.0, true)) {
      worth.note_roots(much, false);
      ++from_roots;
    } else {
      restarts += worth.is_stale() ? 1 : 0;
      worth.note_front(much, 10, worth.is_stale(), ended);
    }
  }
  EXPECT_LT(from_roots, 5000 / 200);
  EXPECT_LT(restarts, 3);
}

TEST(FrontWorth, WhatTheRootsCostIsLearntAnewWhenBodiesBeginToHurry) {
  FrontWorth worth;
  double x = 0.0;
  worth.note_front(much, 10, true, ended);
  ASSERT_LT(runs_from_roots(worth, 1000, 1e-4, little, much, x), 10);
  constexpr Work between{400, 20};
  EXPECT_GT(runs_from_roots(worth, 1000, 1e-2, between, little, x), 900);
}

/// Runs from a front that end as `outcome` says, until it rests; at most 1000.
int runs_until_it_rests(FrontWorth& worth, const KineticFront::Outcome& outcome) {
  for (int runs = 0; runs < 1000; ++runs) {
    if (!worth.prefers_roots({}, 1.0, true)) {
      worth.note_front(little, 10, false, outcome);
    } else if (worth.is_stale()) {
      return runs;
    } else {
      worth.note_roots(much, true);  // it only looks
    }
  }
  return 1000;
}
constexpr KineticFront::Outcome no_use{.starved = true, .looked_at = 10, .still_met = 7};

TEST(FrontWorth, ItRestsWhereItNeitherEndsNorLasts) {
  FrontWorth worth;
  const int runs = runs_until_it_rests(worth, no_use);
  EXPECT_GT(runs, 5) << "one bad run is no reason";
  EXPECT_LT(runs, 50);
  EXPECT_TRUE(worth.is_stale()) << "what it knew is old when it comes back";
  int rest = 1;
  while (worth.prefers_roots({}, 1.0, true)) ++rest;
  EXPECT_FALSE(worth.prefers_roots({}, 1.0, false));
  runs_until_it_rests(worth, no_use);
  EXPECT_FALSE(worth.prefers_roots({}, 1.0, false)) << "without a budget it ends";
  int longer = 1;
  while (worth.prefers_roots({}, 1.0, true)) ++longer;
  EXPECT_GT(longer, rest);
  runs_until_it_rests(worth, no_use);
  worth.reset();
  EXPECT_FALSE(worth.prefers_roots({}, 1.0, true));
}

TEST(FrontWorth, HitsThatEndARunAreNoReasonToRest) {
  FrontWorth worth;
  EXPECT_EQ(runs_until_it_rests(worth, {.looked_at = 2, .still_met = 1}), 1000);
}

TEST(FrontWorth, ItStaysWhereWhatMetGoesOnMeeting) {
  FrontWorth worth;
  EXPECT_EQ(runs_until_it_rests(worth, {.starved = true, .looked_at = 40, .still_met = 40}), 1000);
}

/// How many of 1500 runs that slide over each other open as many pairs from the front as from the roots.
int runs_alike(double step, const Budget& budget) {
  const auto shape = Shape::build(testing::wavy_sphere(48, 0.1)).value();
  auto exact = std::move(Pair::make(shape, shape)).value();
  auto incremental = std::move(Pair::make(shape, shape)).value();
  math::Random random(5);
  Request request{.budget = budget, .max_contacts = 0};
  int alike = 0;
  math::Pose pose;
  for (int i = 0; i < 1500; ++i) {
    if (i % 300 == 0) pose = {random.rotation().toRotationMatrix(), 2.05 * random.direction()};
    const Vec3 along = random.direction().cross(pose.translation).normalized();
    pose.translation = 2.05 * (pose.translation + step * along).normalized();
    request.method = Method::exact;
    const Cost fresh = exact.run(pose, request).cost;
    request.method = Method::incremental;
    const Cost kept = incremental.run(pose, request).cost;
    alike += fresh.node_pairs == kept.node_pairs ? 1 : 0;
  }
  return alike;
}

TEST(FrontWorth, IncrementalRunsOfBodiesThatHurryAreThoseFromTheRoots) {
  EXPECT_GT(runs_alike(5e-2, {}), 800);
  EXPECT_LT(runs_alike(1e-4, {}), 100);
}

// Of 400 units a search from the roots proves little where bodies touch: what is known is worth more than it costs.
TEST(FrontWorth, ShortBudgetsKeepTheFront) {
  const auto shape = Shape::build(testing::wavy_sphere(48, 0.1)).value();
  auto pair = std::move(Pair::make(shape, shape)).value();
  math::Random random(6);
  math::Pose pose{random.rotation().toRotationMatrix(), 2.3 * random.direction()};
  int undecided = 0;
  for (int i = 0; i < 3800; ++i) {
    const Vec3 along = random.direction().cross(pose.translation).normalized();
    pose.translation = (i < 50 ? 2.3 : 2.02) * (pose.translation + 3e-3 * along).normalized();
    const Request request{.method = Method::incremental, .budget = Budget::work(400), .max_contacts = 0};
    undecided += pair.run(pose, request).basis == Basis::budget ? 1 : 0;
  }
  EXPECT_LT(undecided, 100);
}

}  // namespace
}  // namespace odds::query::wide
