// A thread touches with thousands of pairs of triangles: more than are kept, and more than there is time for. What is
// made of a sample of them must hold the bolt up, and not throw it out.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numbers>
#include <string>

#include "odds/math/pose.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"
#include "odds/realtime/clock.hpp"

namespace odds::query {
namespace {

std::shared_ptr<const Shape> shape_of(const std::string& name) {
  return Shape::build(std::make_shared<const mesh::TriangleMesh>(mesh::made::make_shape(name).value())).value();
}

double deepest(const Answer& answer) {
  double depth = 0.0;
  for (const Contact& contact : answer.contacts) depth = std::max(depth, contact.depth);
  return depth;
}

/// A bolt in a nut whose thread rises by 1.25 mm a turn, pressed down by 0.13 mm (0.04 mm of it through air) in 160
/// runs, then screwed in by half a turn in 440.
math::Pose pressed_and_screwed(int run) {
  const double turn = std::max(run - 160, 0) * std::numbers::pi / 440.0;
  const double down = std::min(run, 160) * 0.8e-6 + turn / (2.0 * std::numbers::pi) * 0.00125;
  return {Eigen::AngleAxisd(-turn, Vec3::UnitZ()).toRotationMatrix(), {0.0, 0.0, 0.0025 - down}};
}

class BoltInItsNut : public ::testing::TestWithParam<const char*> {
 protected:
  std::shared_ptr<const Shape> bolt = shape_of(std::string("bolt") + GetParam());
  std::shared_ptr<const Shape> nut = shape_of(std::string("nut") + GetParam());
};

TEST_P(BoltInItsNut, IsHeldByAsMuchAsItIsDeep) {
  // A search that was never done before the bodies touched does not know them apart: from then on it knows the motion.
  for (const std::uint64_t units : {1000U, 5000U, 20000U, 0U}) {
    auto sampled = std::move(Pair::make(nut, bolt)).value();
    auto all = std::move(Pair::make(nut, bolt, {.hit_capacity = 65536})).value();
    Request request;
    request.max_contacts = 8;
    if (units > 0) request.budget = Budget::work(units);
    int touching = 0;
    int shallow = 0;
    int deep = 0;
    for (int run = 0; run <= 600; ++run) {
      const double exact = deepest(all.run(pressed_and_screwed(run), {.max_contacts = 8}));
      const double found = deepest(sampled.run(pressed_and_screwed(run), request));
      if (exact < 5e-6) continue;
      ++touching;
      shallow += found < 0.8 * exact ? 1 : 0;
      deep += found > 2.6 * exact ? 1 : 0;
    }
    EXPECT_GT(touching, 500);
    EXPECT_LE(shallow, 2) << units << " units";  // where it begins
    EXPECT_LE(deep, 4) << units << " units";
  }
}

TEST_P(BoltInItsNut, ExactRunsForgetThePoseBefore) {
  // More pairs meet than are kept. Far from where it last was, a body is as deep as it is found to be; nearby it comes
  // to be, in a few runs.
  const math::Pose deep{Mat3::Identity(), {0.0, 0.0, 0.0023}};
  auto fresh = std::move(Pair::make(nut, bolt)).value();
  const double once = deepest(fresh.run(deep, {.max_contacts = 8}));
  EXPECT_GT(once, 1e-4);
  for (const Vec3& far : {Vec3(0.0, 0.0, 1.0), Vec3(0.0, 0.01, 0.0), Vec3(0.0, 0.0, -0.003)}) {
    auto pair = std::move(Pair::make(nut, bolt)).value();
    static_cast<void>(pair.run({Mat3::Identity(), far}, {.max_contacts = 8}));
    const double found = deepest(pair.run(deep, {.max_contacts = 8}));
    EXPECT_GE(found, 0.95 * once) << "a normal that was known breaks ties";
    EXPECT_LE(found, 1.3 * once);
    // Threads that are in each other have many summits: what is known now may lead to a higher one, and stays.
    const double settled = deepest(pair.run(deep, {.max_contacts = 8}));
    EXPECT_GE(settled, (1.0 - 1e-12) * found);
    EXPECT_LE(settled, 1.3 * once);
    for (int run = 0; run < 4; ++run) {
      EXPECT_NEAR(deepest(pair.run(deep, {.max_contacts = 8})), settled, 1e-12 * settled) << run;
    }
    pair.reset();
    EXPECT_EQ(deepest(pair.run(deep, {.max_contacts = 8})), once);
  }
  for (const double higher : {4e-4, 2e-4, 1.5e-4, -1e-4, -3e-4}) {
    auto pair = std::move(Pair::make(nut, bolt)).value();
    static_cast<void>(pair.run({Mat3::Identity(), {0.0, 0.0, 0.0023 + higher}}, {.max_contacts = 8}));
    for (int run = 0; run < 8; ++run) static_cast<void>(pair.run(deep, {.max_contacts = 8}));
    const double found = deepest(pair.run(deep, {.max_contacts = 8}));
    EXPECT_GE(found, 0.5 * once) << higher;  // which of several patches comes first is also the last one's choice
    EXPECT_LE(found, 2.5 * once) << higher;
  }
}

TEST_P(BoltInItsNut, OneStarvedRunDoesNotMakeASingleContactShallow) {
  const math::Pose deep{Mat3::Identity(), {0.0, 0.0, 0.0023}};
  auto pair = std::move(Pair::make(nut, bolt)).value();
  const double once = deepest(pair.run(deep, {}));
  EXPECT_GT(once, 0.0);
  realtime::ManualClock clock(900);
  static_cast<void>(pair.run(deep, {.budget = {.microseconds = 2.0, .clock = clock.clock()}}));
  EXPECT_EQ(deepest(pair.run(deep, {})), once);
}

TEST(StarvedBall, IsHeldOnTheOtherSideOfAPlateToo) {
  // It lay on top; what is known of that says nothing of the side below, where no run has time to measure.
  const auto plate = shape_of("box:x=0.2,y=0.2,z=0.02,cells=8");
  const auto ball = shape_of("icosphere:radius=0.01");
  auto pair = std::move(Pair::make(plate, ball)).value();
  static_cast<void>(pair.run({Mat3::Identity(), {0.0, 0.0, 0.0195}}, {.max_contacts = 8}));
  double last = 0.0;
  for (int run = 0; run <= 100; ++run) {
    const math::Pose pose{Mat3::Identity(), {0.0, 0.0, -0.0201 + 1e-5 * run}};
    last = deepest(pair.run(pose, {.method = Method::incremental, .budget = Budget::work(60), .max_contacts = 8}));
  }
  EXPECT_GT(last, 3e-4) << "of 0.9 mm";
  EXPECT_LT(last, 1.2e-3);
}

INSTANTIATE_TEST_SUITE_P(Threads, BoltInItsNut, ::testing::Values("", ":around=36,rows=2"));

}  // namespace
}  // namespace odds::query
