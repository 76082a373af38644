// The incremental search against a fresh one, along coherent motions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"
#include "support/all_kinds.hpp"
#include "support/shapes.hpp"

namespace odds::query {
namespace {

/// Two spheres with waves: a pair that keeps what it learns, and one that is asked for fresh searches.
class Incremental : public ::testing::TestWithParam<std::tuple<volume::Kind, std::uint32_t>> {
 protected:
  void make(std::uint32_t cells) {
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

std::shared_ptr<const Shape> made(const char* name) {
  return Shape::build(std::make_shared<const mesh::TriangleMesh>(mesh::made::make_shape(name).value())).value();
}

std::set<std::uint32_t> triangles_of_a(const Pair& pair) {
  std::set<std::uint32_t> triangles;
  for (const TrianglePair& crossing : pair.crossings()) triangles.insert(crossing.a);
  return triangles;
}

TEST(IncrementalRuns, OnePairOfLeavesThatTakesAWholeRunDoesNotHideTheOthers) {
  const auto plate = made("box:x=0.1,y=0.1,z=0.02,cells=16");
  const auto block = made("box:x=0.05,y=0.05,z=0.05,cells=12");
  for (const std::uint64_t units : {9U, 12U, 20U}) {
    auto pair = std::move(Pair::make(plate, block)).value();
    math::Pose pose{Mat3::Identity(), {0.001, 0.002, 0.0345}};
    static_cast<void>(pair.run(pose, {.method = Method::incremental, .max_contacts = 8}));
    const std::set<std::uint32_t> all = triangles_of_a(pair);
    std::set<std::uint32_t> found;
    for (int run = 0; run < 400; ++run) {
      pose.translation.x() += 1e-9;
      static_cast<void>(pair.run(
          pose,
          {.method = Method::incremental, .budget = Budget::work(units), .max_contacts = 8, .carry_motion = 0.0}));
      found.merge(triangles_of_a(pair));
    }
    EXPECT_GT(2 * found.size(), all.size()) << units << ": " << found.size() << " of " << all.size();
  }
}

TEST(IncrementalRuns, FindNoPairOfTrianglesTwice) {
  const auto plate = made("box:x=0.1,y=0.1,z=0.02,cells=40");
  for (const char* name : {"box:x=0.05,y=0.05,z=0.05,cells=40", "icosphere:radius=0.03,frequency=40"}) {
    const auto body = made(name);
    const double bottom = body->mesh().lower().z();
    for (const std::uint64_t units : {30U, 100U, 250U, 499U}) {
      auto pair = std::move(Pair::make(plate, body)).value();
      for (int run = 0; run < 400; ++run) {
        const math::Pose pose{Mat3::Identity(), {0.02 * std::sin(0.05 * run), 0.002, 0.0097 - bottom}};
        static_cast<void>(pair.run(
            pose,
            {.method = Method::incremental, .budget = Budget::work(units), .max_contacts = 8, .carry_motion = 0.0}));
        std::set<std::pair<std::uint32_t, std::uint32_t>> different;
        for (const TrianglePair& crossing : pair.crossings()) different.insert({crossing.a, crossing.b});
        ASSERT_EQ(different.size(), pair.crossings().size()) << name << ", " << units << " units, run " << run;
      }
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

/// Two meshes that press and rock against each other, and how many of their contacts small runs prove.
struct Rocking {
  const char* a;
  const char* b;
  double percent_of_20;   ///< at least, by 20 pairs of nodes a run, moved by 0.01 % of the size
  double of_20_faster;    ///< the same, moved by 0.05 %
  double percent_of_100;  ///< at least, by 100 pairs of nodes a run, moved by 0.05 %
};

/// Per cent of the runs of `units` in which bodies that meet are proved to; `phase` a run, some half of it in sizes.
double proved_percent(const Rocking& rocking, double phase, std::uint64_t units) {
  const auto a = made(rocking.a);
  const auto b = made(rocking.b);
  auto small = std::move(Pair::make(a, b)).value();
  auto exact = std::move(Pair::make(a, b)).value();
  const auto meets = [&](const math::Pose& pose) {
    return exact.run(pose, {.method = Method::exact}).verdict == Verdict::hit;
  };
  const double size = std::min(a->mesh().size(), b->mesh().size());
  const Vec3 middle_a = 0.5 * (a->mesh().lower() + a->mesh().upper());
  const Vec3 middle_b = 0.5 * (b->mesh().lower() + b->mesh().upper());
  const Vec3 up = Vec3(0.1, 0.2, 1.0).normalized();
  double inside = 0.0;
  double touching = 3.0 * std::max(a->mesh().size(), b->mesh().size());
  for (int i = 0; i < 60; ++i) {
    const double between = 0.5 * (inside + touching);
    (meets({Mat3::Identity(), middle_a + between * up - middle_b}) ? inside : touching) = between;
  }
  int hits = 0;
  int proved = 0;
  for (int run = 1; run <= 2000; ++run) {
    const double t = phase * run;
    const Mat3 turn = Eigen::AngleAxisd(0.3 * std::sin(3.0 * t), Vec3(1.0, 1.0, 0.0).normalized()).toRotationMatrix();
    const double height = touching + 0.05 * size * (0.3 - std::sin(10.0 * t));
    const Vec3 at = middle_a - turn * middle_b + height * up + 0.1 * size * std::sin(4.0 * t) * Vec3::UnitX();
    const bool hit = meets({turn, at});
    const Answer& answer =
        small.run({turn, at}, {.method = Method::incremental, .budget = Budget::work(units), .max_contacts = 8});
    EXPECT_LE(answer.cost.node_pairs + answer.cost.triangle_pairs, units);
    hits += hit ? 1 : 0;
    if (answer.basis != Basis::proved) continue;
    EXPECT_EQ(answer.verdict == Verdict::hit, hit) << "run " << run;
    proved += hit ? 1 : 0;
  }
  EXPECT_GT(hits, 300);
  return 100.0 * proved / hits;
}

class IncrementalSmallBudget : public ::testing::TestWithParam<Rocking> {};

// So few pairs of nodes are less than the way from the roots to a leaf takes: what earlier runs have left finds the
// contact all the same, where it is not gone by the next run.
TEST_P(IncrementalSmallBudget, ProvesContactsThatLast) {
  EXPECT_GE(proved_percent(GetParam(), 1e-4, 20), GetParam().percent_of_20);
  EXPECT_GE(proved_percent(GetParam(), 1e-3, 20), GetParam().of_20_faster);
  EXPECT_GE(proved_percent(GetParam(), 1e-3, 100), GetParam().percent_of_100);
}

/// Counts its readings, which stand for 20 ns each.
struct CountingClock {
  std::int64_t now_ns = 0;
  int readings = 0;

  static std::int64_t read(void* self) noexcept {
    auto& clock = *static_cast<CountingClock*>(self);
    ++clock.readings;
    return clock.now_ns += 20;
  }
};

// A nanometre apart, hundreds of leaves of two bricks are near each other, and single precision finds no plane between
// any two. The clock is looked at twice for each that is looked for.
TEST(IncrementalOfFlushFaces, LooksForFewPlanesInVain) {
  const auto mesh = mesh::made::make_shape("made:box:x=0.2,y=0.2,z=0.1,cells=11").value();
  const auto shape = Shape::build(std::make_shared<const mesh::TriangleMesh>(mesh)).value();
  Pair pair = Pair::make(shape, shape).value();
  CountingClock clock;
  Request request;
  request.method = Method::incremental;
  request.max_contacts = 0;
  request.budget = Budget::time(1e9);
  request.budget.clock = {&CountingClock::read, &clock};
  int fresh = 0;
  for (int i = 0; i < 5; ++i) {
    clock.readings = 0;
    const Answer& answer = pair.run({Mat3::Identity(), {0.003 + 1e-7 * i, 0.002, 0.1 + 1e-9}}, request);
    ASSERT_EQ(answer.verdict, Verdict::clear);
    if (i == 0) fresh = clock.readings;
    EXPECT_LE(clock.readings, fresh + 8) << i;
  }
  EXPECT_GT(fresh, 1000);
}

/// Small tetrahedra along the x axis, each with its top first and its base from there.
std::shared_ptr<const Shape> tips(const std::vector<std::pair<double, double>>& tops_and_bases) {
  constexpr double side = 1e-3;
  std::vector<Vec3> corners;
  std::vector<mesh::Triangle> triangles;
  for (const auto& [top, base] : tops_and_bases) {
    const auto first = static_cast<std::uint32_t>(corners.size());
    corners.insert(corners.end(), {{top, 0, 0}, {base, side, 0}, {base, -side, side}, {base, -side, -side}});
    for (const auto& [i, j, k] : {mesh::Triangle{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}) {
      triangles.push_back({first + i, first + j, first + k});
    }
  }
  auto mesh = mesh::TriangleMesh::make(std::move(corners), std::move(triangles)).value();
  return Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh))).value();
}

// A tip a metre out nearly touches another. A pose that is stretched along it by half of what it may be off carries it
// farther than a turn would that changes the pose as much.
TEST(IncrementalAtPosesThatAreOnlyJustRigid, DoesNotMissWhatAStretchBringsTogether) {
  const auto b = tips({{1.0, 0.999}, {0.999, 0.998}, {0.998, 0.997}, {-1.0, -0.999}, {-0.999, -0.998}});
  int hits = 0;
  for (double gap = 2.5e-7; gap < 5.5e-7; gap += 1e-8) {
    const auto a = tips({{1.0 + gap, 1.001 + gap}, {1.001, 1.002}, {1.002, 1.003}});
    Pair pair = Pair::make(a, b).value();
    Pair fresh = Pair::make(a, b).value();
    const Request request{.method = Method::incremental, .max_contacts = 0};
    math::Pose pose;
    for (int i = 0; i < 3; ++i) ASSERT_EQ(pair.run(pose, request).verdict, Verdict::clear);
    pose.rotation(0, 0) = 1.0 + 4.9e-7;
    const Verdict expected = fresh.run(pose, {.method = Method::exact}).verdict;
    hits += expected == Verdict::hit ? 1 : 0;
    const Answer& answer = pair.run(pose, request);
    EXPECT_EQ(answer.verdict, expected) << gap;
    EXPECT_EQ(answer.basis, Basis::proved);
  }
  EXPECT_GT(hits, 20);
}

// Where a ball came first, all of the hills around it moved in its frame as it rocked, and were looked at again.
TEST(IncrementalOnHills, TakesAsLittleWorkWhicheverComesFirst) {
  const auto hills = mesh::made::make_shape("made:terrain").value();
  const double scale = 0.01 * hills.size();
  const Vec3 middle = 0.5 * (hills.lower() + hills.upper());
  const auto shape_of = [](mesh::TriangleMesh mesh) {
    return Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh))).value();
  };
  const auto ground = shape_of(hills);
  const auto ball = shape_of(mesh::made::make_shape("made:icosphere:radius=" + std::to_string(0.5 * scale)).value());
  std::uint64_t work[2] = {0, 0};
  for (const bool ball_first : {false, true}) {
    Pair pair = (ball_first ? Pair::make(ball, ground) : Pair::make(ground, ball)).value();
    Pair fresh = Pair::make(ground, ball).value();
    math::Pose pose{Mat3::Identity(), Vec3(middle.x(), middle.y(), hills.upper().z() + scale)};
    const auto meets = [&] { return fresh.run(pose, {.method = Method::exact}).verdict == Verdict::hit; };
    while (!meets()) pose.translation.z() -= 0.01 * scale;
    pose.translation.z() += 0.02 * scale;
    for (int run = 0; run < 500; ++run) {
      pose.rotation = Eigen::AngleAxisd(1e-3 * std::sin(0.1 * run), Vec3(1, 2, 3).normalized()).toRotationMatrix();
      const Answer& answer =
          pair.run(ball_first ? pose.inverse() : pose, {.method = Method::incremental, .max_contacts = 0});
      ASSERT_EQ(answer.verdict == Verdict::hit, meets()) << run;
      work[ball_first ? 1 : 0] += answer.cost.node_pairs + answer.cost.triangle_pairs;
    }
  }
  EXPECT_LT(work[1], 2 * work[0] + 1000);
}

INSTANTIATE_TEST_SUITE_P(
    Meshes, IncrementalSmallBudget,
    ::testing::Values(Rocking{"box:x=0.2,y=0.2,z=0.04,cells=8", "icosphere:radius=0.01", 97, 90, 98},
                      Rocking{"torus_knot", "torus_knot", 95, 60, 94},
                      Rocking{"bumpy_sphere", "bumpy_sphere", 95, 60, 94}, Rocking{"gear", "gear", 95, 60, 94},
                      Rocking{"torus", "box:x=0.1,y=0.1,z=0.1,cells=8", 97, 90, 98}));

INSTANTIATE_TEST_SUITE_P(AllVolumes, Incremental,
                         ::testing::Combine(::testing::ValuesIn(testing::all_kinds()), ::testing::Values(64U, 16384U)),
                         [](const auto& tested) {
                           return std::string(volume::name(std::get<0>(tested.param))) + "_" +
                                  std::to_string(std::get<1>(tested.param));
                         });

}  // namespace
}  // namespace odds::query
