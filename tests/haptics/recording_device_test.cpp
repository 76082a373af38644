// A run with a device as hardware is, of its own rate and stamps, is repeated by its recording.
#include "odds/haptics/recording_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

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
const std::string scripted = R"(
[device.hand]
type = "scripted"
position_m = [-0.03, 0, 0.03]
[[device.hand.motion]]
kind = "slide"
duration_s = 0.2
by_m = [0, 0, -0.03]
[[device.hand.motion]]
kind = "slide"
duration_s = 0.2
by_m = [0.06, 0.01, 0]
turn_rad = 0.4
)";

/// Measures in its own time, and says so: between two samples nothing is new, and some reads fail.
class Hardware final : public haptics::Device {
 public:
  Hardware(std::unique_ptr<haptics::Device> hand, std::int64_t period_ns)
      : hand_(std::move(hand)), period_(period_ns) {}
  [[nodiscard]] std::optional<Error> open() override { return hand_->open(); }
  void close() noexcept override { hand_->close(); }
  [[nodiscard]] const haptics::DeviceSpec& spec() const noexcept override { return hand_->spec(); }
  [[nodiscard]] bool read(std::int64_t now_ns, haptics::DeviceState& state) noexcept override {
    if (now_ns > 300 * ms && now_ns < 304 * ms) return false;
    const std::int64_t measured_ns = now_ns / period_ * period_;
    if (!hand_->read(measured_ns, state)) return false;
    state.fresh = measured_ns > last_ns_ || now_ns == 0;
    last_ns_ = measured_ns;
    return true;
  }
  bool write(const haptics::DeviceCommand&) noexcept override { return true; }
  bool enable_forces(bool) noexcept override { return true; }
  [[nodiscard]] std::string_view last_error() const noexcept override { return "busy"; }

 private:
  std::unique_ptr<haptics::Device> hand_;
  std::int64_t period_;
  std::int64_t last_ns_ = 0;
};

RunOutcome run(const std::string& device, const std::filesystem::path& base, std::int64_t sample_period_ns = 0) {
  Result<Scene> parsed = parse_scene(world + device + effects, "test.toml", base);
  EXPECT_TRUE(parsed.ok()) << parsed.error().message();
  SimulationOptions options;
  options.simulated_time = true;
  if (sample_period_ns > 0) {
    options.use_device = [=](std::unique_ptr<haptics::Device> hand) {
      return std::make_unique<Hardware>(std::move(hand), sample_period_ns);
    };
  }
  auto made = Simulation::make(std::move(parsed).value(), options);
  EXPECT_TRUE(made.ok()) << made.error().message();
  return made.value()->run();
}

bool same(const haptics::TickRecord& a, const haptics::TickRecord& b) {
  return a.device_position_m == b.device_position_m && a.device_orientation_wxyz == b.device_orientation_wxyz &&
         a.tool_position_m == b.tool_position_m && a.tool_orientation_wxyz == b.tool_orientation_wxyz &&
         a.force_n == b.force_n && a.torque_nm == b.torque_nm;
}

class RecordedHardware : public ::testing::TestWithParam<std::int64_t> {};

TEST_P(RecordedHardware, ReplaysToTheSameForcesBitForBit) {
  const testing::TemporaryFolder folder;
  const RunOutcome original = run(scripted, folder.path(), GetParam());
  EXPECT_EQ(original.failed_reads, 3U);
  ASSERT_FALSE(haptics::write_track(folder / "device.csv", original.device_track).has_value());
  const RunOutcome again = run("[device.hand]\ntype = \"replay\"\nfile = \"device.csv\"\n", folder.path());
  ASSERT_EQ(original.ticks.size(), again.ticks.size());
  const auto different = std::mismatch(original.ticks.begin(), original.ticks.end(), again.ticks.begin(), same);
  EXPECT_EQ(different.first, original.ticks.end()) << "from tick " << different.first->tick << " on";
}

// Faster than the loop, slower, and by turns.
INSTANTIATE_TEST_SUITE_P(Periods, RecordedHardware, ::testing::Values(400'000, 1'300'000, 2'000'000, 3'700'000));

}  // namespace
}  // namespace odds::scene
