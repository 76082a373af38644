// The hand that gives way: its equation of motion, the edge of stability against a stiff wall, the balance of energy.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "odds/haptics/human_arm_device.hpp"
#include "odds/haptics/passivity.hpp"
#include "odds/haptics/virtual_coupling.hpp"
#include "odds/scene/simulation.hpp"
#include "support/temporary_folder.hpp"

namespace odds::haptics {
namespace {

HumanArmDevice arm_at_origin(const HumanArm& arm) {
  return {std::make_unique<ScriptedDevice>(math::Pose{}, std::vector<Motion>{}, false), arm};
}

TEST(HumanArm, RingsAtTheFrequencyOfItsMassAndSpring) {
  HumanArm arm;
  arm.device_damping_ns_per_m = 0.0;
  arm.arm_damping_ns_per_m = 0.2;
  HumanArmDevice device = arm_at_origin(arm);
  DeviceState state;
  ASSERT_TRUE(device.read(0, state));
  device.enable_forces(true);
  ASSERT_TRUE(device.read(0, state));
  device.write({0, Vec3(1.0, 0, 0), Vec3::Zero(), 0});
  const double m = arm.device_mass_kg + arm.arm_mass_kg;
  const double d = 0.2 / (2.0 * m);
  const double w = std::sqrt(arm.arm_stiffness_n_per_m / m - d * d);
  for (std::int64_t ms = 1; ms < 600; ++ms) {
    ASSERT_TRUE(device.read(ms * 1'000'000, state));
    const double t = 1e-3 * static_cast<double>(ms);
    const double expected =
        1.0 / arm.arm_stiffness_n_per_m * (1.0 - std::exp(-d * t) * (std::cos(w * t) + d / w * std::sin(w * t)));
    ASSERT_NEAR(state.position_m.x(), expected, 1e-6) << ms;
  }
}

TEST(HumanArm, TurnsUnderATorqueAsFarAsItsGripAllows) {
  HumanArmDevice device = arm_at_origin({});
  DeviceState state;
  device.enable_forces(true);
  ASSERT_TRUE(device.read(0, state));
  device.write({0, Vec3::Zero(), Vec3(0, 0.2, 0), 0});
  for (std::int64_t ms = 1; ms <= 1000; ++ms) ASSERT_TRUE(device.read(ms * 1'000'000, state));
  const Eigen::AngleAxisd turn(state.orientation);
  EXPECT_NEAR(turn.angle() * turn.axis().y(), 0.1, 1e-4);
}

TEST(HumanArm, FeelsNothingWhileForcesAreOffAndRefusesWhatIsNotFinite) {
  HumanArmDevice device = arm_at_origin({});
  DeviceState state;
  ASSERT_TRUE(device.read(0, state));
  EXPECT_TRUE(device.write({0, Vec3(5, 0, 0), Vec3::Zero(), 0}));
  ASSERT_TRUE(device.read(50'000'000, state));
  EXPECT_EQ(state.position_m.norm(), 0.0);
  EXPECT_FALSE(device.write({0, Vec3(NAN, 0, 0), Vec3::Zero(), 0}));
  device.enable_forces(true);
  ASSERT_TRUE(device.read(60'000'000, state));
  ASSERT_TRUE(device.read(70'000'000, state));
  EXPECT_EQ(state.position_m.norm(), 0.0);
}

TEST(HumanArm, SensesInStepsOfItsResolution) {
  HumanArm arm;
  arm.resolution_m = 1e-4;
  HumanArmDevice device = arm_at_origin(arm);
  DeviceState state;
  device.enable_forces(true);
  ASSERT_TRUE(device.read(0, state));
  device.write({0, Vec3(0.5, 0, 0), Vec3::Zero(), 0});
  double last = 0.0;
  for (std::int64_t ms = 1; ms <= 100; ++ms) {
    ASSERT_TRUE(device.read(ms * 1'000'000, state));
    const double steps = state.position_m.x() / 1e-4;
    ASSERT_NEAR(steps, std::round(steps), 1e-9);
    ASSERT_NEAR(state.velocity_m_per_s.x(), (state.position_m.x() - last) / 1e-3, 1e-12);
    last = state.position_m.x();
  }
}

TEST(PassivityObserver, CountsTheWorkOfTheHeldForce) {
  PassivityObserver observer;
  DeviceState state;
  observer.reset(state);
  observer.sent(Vec3(0, 0, 2.0), Vec3(0.5, 0, 0));
  state.position_m = Vec3(0.3, 0, -0.01);  // the hand pushes 1 cm against 2 N: 20 mJ go in
  observer.moved(state);
  EXPECT_NEAR(observer.energy_j(), 0.02, 1e-15);
  state.orientation = Quat(Eigen::AngleAxisd(0.1, Vec3::UnitX()));  // the torque turns the hand: 50 mJ come out
  observer.moved(state);
  EXPECT_NEAR(observer.energy_j(), -0.03, 1e-12);
  EXPECT_NEAR(observer.least_j(), -0.03, 1e-12);
  observer.reset(state);
  EXPECT_EQ(observer.energy_j(), 0.0);
}

// A hand presses a light tool against a wall: coupling and contact in series are the wall's stiffness.
struct Wall {
  double k_n_per_m = 2000.0;  // of the coupling; the contact is so stiff that it does not count
  double b_ns_per_m = 0.0;    // of the coupling
  int rate_hz = 1000;
  double damping_ns_per_m = 1.0;  // of the mechanism and the grip together
  bool controller = false;
};

scene::Scene wall_scene(const Wall& wall) {
  const auto number = [](double x) { return std::to_string(x); };
  const std::string text =
      "format = \"odds.scene/1\"\n[loop]\nrate_hz = " + std::to_string(wall.rate_hz) +
      "\nseconds = 1.5\n[query]\nwork_units = 20000\n"
      "[[mesh]]\nname = \"slab\"\nfile = \"made:box:x=0.2,y=0.2,z=0.1\"\n[[mesh]]\nname = \"tip\"\nfile = "
      "\"made:box:x=0.01,y=0.01,z=0.01\"\n"
      "[[body]]\nname = \"wall\"\nmesh = \"slab\"\nposition_m = [0, 0, -0.05]\n"
      "[[body]]\nname = \"tool\"\nmesh = \"tip\"\nmotion = \"dynamic\"\nmass_kg = 0.001\ndevice = \"hand\"\n"
      "[device.hand]\ntype = \"human_arm\"\nposition_m = [0, 0, 0.0049]\nmax_force_n = 1000\nphysical_damping_ns_per_m "
      "= " +
      number(0.8 * wall.damping_ns_per_m) + "\narm_damping_ns_per_m = " + number(0.2 * wall.damping_ns_per_m) +
      "\narm_stiffness_n_per_m = 300\ndevice_mass_kg = 0.05\narm_mass_kg = 0.05\n"
      "[[device.hand.motion]]\nkind = \"slide\"\nduration_s = 0.4\nby_m = [0, 0, -0.02]\n"
      "[effects.contact]\nstiffness_n_per_m = 1e7\ndamping_ns_per_m = 0\nmax_correcting_velocity_m_per_s = 100\n"
      "[effects.virtual_coupling]\nk_t_n_per_m = " +
      number(wall.k_n_per_m) + "\nb_t_ns_per_m = " + number(wall.b_ns_per_m) + "\n" +
      (wall.controller ? "[effects.passivity_control]\nmax_damping_ns_per_m = 20\n" : "");
  auto parsed = scene::parse_scene(text, "wall.toml", ".");
  EXPECT_TRUE(parsed.ok()) << (parsed.ok() ? "" : parsed.error().message());
  return std::move(parsed).value();
}

struct Felt {
  double early_m_per_s = 0.0;   // RMS of the hand's speed soon after the script has come to rest
  double unrest_m_per_s = 0.0;  // the same at the end of the run
  double least_energy_j = 0.0;
  double mean_force_n = 0.0;
  std::vector<std::string> warnings;
};

Felt press(const Wall& wall) {
  scene::SimulationOptions options;
  options.simulated_time = true;
  auto made = scene::Simulation::make(wall_scene(wall), options);
  EXPECT_TRUE(made.ok()) << (made.ok() ? "" : made.error().message());
  const scene::RunOutcome outcome = made.value()->run();
  Felt felt;
  felt.warnings = made.value()->warnings();
  felt.least_energy_j = outcome.least_energy_j;
  const auto unrest = [&](double from_s, double to_s) {
    const auto first = static_cast<std::size_t>(from_s * wall.rate_hz);
    const auto last = static_cast<std::size_t>(to_s * wall.rate_hz);
    double sum = 0.0;
    for (std::size_t i = first; i < last; ++i) {
      const double step = outcome.ticks[i].device_position_m[2] - outcome.ticks[i - 1].device_position_m[2];
      sum += step * step * wall.rate_hz * wall.rate_hz / static_cast<double>(last - first);
    }
    return std::sqrt(sum);
  };
  felt.early_m_per_s = unrest(0.6, 0.9);
  felt.unrest_m_per_s = unrest(1.2, 1.5);
  const std::size_t count = outcome.ticks.size() / 5;
  for (std::size_t i = outcome.ticks.size() - count; i < outcome.ticks.size(); ++i) {
    felt.mean_force_n += outcome.ticks[i].force_n[2] / static_cast<double>(count);
  }
  return felt;
}

// Damping at which an oscillation neither grows nor dies, by halving.
double edge_of_stability(Wall wall) {
  double unstable = 0.0;
  double stable = 10.0;
  for (int i = 0; i < 9; ++i) {
    wall.damping_ns_per_m = 0.5 * (unstable + stable);
    const Felt felt = press(wall);
    const bool dies =
        felt.unrest_m_per_s < 1e-5 || (felt.unrest_m_per_s < felt.early_m_per_s && felt.unrest_m_per_s < 0.05);
    (dies ? stable : unstable) = wall.damping_ns_per_m;
  }
  return stable;
}

class StiffWall : public ::testing::TestWithParam<std::pair<double, int>> {};

// The rule says b = K T / 2 for a wall without damping; b is all that damps the hand: mechanism and grip.
TEST_P(StiffWall, BecomesUnstableWhereTheSampledDataRuleSays) {
  const auto [k, rate] = GetParam();
  const double predicted = 0.5 * k / rate;
  const double found = edge_of_stability({k, 0.0, rate, 0.0, false});
  RecordProperty("predicted", std::to_string(predicted));
  RecordProperty("found", std::to_string(found));
  std::printf("  K %.0f N/m at %d Hz: the rule says %.3f N s/m, the sweep finds %.3f (%+.1f %%)\n", k, rate, predicted,
              found, 100.0 * (found / predicted - 1.0));
  EXPECT_NEAR(found, predicted, 0.2 * predicted);
}
INSTANTIATE_TEST_SUITE_P(StiffnessAndRate, StiffWall,
                         ::testing::Values(std::pair{2000.0, 1000}, std::pair{1000.0, 500}, std::pair{4000.0, 2000}));

TEST(HumanArm, AWallThatKeepsTheRuleIsQuietAndOneThatBreaksItWarnsAndBuzzes) {
  const Felt good = press({2000.0, 0.0, 1000, 2.0, false});
  EXPECT_LT(good.unrest_m_per_s, 1e-3);
  EXPECT_GT(good.mean_force_n, 3.0);
  EXPECT_TRUE(good.warnings.empty()) << good.warnings.front();
  const Felt bad = press({2000.0, 0.0, 1000, 0.4, false});
  EXPECT_GT(bad.unrest_m_per_s, 0.01);
  EXPECT_LT(bad.least_energy_j, -1e-3) << "the observer must see that energy comes out";
  ASSERT_FALSE(bad.warnings.empty());
  EXPECT_NE(bad.warnings.front().find("K T/2"), std::string::npos);
}

TEST(HumanArm, TheControllerQuietsAWallThatBreaksTheRule) {
  const Felt without = press({2000.0, 0.0, 1000, 0.6, false});
  const Felt with = press({2000.0, 0.0, 1000, 0.6, true});
  std::printf(
      "  b = 0.6 of 1.0 N s/m: RMS speed of the hand %.4f m/s, with the controller %.4f; least energy %.4f and %.4f "
      "J\n",
      without.unrest_m_per_s, with.unrest_m_per_s, without.least_energy_j, with.least_energy_j);
  EXPECT_LT(with.unrest_m_per_s, 0.25 * without.unrest_m_per_s);
  EXPECT_GT(with.least_energy_j, 0.1 * without.least_energy_j);
}

TEST(HumanArm, ItsRecordedPathReplaysToTheSameForcesBitForBit) {
  const testing::TemporaryFolder folder;
  scene::SimulationOptions options;
  options.simulated_time = true;
  auto first = scene::Simulation::make(wall_scene({}), options);
  ASSERT_TRUE(first.ok());
  const scene::RunOutcome original = first.value()->run();
  ASSERT_FALSE(write_track(folder / "device.csv", original.device_track).has_value());
  scene::Scene again = wall_scene({});
  const std::string table =
      "format = \"odds.scene/1\"\n[[mesh]]\nname = \"m\"\nfile = \"made:box\"\n[[body]]\nname = \"b\"\nmesh = \"m\"\n"
      "motion = \"dynamic\"\nmass_kg = 1\ndevice = \"hand\"\n[device.hand]\ntype = \"replay\"\nfile = \"device.csv\"\n"
      "max_force_n = 1000\n[effects.virtual_coupling]\n";
  auto replaying = scene::parse_scene(table, "replay.toml", folder.path());
  ASSERT_TRUE(replaying.ok()) << replaying.error().message();
  again.device = replaying.value().device;
  again.base_directory = folder.path();
  auto second = scene::Simulation::make(std::move(again), options);
  ASSERT_TRUE(second.ok()) << second.error().message();
  const scene::RunOutcome repeated = second.value()->run();
  ASSERT_EQ(original.ticks.size(), repeated.ticks.size());
  for (std::size_t i = 0; i < original.ticks.size(); ++i) {
    ASSERT_EQ(std::memcmp(original.ticks[i].force_n.data(), repeated.ticks[i].force_n.data(), 24), 0) << i;
  }
}

}  // namespace
}  // namespace odds::haptics
