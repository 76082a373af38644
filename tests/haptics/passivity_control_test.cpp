// What the controller does for a hand that turns; for one that presses, human_arm_test.cpp tells.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "haptics/device_around.hpp"
#include "haptics/on_floor.hpp"

namespace odds::scene {
namespace {

using UseDevice = std::function<std::unique_ptr<haptics::Device>(std::unique_ptr<haptics::Device>)>;

struct Felt {
  double unrest_nm;  // the largest torque, long after the hand has come to rest
  double least_energy_j;
};

// A hand turns a tool that is too heavy to follow: for the hand it is a wall, which is held too stiffly for its rate.
Felt twist(const std::string& control, const std::string& limits = "", const UseDevice& use_device = {}) {
  Result<Scene> parsed = parse_scene(
      "format = \"odds.scene/1\"\n[loop]\nseconds = 1.5\n"
      "[[mesh]]\nname = \"cube\"\nfile = \"made:box:x=0.04,y=0.04,z=0.04\"\n"
      "[[body]]\nname = \"cube\"\nmesh = \"cube\"\nmotion = \"dynamic\"\nmass_kg = 5\ndevice = \"hand\"\n"
      "[device.hand]\ntype = \"human_arm\"\nmax_torque_nm = 1000\nturn_damping_nms_per_rad = 0\n" +
          limits +
          "[[device.hand.motion]]\nkind = \"hold\"\nduration_s = 0.3\nturn_rad = 0.3\n"
          "[effects.virtual_coupling]\nk_r_nm_per_rad = 8\nb_r_nms_per_rad = 0\n" +
          control,
      "twist.toml", ".");
  EXPECT_TRUE(parsed.ok()) << parsed.error().message();
  SimulationOptions options;
  options.simulated_time = true;
  options.use_device = use_device;
  const RunOutcome outcome = std::move(Simulation::make(std::move(parsed).value(), options)).value()->run();
  double unrest_nm = 0.0;
  for (std::size_t i = 1300; i < 1500; ++i) {
    const auto& torque = outcome.ticks[i].torque_nm;
    unrest_nm = std::max(unrest_nm, Vec3(torque[0], torque[1], torque[2]).norm());
  }
  return {unrest_nm, outcome.least_energy_j};
}

TEST(PassivityControl, QuietsAHandThatOnlyTurns) {
  const Felt without = twist("");
  const Felt with = twist("[effects.passivity_control]\n");
  EXPECT_LT(without.least_energy_j, -1.0) << "it buzzes";
  EXPECT_LT(with.unrest_nm, 0.1 * without.unrest_nm);
  EXPECT_GT(with.least_energy_j, 0.01 * without.least_energy_j);
}

/// A hand that also walks, whatever pulls at it.
class Walking final : public testing::DeviceAround {
 public:
  Walking(std::unique_ptr<haptics::Device> hand, bool actuates_force) : DeviceAround(std::move(hand)) {
    change_spec().actuates_force = actuates_force;
  }
  [[nodiscard]] bool read(std::int64_t now_ns, haptics::DeviceState& state) noexcept override {
    if (!DeviceAround::read(now_ns, state)) return false;
    state.position_m = Vec3(1e-9 * static_cast<double>(now_ns), 0, 0);
    return true;
  }
};

TEST(PassivityControl, CountsOnNoForceThatTheHandIsNotGiven) {
  const std::string control = "[effects.passivity_control]\n";
  const Felt standing = twist(control);
  struct Case {
    const char* limits;
    bool actuates_force;
  };
  for (const Case& c : {Case{"", false}, Case{"max_force_n = 0\n", true}, Case{"max_force_n = 1e-3\n", true}}) {
    const Felt walking = twist(control, c.limits, [&](std::unique_ptr<haptics::Device> hand) {
      return std::make_unique<Walking>(std::move(hand), c.actuates_force);
    });
    EXPECT_LT(walking.unrest_nm, 1.1 * standing.unrest_nm) << c.limits;
    EXPECT_GT(walking.least_energy_j, 1.1 * standing.least_energy_j - 1e-3) << c.limits;
  }
}

// A hand that moves evenly, and of which at times nothing can be read, or nothing new.
class Mute final : public haptics::Device {
 public:
  enum class Word { told, repeated, none };
  using Says = Word (*)(std::int64_t tick);
  Mute(haptics::DeviceSpec spec, Says says) : spec_(std::move(spec)), says_(says) {}
  [[nodiscard]] std::optional<Error> open() override { return std::nullopt; }
  void close() noexcept override {}
  [[nodiscard]] const haptics::DeviceSpec& spec() const noexcept override { return spec_; }
  [[nodiscard]] bool read(std::int64_t now_ns, haptics::DeviceState& state) noexcept override {
    const Word word = says_(now_ns / 1'000'000);
    if (word == Word::none) return false;
    if (word == Word::told) last_.position_m.x() = -1e-10 * static_cast<double>(now_ns);
    state = last_;
    state.fresh = word == Word::told;
    return true;
  }
  bool write(const haptics::DeviceCommand&) noexcept override { return true; }
  bool enable_forces(bool) noexcept override { return true; }
  [[nodiscard]] std::string_view last_error() const noexcept override { return "mute"; }

 private:
  haptics::DeviceSpec spec_;
  Says says_;
  haptics::DeviceState last_;
};

// Its tool falls faster than the hand goes, and draws it along.
std::vector<haptics::TickRecord> drawn(Mute::Says says, const std::string& control) {
  Result<Scene> parsed = parse_scene(
      "format = \"odds.scene/1\"\n[loop]\nseconds = 0.02\n"
      "[[mesh]]\nname = \"cube\"\nfile = \"made:box:x=0.04,y=0.04,z=0.04\"\n"
      "[[body]]\nname = \"cube\"\nmesh = \"cube\"\nmotion = \"dynamic\"\nmass_kg = 1\ndevice = \"hand\"\n"
      "[device.hand]\ntype = \"null\"\nmax_force_n = 1000\nmax_torque_nm = 1000\n"
      "[effects.gravity]\ng_m_per_s2 = [-50, 0, 0]\n[effects.virtual_coupling]\n" +
          control,
      "mute.toml", ".");
  EXPECT_TRUE(parsed.ok()) << parsed.error().message();
  SimulationOptions options;
  options.simulated_time = true;
  options.use_device = [=](std::unique_ptr<haptics::Device> device) {
    return std::make_unique<Mute>(device->spec(), says);
  };
  return std::move(Simulation::make(std::move(parsed).value(), options)).value()->run().ticks;
}

TEST(PassivityControl, DampsNoMotionThatNobodyHasSeen) {
  const Mute::Says until_10 = [](std::int64_t tick) { return tick < 10 ? Mute::Word::told : Mute::Word::none; };
  const auto damped = drawn(until_10, "[effects.passivity_control]\n");
  const auto plain = drawn(until_10, "");
  EXPECT_LT(damped[9].observed_energy_j, 0.0);
  EXPECT_GT(damped[9].force_n[0] - plain[9].force_n[0], 0.1);
  for (std::size_t i = 10; i < 20; ++i) EXPECT_EQ(damped[i].force_n[0], plain[i].force_n[0]) << i;
}

// All the way of a silence, in the first tick after it, is not the way of a period.
TEST(PassivityControl, DampsByTheSpeedOfTheHandAlsoAfterASilence) {
  const Mute::Says silent = [](std::int64_t tick) {
    return tick < 10 || tick > 14 ? Mute::Word::told : Mute::Word::none;
  };
  const Mute::Says slow = [](std::int64_t tick) { return tick % 3 == 0 ? Mute::Word::told : Mute::Word::repeated; };
  for (const Mute::Says says : {silent, slow}) {
    const auto damped = drawn(says, "[effects.passivity_control]\nmax_damping_ns_per_m = 0.01\n");
    const auto plain = drawn(says, "");
    ASSERT_LT(plain[9].observed_energy_j, 0.0);
    const auto damping = [&](std::size_t tick) { return damped[tick].force_n[0] - plain[tick].force_n[0]; };
    EXPECT_NEAR(damping(9), 0.001, 1e-9) << "the most, at 0.1 m/s";
    EXPECT_NEAR(damping(15), 0.001, 1e-9);
  }
}

}  // namespace
}  // namespace odds::scene
