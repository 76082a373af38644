// The coupling's force on the hand, and the rule that warns of stiff couplings.
#include "odds/haptics/virtual_coupling.hpp"

#include <gtest/gtest.h>

namespace odds::haptics {
namespace {

DeviceSpec device_with(double damping, double max_stiffness = 3000.0) {
  DeviceSpec spec;
  spec.name = "arm";
  spec.physical_damping_ns_per_m = damping;
  spec.max_stiffness_n_per_m = max_stiffness;
  return spec;
}

TEST(VirtualCoupling, TheHandFeelsTheOppositeForceAndTheMomentOfItsArm) {
  const ode::Wrench on_body{Vec3(0, 0, 2), Vec3(0.1, 0, 0)};
  const ode::Wrench on_hand = reaction_on_hand(on_body, Vec3(0.5, 0, 0), Vec3(0.2, 0, 0));
  EXPECT_LT((on_hand.force_n - Vec3(0, 0, -2)).norm(), 1e-15);
  EXPECT_LT((on_hand.torque_nm - Vec3(-0.1, 0.6, 0)).norm(), 1e-15);  // -(t + r x F), r = 0.3 x, F = 2 z
}

TEST(VirtualCoupling, WarnsExactlyWhereTheSampledDataRuleIsBroken) {
  VirtualCoupling coupling;
  coupling.k_t_n_per_m = 2000.0;
  coupling.b_t_ns_per_m = 1.5;
  EXPECT_DOUBLE_EQ(least_device_damping(coupling, 0.001), 2.5);
  EXPECT_FALSE(passivity_warning(coupling, device_with(2.5), 0.001).has_value());
  const auto warning = passivity_warning(coupling, device_with(2.49), 0.001);
  ASSERT_TRUE(warning.has_value());
  EXPECT_NE(warning->find("2.5 N s/m"), std::string::npos) << *warning;
  EXPECT_NE(warning->find("has 2.49"), std::string::npos) << *warning;
  EXPECT_TRUE(passivity_warning(coupling, device_with(2.5), 0.002).has_value())
      << "a longer period asks for more damping";
  const auto unknown = passivity_warning(coupling, device_with(0.0), 0.001);
  ASSERT_TRUE(unknown.has_value());
  EXPECT_NE(unknown->find("does not state its own"), std::string::npos) << *unknown;
}

TEST(VirtualCoupling, WarnsOfAStiffnessThatTheDeviceCannotRender) {
  VirtualCoupling coupling;
  coupling.k_t_n_per_m = 2000.0;
  coupling.b_t_ns_per_m = 0.0;
  const auto warning = passivity_warning(coupling, device_with(100.0, 1500.0), 0.001);
  ASSERT_TRUE(warning.has_value());
  EXPECT_NE(warning->find("1500 N/m"), std::string::npos) << *warning;
}

TEST(VirtualCoupling, WarnsOfWhatTheDeviceFeelsOfAScaledScene) {
  VirtualCoupling coupling;
  coupling.k_t_n_per_m = 500.0;
  coupling.b_t_ns_per_m = 1.0;
  const DeviceScale scale{.force = 0.5, .workspace = 8.0};
  EXPECT_DOUBLE_EQ(least_device_damping(coupling, 0.001, scale), 4.0 * 1.25);
  EXPECT_FALSE(passivity_warning(coupling, device_with(5.0), 0.001, scale).has_value());
  const auto warning = passivity_warning(coupling, device_with(4.9), 0.001, scale);
  ASSERT_TRUE(warning.has_value());
  EXPECT_NE(warning->find("at least 5 N s/m"), std::string::npos) << *warning;
  const auto stiff = passivity_warning(coupling, device_with(5.0, 1999.0), 0.001, scale);
  ASSERT_TRUE(stiff.has_value());
  EXPECT_NE(stiff->find("2000 N/m at the device"), std::string::npos) << *stiff;
  EXPECT_FALSE(passivity_warning(coupling, device_with(5.0, 2000.0), 0.001, scale).has_value());
}

TEST(VirtualCoupling, WarnsOfATorqueThatTheDeviceCannotRender) {
  VirtualCoupling coupling;
  coupling.k_r_nm_per_rad = 4.0;
  DeviceSpec device = device_with(5.0);
  ASSERT_TRUE(torque_warning(coupling, device).has_value()) << "a device without motors that turn";
  device.actuates_torque = true;
  EXPECT_FALSE(torque_warning(coupling, device).has_value()) << "its greatest stiffness is not known";
  device.max_angular_stiffness_nm_per_rad = 4.0;
  EXPECT_FALSE(torque_warning(coupling, device, {.workspace = 10.0}).has_value()) << "angles are not scaled";
  const auto warning = torque_warning(coupling, device, {.force = 2.0});
  ASSERT_TRUE(warning.has_value());
  EXPECT_NE(warning->find("8 N m/rad at the device"), std::string::npos) << *warning;
}

TEST(VirtualCoupling, PullsTowardsTheDeviceWithItsVelocities) {
  VirtualCoupling coupling;
  coupling.max_force_n = 4.0;
  DeviceState state;
  state.position_m = Vec3(1, 2, 3);
  state.orientation = Quat(0, 1, 0, 0);
  state.velocity_m_per_s = Vec3(0.1, 0, 0);
  state.angular_velocity_rad_per_s = Vec3(0, 0.2, 0);
  const ode::Coupling pull = coupling.towards(state);
  EXPECT_EQ(pull.target.translation, state.position_m);
  EXPECT_LT((pull.target.rotation - Mat3(Vec3(1, -1, -1).asDiagonal())).norm(), 1e-15);
  EXPECT_EQ(pull.target_velocity_m_per_s, state.velocity_m_per_s);
  EXPECT_EQ(pull.target_angular_velocity_rad_per_s, state.angular_velocity_rad_per_s);
  EXPECT_EQ(pull.stiffness_n_per_m, coupling.k_t_n_per_m);
  EXPECT_EQ(pull.max_spring_force_n, 4.0);
}

}  // namespace
}  // namespace odds::haptics
