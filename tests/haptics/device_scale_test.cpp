// What lies between a device and the scene: its scales, what it senses and exerts, and ticks that were missed.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "odds/haptics/passivity.hpp"
#include "odds/scene/explain.hpp"
#include "odds/scene/simulation.hpp"

namespace odds::haptics {
namespace {

using scene::Simulation;
using scene::SimulationOptions;

constexpr std::int64_t ms = 1'000'000;

/// A device that says what the test wants and remembers what it was told.
class Puppet final : public Device {
 public:
  explicit Puppet(DeviceSpec spec) : spec_(std::move(spec)) {}
  [[nodiscard]] std::optional<Error> open() override { return std::nullopt; }
  void close() noexcept override {}
  [[nodiscard]] const DeviceSpec& spec() const noexcept override { return spec_; }
  [[nodiscard]] bool read(std::int64_t now_ns, DeviceState& state) noexcept override {
    state = says;
    state.t_ns = now_ns;
    return true;
  }
  bool write(const DeviceCommand& command) noexcept override {
    if (takes_commands) told = command;
    return takes_commands;
  }
  bool enable_forces(bool on) noexcept override { return !on || takes_forces; }
  [[nodiscard]] std::string_view last_error() const noexcept override { return takes_forces ? "" : "motor off"; }

  bool takes_forces = true;
  bool takes_commands = true;
  DeviceState says;
  DeviceCommand told;

 private:
  DeviceSpec spec_;
};

DeviceSpec six_degrees() {
  DeviceSpec spec;
  spec.name = "puppet";
  spec.actuates_force = true;
  spec.actuates_torque = true;
  return spec;
}

/// A ball in empty space on the hand of a puppet.
struct Stage {
  explicit Stage(const std::string& keys, const DeviceSpec& spec = six_degrees(), const std::string& effects = "") {
    auto parsed = scene::parse_scene(
        "format = \"odds.scene/1\"\n[[mesh]]\nname = \"ball\"\n"
        "file = \"made:icosphere:radius=0.01\"\n[[body]]\nname = \"ball\"\n"
        "mesh = \"ball\"\nmotion = \"dynamic\"\nmass_kg = 0.05\ndevice = \"hand\"\n"
        "[device.hand]\ntype = \"null\"\nmax_force_n = 1000\n" +
            keys + "\n[effects.virtual_coupling]\n" + effects,
        "stage.toml", ".");
    EXPECT_TRUE(parsed.ok()) << parsed.error().message();
    SimulationOptions options;
    options.simulated_time = true;
    options.use_device = [&](std::unique_ptr<Device>) {
      auto made = std::make_unique<Puppet>(spec);
      made->says.fresh = true;
      puppet = made.get();
      return made;
    };
    auto made = Simulation::make(std::move(parsed).value(), options);
    EXPECT_TRUE(made.ok()) << made.error().message();
    simulation = std::move(made).value();
  }
  TickRecord tick(std::int64_t now_ns) {
    TickRecord record;
    simulation->renderer().tick(now_ns, record);
    return record;
  }
  [[nodiscard]] const SafetyCounts& counts() const { return *simulation->renderer().safety_counts(); }

  Puppet* puppet = nullptr;
  std::unique_ptr<Simulation> simulation;
};

TEST(DeviceScale, KeepsEveryBitAtOneAndScalesAboutItsOriginOtherwise) {
  DeviceState state;
  state.position_m = Vec3(0.1, 0.2, 0.3);
  state.velocity_m_per_s = Vec3(1, 2, 3);
  state.angular_velocity_rad_per_s = Vec3(4, 5, 6);
  const DeviceState same = DeviceScale{.origin_m = Vec3(0.7, 0.7, 0.7)}.in_scene(state);
  EXPECT_EQ(same.position_m, state.position_m);
  const DeviceState far = DeviceScale{.workspace = 10.0, .origin_m = Vec3(0.1, 0, 0)}.in_scene(state);
  EXPECT_LT((far.position_m - Vec3(0.1, 2.0, 3.0)).norm(), 1e-12);
  EXPECT_EQ(far.velocity_m_per_s, Vec3(10, 20, 30));
  EXPECT_EQ(far.angular_velocity_rad_per_s, state.angular_velocity_rad_per_s);
}

TEST(DeviceScale, MovesTheToolFartherAndTellsTheDeviceAMultipleOfTheForce) {
  Stage plain("");
  Stage scaled("force_scale = 0.5\nworkspace_scale = 4.0");
  plain.puppet->says.position_m = Vec3(0.004, 0, 0);
  scaled.puppet->says.position_m = Vec3(0.001, 0, 0);
  for (std::int64_t t = 0; t < 5; ++t) {
    const TickRecord a = plain.tick(t * ms);
    const TickRecord b = scaled.tick(t * ms);
    EXPECT_EQ(a.tool_position_m, b.tool_position_m) << t;
    EXPECT_EQ(b.device_position_m[0], 0.004);
    EXPECT_EQ(b.force_n[0], 0.5 * a.force_n[0]) << t;
    EXPECT_LT(b.force_n[0], 0.0);
    EXPECT_EQ(scaled.puppet->told.force_n.x(), b.force_n[0]);
    EXPECT_EQ(b.safety & safety_scaled, unsigned{safety_scaled});
  }
  EXPECT_EQ(scaled.counts().scaled, 5U);
}

TEST(DeviceScale, CountsTheEnergyAtTheDevicesOwnPort) {
  Stage plain("");
  Stage scaled("force_scale = 0.5\nworkspace_scale = 4.0");
  TickRecord a;
  TickRecord b;
  for (std::int64_t t = 0; t < 20; ++t) {
    plain.puppet->says.position_m.x() = 4e-4 * static_cast<double>(t);
    scaled.puppet->says.position_m.x() = 1e-4 * static_cast<double>(t);
    a = plain.tick(t * ms);
    b = scaled.tick(t * ms);
  }
  EXPECT_GT(a.observed_energy_j, 1e-6);
  EXPECT_NEAR(b.observed_energy_j, a.observed_energy_j * 0.5 / 4.0, 1e-9 * a.observed_energy_j);
}

TEST(DeviceScale, WarnsByWhatTheDeviceFeels) {
  DeviceSpec spec = six_degrees();
  spec.physical_damping_ns_per_m = 3.0;  // the coupling's own needs 2.25
  EXPECT_TRUE(Stage("", spec).simulation->warnings().empty());
  EXPECT_EQ(Stage("workspace_scale = 2", spec).simulation->warnings().size(), 1U);
  EXPECT_TRUE(Stage("workspace_scale = 2\nforce_scale = 0.5", spec).simulation->warnings().empty());
}

TEST(DeviceLimits, ADeviceThatSensesNoTurnKeepsItsOrientation) {
  DeviceSpec spec = six_degrees();
  spec.senses_orientation = false;
  Stage stage("", spec);
  stage.puppet->says.orientation.coeffs().setConstant(std::nan(""));  // of a sensor that is not there
  stage.puppet->says.angular_velocity_rad_per_s = Vec3(0, 9, 0);
  stage.puppet->says.position_m = Vec3(0, 0.001, 0);
  const TickRecord record = stage.tick(0);
  EXPECT_EQ(stage.simulation->renderer().failed_reads(), 0U);
  EXPECT_EQ(record.device_orientation_wxyz, (std::array<double, 4>{1, 0, 0, 0}));
  EXPECT_EQ(record.device_position_m[1], 0.001);
  EXPECT_LT(Vec3(record.torque_nm[0], record.torque_nm[1], record.torque_nm[2]).norm(), 1e-12);
}

TEST(DeviceLimits, ADeviceThatSensesNoPositionKeepsItsPlace) {
  DeviceSpec spec = six_degrees();
  spec.senses_position = false;
  Stage stage("", spec);
  stage.puppet->says.position_m = Vec3(1, 1, 1);
  EXPECT_EQ(stage.tick(0).device_position_m, (std::array<double, 3>{0, 0, 0}));
}

TEST(DeviceLimits, ADeviceIsToldOnlyWhatItCanExert) {
  DeviceSpec spec = six_degrees();
  spec.actuates_torque = false;
  Stage forces("", spec);
  spec.actuates_torque = true;
  spec.actuates_force = false;
  Stage torques("", spec);
  for (Stage* stage : {&forces, &torques}) {
    stage->puppet->says.position_m = Vec3(0.002, 0, 0);
    stage->puppet->says.orientation = Quat(Eigen::AngleAxisd(0.1, Vec3::UnitZ()));
    stage->tick(0);
  }
  EXPECT_GT(forces.puppet->told.force_n.norm(), 0.01);
  EXPECT_EQ(forces.puppet->told.torque_nm.norm(), 0.0);
  EXPECT_EQ(torques.puppet->told.force_n.norm(), 0.0);
  EXPECT_GT(torques.puppet->told.torque_nm.norm(), 1e-3);
  EXPECT_EQ(forces.simulation->warnings().size(), 2U) << "the passivity rule, and that there is no torque";
}

TEST(DeviceLimits, AQuaternionThatIsNoRotationIsAFailedReadAndOneNearlySoIsMadeOne) {
  Stage stage("");
  ASSERT_TRUE(stage.simulation->renderer().begin());
  const auto read = [&](const Quat& orientation) {
    stage.puppet->says.orientation = orientation;
    return stage.tick(ms);
  };
  const auto failed = [&] { return stage.simulation->renderer().failed_reads(); };
  read(Quat(0.6, 0.8, 0.0, 0.0));
  EXPECT_EQ(failed(), 0U);
  for (const Quat& odd : {Quat(1.5, 0.5, 0, 0), Quat(0, 0, 0, 0), Quat(NAN, 0, 0, 0)}) {
    const std::uint64_t before = failed();
    const TickRecord record = read(odd);
    EXPECT_EQ(failed(), before + 1);
    EXPECT_EQ(record.device_orientation_wxyz[1], 0.8);  // the last good one
  }
  const TickRecord record = read(Quat(0.6003, 0.8004, 0.0, 0.0));
  EXPECT_EQ(failed(), 3U);
  EXPECT_NEAR(record.device_orientation_wxyz[0], 0.6, 1e-12);
}

TEST(DeviceLimits, ADeviceThatRefusesForcesIsHeard) {
  Stage stage("");
  EXPECT_TRUE(stage.simulation->run_warnings().empty());
  stage.puppet->takes_forces = false;
  (void)stage.simulation->run();
  const std::vector<std::string> warnings = stage.simulation->run_warnings();
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("did not switch its forces on: motor off"), std::string::npos) << warnings[0];
}

TEST(DeviceLimits, WhoLeavesTheWorkspaceIsWarnedOf) {
  DeviceSpec spec = six_degrees();
  spec.workspace_radius_m = 0.1;
  Stage stage("workspace_origin_m = [0.05, 0, 0]\nworkspace_scale = 3", spec);
  stage.puppet->says.position_m = Vec3(0.149, 0, 0);
  stage.tick(0);
  EXPECT_EQ(stage.simulation->workspace_warning(), "") << "counted by the device's own measure";
  stage.puppet->says.position_m = Vec3(0.16, 0, 0);
  stage.tick(ms);
  const std::string warning = stage.simulation->workspace_warning();
  EXPECT_NE(warning.find("0.11 m"), std::string::npos) << warning;
}

// The rule for missed ticks: the device holds the last command, the world goes on by one period for each tick that was
// served.
TEST(MissedTicks, TheWorldGoesOnByOnePeriodForEachTickServed) {
  const std::string falls =
      "[[body]]\nname = \"free\"\nmesh = \"ball\"\nmotion = \"dynamic\"\nmass_kg = 1\n"
      "position_m = [1, 0, 0]\n[effects.gravity]\n";
  Stage punctual("", six_degrees(), falls);
  Stage missing("", six_degrees(), falls);
  for (std::int64_t t = 0; t < 10; ++t) {
    punctual.tick(t * ms);
    missing.tick(40 * t * ms);
  }
  EXPECT_EQ(punctual.simulation->world().state({1}).pose.translation,
            missing.simulation->world().state({1}).pose.translation);
  EXPECT_LT(punctual.simulation->world().state({1}).pose.translation.z(), 0.0);
}

TEST(MissedTicks, InALoopThatOverslept) {
  Stage stage("rise_s = 0.005");
  stage.puppet->says.position_m = Vec3(0.002, 0, 0);
  realtime::SimulatedTime time;
  std::vector<std::uint32_t> flags;
  std::vector<std::uint64_t> skipped;
  const auto summary = realtime::run_periodic({ms, 80}, time.source(), {}, [&](const realtime::Tick& tick) noexcept {
    flags.push_back(stage.tick(static_cast<std::int64_t>(tick.index) * ms).safety);
    skipped.push_back(tick.skipped_before);
    if (tick.index == 10) time.spend(15 * ms);
    if (tick.index == 30) time.spend(26 * ms);
  });
  EXPECT_GT(summary.skipped, 30U);
  EXPECT_EQ(stage.counts().restarted, 1U) << "14 ms are no such gap, 25 are";
  for (std::size_t i = 0; i < flags.size(); ++i) {
    EXPECT_EQ((flags[i] & safety_restarted) != 0, skipped[i] > 20) << i;
  }
  EXPECT_EQ(flags.back() & safety_force_rise, 0U);
}

TEST(MissedTicks, ASilentDevicesForceIsGoneAfterTheSameTimeHoweverManyTicksWereServed) {
  for (const std::int64_t every : {1, 4, 9}) {
    Stage stage("stale_after_s = 0.02\ndecay_s = 0.05");
    stage.puppet->says.position_m = Vec3(0.002, 0, 0);
    stage.tick(0);
    stage.puppet->says.fresh = false;
    std::int64_t gone_ns = 0;
    for (std::int64_t t = every; gone_ns == 0 && t < 300; t += every) {
      const TickRecord record = stage.tick(t * ms);
      if (record.force_n == std::array<double, 3>{}) gone_ns = t * ms;
    }
    EXPECT_GE(gone_ns, 70 * ms) << every;
    EXPECT_LE(gone_ns, (70 + every) * ms) << every;
  }
}

TEST(MissedTicks, AClockThatStandsStillOrLeapsBackHoldsNoStaleForce) {
  for (const std::int64_t step_ns : {std::int64_t{0}, -5 * ms, std::numeric_limits<std::int64_t>::min() / 60}) {
    Stage stage("stale_after_s = 0.02\ndecay_s = 0.05");
    stage.puppet->says.position_m = Vec3(0.002, 0, 0);
    stage.tick(0);
    stage.puppet->says.fresh = false;
    TickRecord record;
    for (std::int64_t t = 1; t <= 60; ++t) record = stage.tick(t * step_ns);
    EXPECT_NE(record.safety & safety_stale, 0U) << step_ns;
    for (int t = 0; t < 20; ++t) record = stage.tick(60 * step_ns);
    EXPECT_EQ(record.force_n, (std::array<double, 3>{})) << step_ns;
    record = stage.tick(std::numeric_limits<std::int64_t>::max());
    EXPECT_EQ(record.force_n, (std::array<double, 3>{})) << step_ns;
    EXPECT_EQ(stage.counts().not_finite, 0U);
  }
}

TEST(MissedTicks, ThePassivityControllerTakesTheSpeedOverTheWholeGap) {
  // The hand is pushed out and goes with the push: energy given. Then as far in a gap as it would have gone in its
  // ticks.
  const auto damped = [](std::int64_t gap) {
    Stage stage("", six_degrees(), "[effects.passivity_control]\nmax_damping_ns_per_m = 1.0\n");
    stage.puppet->says.position_m.x() = 0.01;
    stage.tick(0);
    double x = 0.01;
    for (std::int64_t t = 1; t < 5; ++t) {
      stage.puppet->says.position_m.x() = x -= 0.001;
      stage.tick(t * ms);
    }
    const Vec3 before = stage.simulation->renderer().energy().step_m();
    EXPECT_LT(stage.simulation->renderer().energy().energy_j(), 0.0);
    stage.puppet->says.position_m.x() = x - 1e-3;
    return std::pair{before, stage.tick((4 + gap) * ms).force_n[0]};
  };
  const double at_once = damped(1).second;
  const double after_gap = damped(20).second;
  EXPECT_NEAR(at_once - after_gap, 1.0 - 1.0 / 20.0, 1e-9) << "1 N s/m at 1 m/s, and at a twentieth of it";
}

// What a device did not take does no work: the hand moves under the force that it took last.
TEST(DeviceLimits, WorkIsThatOfTheForceThatTheDeviceTook) {
  Stage stage("");
  stage.puppet->says.position_m = Vec3(0.001, 0, 0);
  static_cast<void>(stage.tick(0));
  const TickRecord last_taken = stage.tick(ms);
  const Vec3 taken = stage.puppet->told.force_n;
  ASSERT_LT(taken.x(), -0.01) << "back to the tool";
  stage.puppet->takes_commands = false;
  double energy_j = last_taken.observed_energy_j;
  for (int i = 2; i < 6; ++i) {
    stage.puppet->says.position_m.x() += 0.001;
    energy_j -= 0.001 * taken.x();
    EXPECT_NEAR(stage.tick(i * ms).observed_energy_j, energy_j, 1e-12) << i;
  }
}

}  // namespace
}  // namespace odds::haptics
