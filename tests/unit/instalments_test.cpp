// Searches from the roots that short budgets end, and that the next runs go on with.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"
#include "query/wide/few_leaf_pairs.hpp"
#include "support/shapes.hpp"
#include "support/short_request.hpp"

namespace odds::query {
namespace {

using testing::short_request;

std::shared_ptr<const Shape> gear(int teeth) {
  auto mesh = mesh::made::make_shape("made:gear:module=0.002,backlash=1e-4,width=0.01,teeth=" + std::to_string(teeth));
  return Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value())).value();
}

math::Pose turned(double angle, double x) {
  return {Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix(), {x, 0.0, 0.0}};
}

/// Of gears of 24 and 36 teeth, the first at 5 rad/s and 1 kHz; `into`: radians by which the second has turned into the
/// first beyond the middle of the play between them. Of the second in the first's frame.
math::Pose meshing(int tick, double into) {
  const double angle = 0.005 * tick;
  const double distance = 0.001 * (24 + 36);
  return turned(angle, 0.0).inverse() * turned(std::numbers::pi / 36 - angle * 24 / 36 + into, distance);
}

Request exact() {
  Request request;
  request.method = Method::exact;
  request.max_contacts = 4;
  return request;
}

TEST(Instalments, FindWhereGearsMeetThoughEachRunSeesAFifthOfThem) {
  const auto a = gear(24);
  const auto b = gear(36);
  auto pair = std::move(Pair::make(a, b, {.late_contacts = true})).value();
  realtime::ManualClock clock(280);
  int undecided = 0;
  constexpr int ticks = 600;
  for (int tick = 0; tick < ticks; ++tick) {
    const Answer& answer = pair.run(meshing(tick, 0.004), short_request(clock, 10.0));
    undecided += answer.basis == Basis::budget ? 1 : 0;
    if (answer.basis == Basis::proved) {
      ASSERT_EQ(answer.verdict, Verdict::hit) << tick;
    }
  }
  // Searches that begin anew each time leave three of ten undecided.
  EXPECT_LT(undecided, ticks / 20);
}

TEST(Instalments, ProveNothingThatIsNotSo) {
  const auto a = gear(24);
  const auto b = gear(36);
  auto oracle = std::move(Pair::make(a, b)).value();
  for (const double microseconds : {4.0, 7.0, 12.0, 24.0, 49.0}) {
    auto pair = std::move(Pair::make(a, b, {.late_contacts = true})).value();
    realtime::ManualClock clock(120);
    int hits = 0;
    int clears = 0;
    for (int tick = 0; tick < 1500; ++tick) {
      const math::Pose pose = meshing(tick, 0.0028 + 0.0012 * std::sin(0.05 * tick));
      const Answer& answer = pair.run(pose, short_request(clock, microseconds));
      if (answer.basis != Basis::proved) continue;
      ASSERT_EQ(answer.verdict, oracle.run(pose, exact()).verdict) << microseconds << " us, tick " << tick;
      ++(answer.verdict == Verdict::hit ? hits : clears);
    }
    EXPECT_GT(hits, 100) << microseconds;
    if (microseconds > 20.0) {
      EXPECT_GT(clears, 100) << microseconds;
    }
  }
}

// A hit in leaves that met before is one of which contacts are made, too: time for them used to be kept only if a
// search found it elsewhere.
TEST(Instalments, LeaveTimeForContactsOfWhatMetBefore) {
  auto pair = std::move(Pair::make(gear(24), gear(36), {.late_contacts = true})).value();
  realtime::ManualClock clock(280);
  int beyond = 0;
  int hits = 0;
  constexpr int ticks = 1000;
  for (int tick = 0; tick < ticks; ++tick) {
    const Answer& answer = pair.run(meshing(tick, 0.004), short_request(clock, 5.0));
    hits += answer.basis == Basis::proved && answer.verdict == Verdict::hit ? 1 : 0;
    beyond += answer.cost.overshoot_us > 0.5 ? 1 : 0;
  }
  EXPECT_GT(hits, ticks / 2);
  EXPECT_LT(beyond, ticks / 50);
}

TEST(FewLeafPairs, KeepsEachOnceAndAsManyAsThereIsRoomFor) {
  wide::FewLeafPairs<16> met;
  for (tree::Slot i = 0; i < 40; ++i) met.note({i / 2, 7});
  ASSERT_EQ(met.pairs().size(), 16u);
  EXPECT_EQ(met.pairs()[1], (wide::TwoLeafSlots{1, 7}));
  EXPECT_TRUE(met.has({15, 7}));
  EXPECT_FALSE(met.has({16, 7}));
  met.forget();
  EXPECT_FALSE(met.has({0, 7}));
}

}  // namespace
}  // namespace odds::query
