// Contacts within a limit at the poses of the run without one.
#include "odds/scene/same_poses.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include "support/ball_on_terrain.hpp"

namespace odds::scene {
namespace {

const std::string world = R"(
format = "odds.scene/1"
[loop]
seconds = 0.4
)" + testing::ball_on_terrain +
                          "[effects.contact]\n[effects.virtual_coupling]\n";

std::string hand(const std::string& type) {
  return testing::hand_onto_terrain(type) + R"([[device.hand.motion]]
kind = "slide"
duration_s = 0.2
by_m = [0.03, 0.01, 0]
)";
}

Scene scene(const std::string& device = "scripted") {
  Result<Scene> parsed = parse_scene(world + hand(device), "test.toml", ".");
  EXPECT_TRUE(parsed.ok()) << parsed.error().message();
  return std::move(parsed).value();
}

struct Runs {
  double exact_n = 0.0;  // sums over the ticks
  double apart_n = 0.0;  // of the first limit from the exact run
  std::uint32_t contacts = 0;
  std::uint32_t missed = 0;  // ticks in which only the limited one has none
  std::vector<haptics::TickRecord> ticks;
};

Runs run(const Scene& scene, const query::Budget& limit) {
  auto made = SamePoses::make(scene, {limit}, {});
  EXPECT_TRUE(made.ok()) << made.error().message();
  Runs runs;
  for (std::int64_t tick = 0; tick < 400; ++tick) {
    haptics::TickRecord record;
    made.value()->tick(tick * 1'000'000, record);
    const ToolContact& exact = made.value()->exact();
    const ToolContact& limited = made.value()->limited(0);
    runs.exact_n += exact.force_n.norm();
    runs.apart_n += (limited.force_n - exact.force_n).norm();
    runs.contacts += exact.contacts;
    if (exact.contacts > 0 && limited.contacts == 0) ++runs.missed;
    runs.ticks.push_back(record);
  }
  return runs;
}

TEST(SamePoses, WithoutALimitTheForcesAreThoseOfTheLeader) {
  for (const char* device : {"scripted", "human_arm"}) {
    const Runs runs = run(scene(device), query::Budget::unlimited());
    EXPECT_GT(runs.contacts, 100U);
    EXPECT_GT(runs.exact_n, 10.0);
    EXPECT_LT(runs.apart_n, 1e-6 * runs.exact_n) << device;
    EXPECT_EQ(runs.missed, 0U);
  }
}

TEST(SamePoses, ALimitThatFindsHardlyAnythingIsSeenAndDoesNotTouchTheLeader) {
  const Runs runs = run(scene(), query::Budget::work(1));
  EXPECT_GT(runs.apart_n, 0.3 * runs.exact_n);
  // The leader goes as if it were alone, with contacts that are made anew in every tick.
  SimulationOptions options;
  options.simulated_time = true;
  Scene anew = scene();
  anew.query.carry_motion = 0.0;
  auto alone = Simulation::make(anew, options);
  ASSERT_TRUE(alone.ok());
  alone.value()->device()->enable_forces(true);
  for (std::size_t tick = 0; tick < runs.ticks.size(); ++tick) {
    haptics::TickRecord record;
    alone.value()->renderer().tick(static_cast<std::int64_t>(tick) * 1'000'000, record);
    ASSERT_EQ(std::memcmp(&record.force_n, &runs.ticks[tick].force_n, sizeof record.force_n), 0) << tick;
    ASSERT_EQ(std::memcmp(&record.tool_position_m, &runs.ticks[tick].tool_position_m, sizeof record.force_n), 0);
  }
}

TEST(SamePoses, TheLeaderHasNoFrameEitherAndTheLimitedRunsKeepThatOfTheScene) {
  Scene framed = scene();
  framed.frame = query::Budget::work(1);
  const Runs free = run(scene(), query::Budget::unlimited());
  const Runs runs = run(framed, query::Budget::unlimited());
  EXPECT_EQ(runs.exact_n, free.exact_n);
  EXPECT_EQ(runs.contacts, free.contacts);
  EXPECT_GT(runs.apart_n, 0.1 * runs.exact_n) << "a frame of one unit finds hardly anything";
}

TEST(SamePoses, TheForceOfContactsAtRestBalancesTheHand) {
  auto made = SamePoses::make(scene(), {query::Budget::unlimited()}, {});
  ASSERT_TRUE(made.ok());
  haptics::TickRecord record;
  for (std::int64_t tick = 0; tick < 400; ++tick) made.value()->tick(tick * 1'000'000, record);
  for (std::int64_t tick = 400; tick < 2000; ++tick) made.value()->tick(tick * 1'000'000, record);  // the hand rests
  const Vec3 on_hand(record.force_n[0], record.force_n[1], record.force_n[2]);
  ASSERT_GT(on_hand.norm(), 0.5);
  EXPECT_LT((made.value()->exact().force_n - on_hand).norm(), 0.01 * on_hand.norm());
}

TEST(SamePoses, NeedsAHand) {
  Scene without = scene();
  without.device.reset();
  const auto made = SamePoses::make(without, {}, {});
  ASSERT_FALSE(made.ok());
  EXPECT_NE(made.error().remedy.find("[device.NAME]"), std::string::npos);
}

}  // namespace
}  // namespace odds::scene
