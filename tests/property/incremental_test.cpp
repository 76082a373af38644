// The incremental search against a fresh one, along coherent motions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <random>

#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"
#include "support/all_kinds.hpp"
#include "support/shapes.hpp"

namespace odds::query {
namespace {

/// Two spheres with waves: a pair that keeps what it learns, and one that is asked for fresh searches.
class Incremental : public ::testing::TestWithParam<std::tuple<volume::Kind, std::uint32_t>> {
 protected:
  void make(int cells) {
    const auto [kind, capacity] = GetParam();
    const auto shape = Shape::build(testing::wavy_sphere(cells), {.volume = kind}).value();
    kept_.emplace(std::move(Pair::make(shape, shape, {.slice_capacity = capacity})).value());
    fresh_.emplace(std::move(Pair::make(shape, shape)).value());
  }
  Answer kept(const math::Pose& pose, Request request) {
    request.method = Method::incremental;
    return kept_->run(pose, request);
  }
  Answer fresh(const math::Pose& pose) { return fresh_->run(pose, {.method = Method::exact}); }

 private:
  std::optional<Pair> kept_;
  std::optional<Pair> fresh_;
};

/// The spheres overlap, or nearly.
math::Pose close_pose(double distance) { return {Mat3::Identity(), Vec3(distance, 0.1, 0)}; }

TEST_P(Incremental, GivesTheVerdictsOfAFreshSearch) {
  make(20);
  std::mt19937 generator(11);
  std::normal_distribution<double> normal;
  Quat rotation = Quat(1, 0.2, 0.3, 0.4).normalized();
  Vec3 offset(2.05, 0, 0);
  int hits = 0;
  std::uint64_t kept_work = 0;
  std::uint64_t fresh_work = 0;
  constexpr int steps = 2000;
  for (int step = 0; step < steps; ++step) {
    const Vec3 turn = 1e-3 * Vec3(normal(generator), normal(generator), normal(generator));
    rotation = (rotation * Quat(1, turn[0], turn[1], turn[2])).normalized();
    offset += 1e-3 * Vec3(normal(generator), normal(generator), normal(generator));
    offset *= (1.96 + 0.12 * std::sin(step / 150.0)) / offset.norm();  // in and out of contact
    const auto pose = math::Pose::from_quaternion(offset, rotation);
    const Answer a = kept(pose, {});
    const Answer b = fresh(pose);
    ASSERT_EQ(a.verdict, b.verdict) << "step " << step;
    ASSERT_EQ(a.basis, Basis::proved);
    hits += a.verdict == Verdict::hit ? 1 : 0;
    kept_work += a.cost.node_pairs + a.cost.triangle_pairs;
    fresh_work += b.cost.node_pairs + b.cost.triangle_pairs;
  }
  EXPECT_GT(hits, steps / 10) << "the motion must touch and part";
  EXPECT_LT(hits, steps * 9 / 10);
  if (std::get<1>(GetParam()) > 1000) {
    EXPECT_LT(kept_work, fresh_work) << "coherence must pay";
  }
}

TEST_P(Incremental, SurvivesABudgetThatEndsItAnywhere) {
  make(16);
  for (std::uint64_t units = 1; units < 600; ++units) {
    const math::Pose pose = close_pose(2.1 - 5e-4 * static_cast<double>(units));
    const Answer a = kept(pose, {.budget = Budget::work(units)});
    EXPECT_LE(a.cost.node_pairs + a.cost.triangle_pairs, units);
    if (a.basis == Basis::proved) {
      EXPECT_EQ(a.verdict, fresh(pose).verdict);
    }
    ASSERT_EQ(kept(pose, {}).verdict, fresh(pose).verdict) << units;
  }
}

TEST_P(Incremental, WithContactsSurvivesABudgetThatEndsItAnywhere) {
  make(16);
  for (std::uint64_t units = 1; units < 600; ++units) {
    const math::Pose pose = close_pose(2.1 - 5e-4 * static_cast<double>(units));
    const Answer a = kept(pose, {.budget = Budget::work(units), .max_contacts = most_contacts});
    EXPECT_LE(a.cost.node_pairs + a.cost.triangle_pairs, units);
    if (a.basis == Basis::proved) {
      ASSERT_EQ(a.verdict, fresh(pose).verdict) << units;
    }
  }
}

TEST_P(Incremental, InTimeNeverProvesWhatIsNotSo) {
  make(16);
  // A clock that jumps over the deadline after some looks: everywhere in turn.
  struct Jumping {
    std::int64_t now = 0;
    int looks = 0;
  } clock;
  for (int looks = 1; looks < 400; ++looks) {
    const math::Pose pose = close_pose(2.02 + 1e-5 * (looks % 7));
    clock.looks = looks;
    Request request{.budget = Budget::time(50.0), .max_contacts = most_contacts};
    request.budget.clock = {[](void* state) noexcept {
                              auto& jumping = *static_cast<Jumping*>(state);
                              jumping.now += --jumping.looks == 0 ? 1'000'000 : 1;
                              return jumping.now;
                            },
                            &clock};
    const Answer a = kept(pose, request);
    if (a.basis == Basis::proved) {
      ASSERT_EQ(a.verdict, fresh(pose).verdict) << looks;
    }
  }
}

TEST(IncrementalRuns, TakeUpWhereTheLastOneWasEnded) {
  const auto shape = Shape::build(testing::wavy_sphere(40), {.volume = volume::Kind::wide}).value();
  auto pair = std::move(Pair::make(shape, shape)).value();
  double distance = 2.2;
  while (pair.run(close_pose(distance - 1e-3), {.method = Method::exact}).verdict == Verdict::clear) distance -= 1e-3;
  const math::Pose apart = close_pose(distance);
  const Answer whole = pair.run(apart, {.method = Method::exact});
  const std::uint64_t work = whole.cost.node_pairs + whole.cost.triangle_pairs;
  ASSERT_GT(work, 200U);
  const std::uint64_t units = work / 5;
  pair.reset();
  int runs = 1;
  while (runs < 30 &&
         pair.run(apart, {.method = Method::incremental, .budget = Budget::work(units)}).basis != Basis::proved) {
    ++runs;
  }
  EXPECT_GT(runs, 2);
  EXPECT_LT(runs, 12) << "a fifth of the work a run";
}

// Twenty pairs of nodes a run are less than one way from the roots to a leaf takes: what earlier runs have left finds
// the contact all the same.
TEST(IncrementalSmallBudget, ProvesNearlyEveryContact) {
  const auto shape_of = [](const char* name) {
    return Shape::build(std::make_shared<const mesh::TriangleMesh>(mesh::made::make_shape(name).value())).value();
  };
  const auto plate = shape_of("box:x=0.2,y=0.2,z=0.04,cells=8");
  const auto ball = shape_of("icosphere:radius=0.01");
  auto small = std::move(Pair::make(plate, ball)).value();
  auto exact = std::move(Pair::make(plate, ball)).value();
  int hits = 0;
  int proved = 0;
  for (int run = 0; run < 4000; ++run) {  // in, and along, and out and in again
    const double t = 1e-3 * run;
    const math::Pose pose{Mat3::Identity(),
                          {0.003 * t, 0.002 * t, 0.0305 - 0.002 * std::min(t, 1.0) + 0.0015 * std::sin(3.0 * t)}};
    const bool meets = exact.run(pose, {.method = Method::exact}).verdict == Verdict::hit;
    const Answer& answer =
        small.run(pose, {.method = Method::incremental, .budget = Budget::work(20), .max_contacts = 8});
    ASSERT_LE(answer.cost.node_pairs + answer.cost.triangle_pairs, 20U);
    hits += meets ? 1 : 0;
    if (answer.basis != Basis::proved) continue;
    ASSERT_EQ(answer.verdict == Verdict::hit, meets) << "run " << run;
    proved += meets ? 1 : 0;
  }
  EXPECT_GT(hits, 3000);
  EXPECT_GE(proved, hits - hits / 50);
}

INSTANTIATE_TEST_SUITE_P(AllVolumes, Incremental,
                         ::testing::Combine(::testing::ValuesIn(testing::all_kinds()), ::testing::Values(64U, 16384U)),
                         [](const auto& tested) {
                           return std::string(volume::name(std::get<0>(tested.param))) + "_" +
                                  std::to_string(std::get<1>(tested.param));
                         });

}  // namespace
}  // namespace odds::query
