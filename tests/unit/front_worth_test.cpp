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
    if (worth.prefers_roots(at(x), 1.0)) {
      ++from_roots;
      worth.note_roots(roots, true);
    } else {
      worth.note_front(front, 10, worth.is_stale() || i == 0, true);
    }
  }
  return from_roots;
}

TEST(FrontWorth, AFrontThatSparesWorkIsAlwaysUsed) {
  FrontWorth worth;
  double x = 0.0;
  worth.note_front(much, 10, true, true);  // as dear as the roots, when it is new
  EXPECT_EQ(runs_from_roots(worth, 5000, 1e-5, little, much, x), 0);
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
  while (!worth.prefers_roots(at(x += 1e-2), 1.0))
    worth.note_front(much, 10, false, true), worth.note_roots(little, true);
  EXPECT_TRUE(worth.is_stale());
  while (worth.prefers_roots(at(x), 1.0)) worth.note_roots(little, true);  // they stand still
  EXPECT_TRUE(worth.is_stale());
  worth.note_front(much, 10, true, true);
  EXPECT_FALSE(worth.is_stale());
}

TEST(FrontWorth, BodiesThatJumpNowAndThenDoNotHurry) {
  FrontWorth worth;
  double x = 0.0;
  worth.note_front(much, 10, true, true);
  for (int place = 0; place < 100; ++place) {
    EXPECT_EQ(runs_from_roots(worth, 20, 1e-5, little, much, x), 0) << place;
    ASSERT_FALSE(worth.is_stale());
    EXPECT_FALSE(worth.prefers_roots(at(x += 1.0), 1.0)) << place;
    ASSERT_TRUE(worth.is_stale());
    worth.note_front({20 * much.node_pairs, 20 * much.triangle_pairs}, 10, true, true);
  }
}

TEST(FrontWorth, AWrongGuessOfTheRootsIsCorrected) {
  FrontWorth worth;
  double x = 0.0;
  // New where the search was over at once; then it would take long.
  static_cast<void>(worth.prefers_roots(at(x), 1.0));
  worth.note_front(little, 10, true, true);
  constexpr Work between{400, 20};
  const int from_roots = runs_from_roots(worth, 2000, 1e-4, between, much, x);
  EXPECT_GT(from_roots, 0);
  EXPECT_LT(from_roots, 20);
}

TEST(FrontWorth, ASearchFromTheRootsThatItsBudgetEndsIsTheLast) {
  FrontWorth worth;
  double x = 0.0;
  ASSERT_GT(runs_from_roots(worth, 20, 1e-2, much, little, x), 0);
  ASSERT_TRUE(worth.prefers_roots(at(x += 1e-2), 1.0));
  worth.note_roots(much, false);
  EXPECT_FALSE(worth.prefers_roots(at(x += 1e-2), 1.0));
}

TEST(FrontWorth, IncrementalRunsOfBodiesThatHurryTakeNoMoreWorkThanExactOnes) {
  const auto shape = Shape::build(testing::wavy_sphere(48, 0.1)).value();
  const auto work_of = [&](Method method, double step) {
    auto pair = std::move(Pair::make(shape, shape)).value();
    math::Random random(5);
    Request request{.method = method, .max_contacts = 0};
    double work = 0.0;
    math::Pose pose;
    for (int i = 0; i < 1500; ++i) {
      if (i % 300 == 0) pose = {random.rotation().toRotationMatrix(), 2.2 * random.direction()};
      const Vec3 along = random.direction().cross(pose.translation).normalized();
      pose.translation = 2.2 * (pose.translation + step * along).normalized();
      const Cost cost = pair.run(pose, request).cost;
      work += FrontWorth::cost_from_roots({cost.node_pairs, cost.triangle_pairs});
    }
    return work;
  };
  EXPECT_LT(work_of(Method::incremental, 2e-2), 1.15 * work_of(Method::exact, 2e-2));
  EXPECT_LT(work_of(Method::incremental, 1e-4), 0.5 * work_of(Method::exact, 1e-4));
}

}  // namespace
}  // namespace odds::query::wide
