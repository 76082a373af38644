// A run with a device as hardware is, of its own rate and stamps, is repeated by its recording.
#include "odds/haptics/recording_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>

#include "haptics/device_around.hpp"
#include "odds/scene/simulation.hpp"
#include "support/ball_on_terrain.hpp"
#include "support/temporary_folder.hpp"

namespace odds::scene {
namespace {

constexpr std::int64_t ms = 1'000'000;

const std::string world = R"(format = "odds.scene/1"
[loop]
seconds = 0.5
[query]
work_units = 1200
)" + testing::ball_on_terrain;
const std::string effects = "[effects.contact]\n[effects.virtual_coupling]\n";
const std::string scripted = testing::hand_onto_terrain() + R"(
[[device.hand.motion]]
kind = "slide"
duration_s = 0.2
by_m = [0.06, 0.01, 0]
turn_rad = 0.4
)";

/// Measures in its own time, and says so: between two samples nothing is new, and some reads fail.
class Hardware final : public testing::DeviceAround {
 public:
  Hardware(std::unique_ptr<haptics::Device> hand, std::int64_t period_ns)
      : DeviceAround(std::move(hand)), period_(period_ns) {}
  [[nodiscard]] bool read(std::int64_t now_ns, haptics::DeviceState& state) noexcept override {
    if (now_ns > 300 * ms && now_ns < 304 * ms) return false;
    const std::int64_t measured_ns = now_ns / period_ * period_;
    if (!DeviceAround::read(measured_ns, state)) return false;
    state.fresh = measured_ns > last_ns_ || now_ns == 0;
    last_ns_ = measured_ns;
    return true;
  }

 private:
  std::int64_t period_;
  std::int64_t last_ns_ = 0;
};

/// Senses only how it is turned; of its place it says something at the start, and then something else in each read.
class Compass final : public testing::DeviceAround {
 public:
  Compass(std::unique_ptr<haptics::Device> hand, double drift_m) : DeviceAround(std::move(hand)), drift_m_(drift_m) {
    change_spec().senses_position = false;
  }
  [[nodiscard]] bool read(std::int64_t now_ns, haptics::DeviceState& state) noexcept override {
    if (!DeviceAround::read(now_ns, state)) return false;
    if (reads_++ == 0) return true;
    state.position_m = Vec3::Constant(drift_m_ * reads_);
    state.velocity_m_per_s = state.position_m;
    return true;
  }

 private:
  double drift_m_;
  int reads_ = 0;
};

using UseDevice = std::function<std::unique_ptr<haptics::Device>(std::unique_ptr<haptics::Device>)>;

RunOutcome run(const std::string& device, const std::filesystem::path& base, const UseDevice& use_device = {},
               const std::string& more_effects = "") {
  Result<Scene> parsed = parse_scene(world + device + effects + more_effects, "test.toml", base);
  EXPECT_TRUE(parsed.ok()) << parsed.error().message();
  SimulationOptions options;
  options.simulated_time = true;
  options.use_device = use_device;
  auto made = Simulation::make(std::move(parsed).value(), options);
  EXPECT_TRUE(made.ok()) << made.error().message();
  return made.value()->run();
}

bool same(const haptics::TickRecord& a, const haptics::TickRecord& b) {
  return a.device_position_m == b.device_position_m && a.device_orientation_wxyz == b.device_orientation_wxyz &&
         a.tool_position_m == b.tool_position_m && a.tool_orientation_wxyz == b.tool_orientation_wxyz &&
         a.force_n == b.force_n && a.torque_nm == b.torque_nm;
}

void expect_same_replay(const RunOutcome& original, const testing::TemporaryFolder& folder,
                        const std::string& more_effects = "") {
  ASSERT_FALSE(haptics::write_track(folder / "device.csv", original.device_track).has_value());
  const RunOutcome again =
      run("[device.hand]\ntype = \"replay\"\nfile = \"device.csv\"\n", folder.path(), {}, more_effects);
  ASSERT_EQ(original.ticks.size(), again.ticks.size());
  const auto different = std::mismatch(original.ticks.begin(), original.ticks.end(), again.ticks.begin(), same);
  EXPECT_EQ(different.first, original.ticks.end()) << "from tick " << different.first->tick << " on";
}

class RecordedHardware : public ::testing::TestWithParam<std::int64_t> {};

TEST_P(RecordedHardware, ReplaysToTheSameForcesBitForBit) {
  const testing::TemporaryFolder folder;
  const RunOutcome original = run(scripted, folder.path(), [](std::unique_ptr<haptics::Device> hand) {
    return std::make_unique<Hardware>(std::move(hand), GetParam());
  });
  EXPECT_EQ(original.failed_reads, 3U);
  expect_same_replay(original, folder);
}

// Faster than the loop, slower, and by turns.
INSTANTIATE_TEST_SUITE_P(Periods, RecordedHardware, ::testing::Values(400'000, 1'300'000, 2'000'000, 3'700'000));

// The controller asks for how long the hand took for its way: the replay said in every tick that all was new.
TEST_P(RecordedHardware, ReplaysBitForBitUnderAPassivityController) {
  const std::string more = "[effects.passivity_control]\n[effects.gravity]\n";  // the weight gives the hand energy
  const testing::TemporaryFolder folder;
  const RunOutcome original = run(
      scripted, folder.path(),
      [](std::unique_ptr<haptics::Device> hand) { return std::make_unique<Hardware>(std::move(hand), GetParam()); },
      more);
  EXPECT_LT(original.least_energy_j, 0.0);
  EXPECT_GT(original.effects.back().evaluations, 20U) << original.effects.back().name;
  expect_same_replay(original, folder, more);
}

class RecordedCompass : public ::testing::TestWithParam<double> {};

TEST_P(RecordedCompass, ReplaysToTheSameForcesBitForBit) {
  const testing::TemporaryFolder folder;
  const RunOutcome original = run(scripted, folder.path(), [](std::unique_ptr<haptics::Device> hand) {
    return std::make_unique<Compass>(std::move(hand), GetParam());
  });
  EXPECT_EQ(original.failed_reads, 0U);
  EXPECT_EQ(original.device_track.states.size(), original.ticks.size());
  EXPECT_EQ(original.ticks.back().device_position_m, (std::array<double, 3>{-0.03, 0, 0.03}));
  EXPECT_NE(original.ticks.back().device_orientation_wxyz, original.ticks.front().device_orientation_wxyz);
  expect_same_replay(original, folder);
}

INSTANTIATE_TEST_SUITE_P(Drifts, RecordedCompass, ::testing::Values(1e-4, std::nan("")));

/// Says absurd numbers now and then.
class Wild final : public testing::DeviceAround {
 public:
  using DeviceAround::DeviceAround;
  [[nodiscard]] bool read(std::int64_t now_ns, haptics::DeviceState& state) noexcept override {
    const bool told = DeviceAround::read(now_ns, state);
    if (now_ns == 100 * ms) state.velocity_m_per_s.x() = 1e300;
    if (now_ns == 200 * ms) state.position_m.y() = -2e12;
    if (now_ns == 300 * ms) state.angular_velocity_rad_per_s.z() = 1e13;
    return told;
  }
};

// A track's reader refuses numbers beyond 1e12, and so the whole recording of which one row had one.
TEST(RecordedNonsense, OfNumbersBeyondAllMeasureIsAFailedRead) {
  const testing::TemporaryFolder folder;
  const RunOutcome original = run(scripted, folder.path(), [](std::unique_ptr<haptics::Device> hand) {
    return std::make_unique<Wild>(std::move(hand));
  });
  EXPECT_EQ(original.failed_reads, 3U);
  expect_same_replay(original, folder);
}

/// Says nothing from one time to another, of a hand that moves.
class Silent final : public testing::DeviceAround {
 public:
  Silent(std::unique_ptr<haptics::Device> hand, std::int64_t from_ns, std::int64_t to_ns, bool fails)
      : DeviceAround(std::move(hand)), from_(from_ns), to_(to_ns), fails_(fails) {}
  [[nodiscard]] bool read(std::int64_t now_ns, haptics::DeviceState& state) noexcept override {
    const bool silent = now_ns > from_ && now_ns < to_;
    if (silent && fails_) return false;
    if (!DeviceAround::read(silent ? from_ : now_ns, state)) return false;
    state.fresh = !silent;
    return true;
  }

 private:
  std::int64_t from_;
  std::int64_t to_;
  bool fails_;
};

// A recording did not say that a device was silent: the force that had decayed stayed in the replay.
TEST(RecordedSilence, DecaysInTheReplayAsItDidBitForBit) {
  for (const bool fails : {false, true}) {
    for (const std::int64_t to_ms : {310, 1000}) {
      const testing::TemporaryFolder folder;
      const RunOutcome original = run(scripted, folder.path(), [&](std::unique_ptr<haptics::Device> hand) {
        return std::make_unique<Silent>(std::move(hand), 250 * ms, to_ms * ms, fails);
      });
      EXPECT_GT(original.safety.stale, 30U);
      EXPECT_EQ(original.device_track.states.size(), original.ticks.size());
      expect_same_replay(original, folder);
    }
  }
}

}  // namespace
}  // namespace odds::scene
