// The spring and damper between what the hand holds and the body that stands for it in the world.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "odds/haptics/device.hpp"
#include "odds/ode/world.hpp"

namespace odds::haptics {

/// Parameters of the coupling (Colgate, Stanley and Brown, IROS 1995). SI.
struct VirtualCoupling {
  double k_t_n_per_m = 500.0;
  double b_t_ns_per_m = 2.0;
  double k_r_nm_per_rad = 1.0;
  double b_r_nms_per_rad = 0.005;
  double max_force_n = std::numeric_limits<double>::infinity();  ///< of the spring, without the damper
  double max_torque_nm = std::numeric_limits<double>::infinity();

  /// The pull towards a device state, as the world takes it.
  [[nodiscard]] ode::Coupling towards(const DeviceState& device) const noexcept;
};

/// Force and torque on the hand at the handle's origin, from what the coupling exerted on the body's centre of mass.
[[nodiscard]] ode::Wrench reaction_on_hand(const ode::Wrench& on_body, const Vec3& center_of_mass_m,
                                           const Vec3& handle_m) noexcept;

/// The rule for sampled virtual walls: a device is passive against stiffness K and damping B at period T only if its
/// own physical damping b >= K T / 2 + |B| (Colgate and Schenkel, J. Robotic Systems 14, 1997). The coupling stands in
/// the scene; K and B are what the device feels of it, DeviceScale::stiffness() times as much. Returns a sentence if
/// the coupling breaks the rule on this device, or exceeds the device's greatest stiffness; a warning, not a proof of
/// either.
[[nodiscard]] std::optional<std::string> passivity_warning(const VirtualCoupling& coupling, const DeviceSpec& device,
                                                           double period_s, const DeviceScale& scale = {});

/// A sentence if the coupling's angular stiffness, as the device feels it, exceeds the device's greatest, or if the
/// device exerts no torque at all.
[[nodiscard]] std::optional<std::string> torque_warning(const VirtualCoupling& coupling, const DeviceSpec& device,
                                                        const DeviceScale& scale = {});

/// The least physical damping of the device that the rule asks for, N s/m.
[[nodiscard]] double least_device_damping(const VirtualCoupling& coupling, double period_s,
                                          const DeviceScale& scale = {}) noexcept;

}  // namespace odds::haptics
