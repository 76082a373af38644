// What the controller does for a hand that turns; for one that presses, human_arm_test.cpp tells.
#include <gtest/gtest.h>

#include <algorithm>

#include "haptics/on_floor.hpp"

namespace odds::scene {
namespace {

struct Felt {
  double unrest_nm;  // the largest torque, long after the hand has come to rest
  double least_energy_j;
};

// A hand turns a tool that is too heavy to follow: for the hand it is a wall, which is held too stiffly for its rate.
Felt twist(const std::string& control) {
  Result<Scene> parsed = parse_scene(
      "format = \"odds.scene/1\"\n[loop]\nseconds = 1.5\n"
      "[[mesh]]\nname = \"cube\"\nfile = \"made:box:x=0.04,y=0.04,z=0.04\"\n"
      "[[body]]\nname = \"cube\"\nmesh = \"cube\"\nmotion = \"dynamic\"\nmass_kg = 5\ndevice = \"hand\"\n"
      "[device.hand]\ntype = \"human_arm\"\nmax_torque_nm = 1000\nturn_damping_nms_per_rad = 0\n"
      "[[device.hand.motion]]\nkind = \"hold\"\nduration_s = 0.3\nturn_rad = 0.3\n"
      "[effects.virtual_coupling]\nk_r_nm_per_rad = 8\nb_r_nms_per_rad = 0\n" +
          control,
      "twist.toml", ".");
  EXPECT_TRUE(parsed.ok()) << parsed.error().message();
  SimulationOptions options;
  options.simulated_time = true;
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

// A hand that moves evenly, until nothing can be read of it.
class Mute final : public haptics::Device {
 public:
  explicit Mute(haptics::DeviceSpec spec) : spec_(std::move(spec)) {}
  [[nodiscard]] std::optional<Error> open() override { return std::nullopt; }
  void close() noexcept override {}
  [[nodiscard]] const haptics::DeviceSpec& spec() const noexcept override { return spec_; }
  [[nodiscard]] bool read(std::int64_t now_ns, haptics::DeviceState& state) noexcept override {
    if (now_ns >= 10'000'000) return false;
    state = {};
    state.position_m.x() = -1e-10 * static_cast<double>(now_ns);
    state.fresh = true;
    return true;
  }
  bool write(const haptics::DeviceCommand&) noexcept override { return true; }
  bool enable_forces(bool) noexcept override { return true; }
  [[nodiscard]] std::string_view last_error() const noexcept override { return "mute"; }

 private:
  haptics::DeviceSpec spec_;
};

TEST(PassivityControl, DampsNoMotionThatNobodyHasSeen) {
  const auto forces = [](const std::string& control) {
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
    options.use_device = [](std::unique_ptr<haptics::Device> device) { return std::make_unique<Mute>(device->spec()); };
    return std::move(Simulation::make(std::move(parsed).value(), options)).value()->run().ticks;
  };
  const auto damped = forces("[effects.passivity_control]\n");
  const auto plain = forces("");
  EXPECT_LT(damped[9].observed_energy_j, 0.0) << "the tool falls faster than the hand goes, and draws it along";
  EXPECT_GT(damped[9].force_n[0] - plain[9].force_n[0], 0.1);
  for (std::size_t i = 10; i < 20; ++i) EXPECT_EQ(damped[i].force_n[0], plain[i].force_n[0]) << i;
}

}  // namespace
}  // namespace odds::scene
