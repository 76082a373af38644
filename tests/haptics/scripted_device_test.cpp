// The scripted device: pieces join without a jump, and its keys are read strictly.
#include "odds/haptics/scripted_device.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "haptics/settings_from.hpp"

namespace odds::haptics {
namespace {

using test::setting;

std::vector<Motion> tour() {
  std::vector<Motion> motions(6);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    motions[i].kind = static_cast<MotionKind>(i);
    motions[i].duration_s = 0.9;
    motions[i].depth_m = 0.01;
    motions[i].rise_s = 0.2;
    motions[i].by_m = Vec3(0.01, 0.02, -0.03);
    motions[i].amplitude_m = 0.01;
    motions[i].frequency_hz = 3.0;
    motions[i].radius_m = 0.02;
    motions[i].turn_axis = Vec3::UnitX();
    motions[i].turn_rad = 0.3;
  }
  return motions;
}

DeviceState state_at(Device& device, double time_s) {
  DeviceState state;
  EXPECT_TRUE(device.read(std::llround(time_s * 1e9), state));
  return state;
}

TEST(ScriptedDevice, MovesWithoutJumpsThroughAllKindsOfMotion) {
  ScriptedDevice device(math::Pose{Mat3::Identity(), Vec3(1, 2, 3)}, tour(), false);
  EXPECT_EQ(state_at(device, 0.0).position_m, Vec3(1, 2, 3));
  DeviceState last = state_at(device, 0.0);
  for (int tick = 1; tick < 6000; ++tick) {
    const DeviceState now = state_at(device, 0.001 * tick);
    EXPECT_LT((now.position_m - last.position_m).norm(), 1e-3) << tick;  // at most 1 m/s
    EXPECT_LT((now.velocity_m_per_s - last.velocity_m_per_s).norm(), 0.02) << tick;
    EXPECT_LT(now.orientation.angularDistance(last.orientation), 2e-3) << tick;
    EXPECT_NEAR(now.orientation.norm(), 1.0, 1e-12);
    last = now;
  }
  EXPECT_LT((last.position_m - Vec3(1.01, 2.02, 2.97)).norm(), 1e-12);
  EXPECT_NEAR(last.orientation.angularDistance(Quat::Identity()), 6 * 0.3, 1e-12);
}

TEST(ScriptedDevice, AngularVelocityIsTheDerivativeOfTheOrientation) {
  ScriptedDevice device(math::Pose{}, tour(), false);
  const double h = 1e-5;
  for (double t = 0.05; t < 5.0; t += 0.0917) {
    const Quat turn = state_at(device, t + h).orientation * state_at(device, t - h).orientation.conjugate();
    const Vec3 omega = 2.0 * turn.vec() / (2 * h);
    EXPECT_LT((omega - state_at(device, t).angular_velocity_rad_per_s).norm(), 1e-5) << t;
  }
}

TEST(ScriptedDevice, RepeatsAClosedPath) {
  std::vector<Motion> motions(1);
  motions[0].kind = MotionKind::tap;
  motions[0].duration_s = 0.5;
  motions[0].depth_m = 0.01;
  ScriptedDevice device(math::Pose{}, motions, true);
  EXPECT_LT((state_at(device, 0.2).position_m - state_at(device, 7.7).position_m).norm(), 1e-12);
  EXPECT_GT(state_at(device, 7.7).position_m.norm(), 1e-3);
}

Result<std::unique_ptr<Device>> make(std::vector<Setting> motion, std::vector<Setting> more = {}) {
  more.push_back(setting("type", std::string("scripted")));
  const Settings inner{"scene.toml", "[[device.hand.motion]]", {5, 1}, std::move(motion)};
  more.push_back(setting("motion", Value::List{Value{inner, {5, 1}}}, 5));
  const Settings settings = test::table(std::move(more));
  return make_device("scripted", {&settings, "."});
}

TEST(ScriptedDevice, ReadsItsKeys) {
  auto device = make(
      {setting("kind", std::string("slide"), 6), setting("duration_s", 2.0, 7), test::vector("by_m", 0, 0, 0.1, 8)},
      {test::vector("position_m", 1, 0, 0, 2)});
  ASSERT_TRUE(device.ok()) << device.error().message();
  EXPECT_LT((state_at(*device.value(), 2.0).position_m - Vec3(1, 0, 0.1)).norm(), 1e-15);
}

TEST(ScriptedDevice, RefusesBadKeysWithTheirPlace) {
  const auto text = [](std::string value) { return value; };
  struct Case {
    std::vector<Setting> motion;
    const char* place;
    const char* says;
  };
  const std::vector<Case> cases = {
      {{setting("kind", text("slid"), 6), setting("duration_s", 1.0, 7)}, "6:10", "slide"},
      {{setting("kind", text("tap"), 6), setting("duration_s", 1.0, 7), setting("depth_m", 0.1, 8),
        setting("taps", std::int64_t{0}, 9)},
       "9:10",
       "out of range"},
      {{setting("kind", text("press"), 6), setting("duration_s", 1.0, 7), setting("depth_m", 0.1, 8),
        setting("rise_s", 0.6, 9)},
       "9:10",
       "out of range"},
      {{setting("kind", text("press"), 6), setting("duration_s", -1.0, 7), setting("depth_m", 0.1, 8)},
       "7:10",
       "out of range"},
      {{setting("kind", text("press"), 6), setting("duration_s", 1.0, 7), setting("by_m", 0.1, 8)}, "5:1", "depth_m"},
      {{setting("kind", text("hold"), 6), setting("duration_s", 1.0, 7), setting("depth_m", 0.1, 8)},
       "8:1",
       "unknown key"},
      {{setting("kind", text("sine"), 6), setting("duration_s", 1.0, 7), setting("amplitude_m", 0.1, 8),
        setting("frequency_hz", 1.0, 9)},
       "9:10",
       "at least 2"},
      {{setting("kind", text("spiral"), 6), setting("duration_s", 1.0, 7), setting("radius_m", 0.1, 8),
        test::vector("normal", 0, 0, 0, 9)},
       "9:1",
       "no direction"},
      {{setting("kind", text("spiral"), 6), setting("duration_s", 1.0, 7), setting("radius_m", std::nan(""), 8)},
       "8:10",
       "finite"},
  };
  for (const Case& c : cases) {
    const auto device = make(c.motion);
    ASSERT_FALSE(device.ok()) << c.says;
    EXPECT_EQ(device.error().place, c.place) << device.error().message();
    EXPECT_NE(device.error().message().find(c.says), std::string::npos) << device.error().message();
  }
}

TEST(ScriptedDevice, RefusesToRepeatAnOpenPath) {
  const auto device = make(
      {setting("kind", std::string("slide"), 6), setting("duration_s", 2.0, 7), test::vector("by_m", 0, 0, 0.1, 8)},
      {setting("repeat", true, 3)});
  ASSERT_FALSE(device.ok());
  EXPECT_EQ(device.error().place, "3:1");
}

TEST(DeviceRegistry, RefusesAnUnknownTypeWithTheNearestName) {
  const Settings settings = test::table({setting("type", std::string("scriptd"), 4)});
  const auto device = make_device("scriptd", {&settings, "."});
  ASSERT_FALSE(device.ok());
  EXPECT_EQ(device.error().place, "4:10");
  EXPECT_NE(device.error().remedy.find("'scripted'"), std::string::npos) << device.error().remedy;
}

TEST(DeviceRegistry, OffersADeviceThatAProgramAdded) {
  register_device("rail", [](const DeviceRequest&) {
    return Result<std::unique_ptr<Device>>(
        std::make_unique<ScriptedDevice>(math::Pose{}, std::vector<Motion>{}, false));
  });
  const Settings settings = test::table({});
  EXPECT_TRUE(make_device("rail", {&settings, "."}).ok());
  const auto names = device_names();
  EXPECT_NE(std::find(names.begin(), names.end(), "rail"), names.end());
}

}  // namespace
}  // namespace odds::haptics
