// How deep guessed contacts may say that they are.
#include "query/known/guessed_depth.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "odds/query/pair.hpp"
#include "support/short_request.hpp"
#include "support/slabs.hpp"

namespace odds::query {
namespace {

TEST(GuessedDepth, RisesWhileBodiesSinkIn) {
  GuessedDepth depth;
  EXPECT_EQ(depth.most(), tolerances::unmeasured_depth);
  // A bolt shakes where it rises three times as fast, and sinks where it takes three times as long: to twice what need
  // not be measured in some 17 runs.
  depth.note(0.01);
  for (int run = 0; run < 20; ++run) depth.note(0.01);
  EXPECT_NEAR(depth.most(), tolerances::unmeasured_depth, 1e-5) << "it rests, if deep";
  for (int run = 0; run < 17; ++run) depth.note(0.01 + 1e-5 * run);
  EXPECT_NEAR(depth.most(), 2e-4, 1e-5);
  for (int run = 0; run < 16; ++run) depth.note(0.009 - 1e-5 * run);
  EXPECT_NEAR(depth.most(), tolerances::unmeasured_depth, 1e-5) << "it comes out, if it still is deep";
  for (int run = 0; run < 100; ++run) depth.note(5e-5);
  EXPECT_EQ(depth.most(), tolerances::unmeasured_depth);
  for (int run = 0; run < 10000; ++run) depth.note(0.01 + 1e-6 * run);
  EXPECT_NEAR(depth.most(), 2e-3, 1e-12) << "whatever it sinks in";
  depth.forget();
  EXPECT_EQ(depth.most(), tolerances::unmeasured_depth);
}

std::shared_ptr<const Shape> gear(int teeth) {
  return Shape::build(std::make_shared<const mesh::TriangleMesh>(testing::made_mesh(
                          "made:gear:module=0.002,backlash=1e-4,width=0.01,teeth=" + std::to_string(teeth))))
      .value();
}

math::Pose turned(double angle, double x) {
  return {Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix(), {x, 0.0, 0.0}};
}

double deepest(const Answer& answer) {
  double depth = 0.0;
  for (const Contact& contact : answer.contacts) depth = std::max(depth, contact.depth);
  return depth;
}

// Gears that are driven into each other within 5 us: what a guess gave never grew, and they went through each other.
TEST(GuessedDepth, IsGivenToContactsOfGearsThatSinkIn) {
  const auto a = gear(24);
  const auto b = gear(36);
  auto exact = std::move(Pair::make(a, b)).value();
  const double least = tolerances::unmeasured_depth * std::min(a->mesh().size(), b->mesh().size());
  double sum = 0.0;
  const std::vector<std::int64_t> looks_ns = {200, 240, 280, 320};
  for (const std::int64_t look_ns : looks_ns) {
    auto pair = std::move(Pair::make(a, b, {.late_contacts = true})).value();
    realtime::ManualClock clock(look_ns);
    double into = 0.0028;
    double sinking = 0.0;
    int guessed = 0;
    int too_deep = 0;
    for (int tick = 0; tick < 900; ++tick) {
      into += tick < 300 ? 4e-6 : tick < 600 ? -1e-6 : 0.0;
      const double angle = 0.001 * tick;
      const math::Pose pose =
          turned(angle, 0.0).inverse() * turned(std::numbers::pi / 36 - angle * 24 / 36 + into, 0.06);
      const Answer answer = pair.run(pose, testing::short_request(clock, 5.0));
      if (answer.contacts_late) continue;
      const double truly = deepest(exact.run(pose, {.max_contacts = 8}));
      ++guessed;
      too_deep += deepest(answer) > std::max(2.0 * truly, 1.01 * least) ? 1 : 0;
      if (tick >= 250 && tick < 300) sinking = std::max(sinking, deepest(answer));
    }
    EXPECT_GT(guessed, 600) << look_ns;
    EXPECT_LT(too_deep, guessed / 50) << look_ns;
    sum += sinking / least;
  }
  EXPECT_GT(sum / static_cast<double>(looks_ns.size()), 1.8) << "1 where it does not grow";
}

}  // namespace
}  // namespace odds::query
