// Parameters of the coupling, the force on the hand, and the sampled-data rule.
#include "odds/haptics/virtual_coupling.hpp"

#include <fmt/core.h>

#include <cmath>

namespace odds::haptics {

ode::Coupling VirtualCoupling::towards(const DeviceState& device) const noexcept {
  ode::Coupling coupling;
  coupling.target = {device.orientation.toRotationMatrix(), device.position_m};
  coupling.target_velocity_m_per_s = device.velocity_m_per_s;
  coupling.target_angular_velocity_rad_per_s = device.angular_velocity_rad_per_s;
  coupling.stiffness_n_per_m = k_t_n_per_m;
  coupling.damping_ns_per_m = b_t_ns_per_m;
  coupling.angular_stiffness_nm_per_rad = k_r_nm_per_rad;
  coupling.angular_damping_nms_per_rad = b_r_nms_per_rad;
  coupling.max_spring_force_n = max_force_n;
  coupling.max_spring_torque_nm = max_torque_nm;
  return coupling;
}

ode::Wrench reaction_on_hand(const ode::Wrench& on_body, const Vec3& center_of_mass_m, const Vec3& handle_m) noexcept {
  const Vec3 arm = center_of_mass_m - handle_m;
  return {-on_body.force_n, -(on_body.torque_nm + arm.cross(on_body.force_n))};
}

double least_device_damping(const VirtualCoupling& coupling, double period_s, const DeviceScale& scale) noexcept {
  return scale.stiffness() * (0.5 * coupling.k_t_n_per_m * period_s + std::abs(coupling.b_t_ns_per_m));
}

std::optional<std::string> passivity_warning(const VirtualCoupling& coupling, const DeviceSpec& device, double period_s,
                                             const DeviceScale& scale) {
  const double felt_n_per_m = scale.stiffness() * coupling.k_t_n_per_m;
  if (device.max_stiffness_n_per_m > 0.0 && felt_n_per_m > device.max_stiffness_n_per_m) {
    return fmt::format(
        "the virtual coupling's k_t of {:.4g} N/m{} exceeds the {:.4g} N/m that the device '{}' can render",
        felt_n_per_m, felt_n_per_m != coupling.k_t_n_per_m ? " at the device" : "", device.max_stiffness_n_per_m,
        device.name);
  }
  const double needed = least_device_damping(coupling, period_s, scale);
  if (device.physical_damping_ns_per_m >= needed) return std::nullopt;
  const std::string has = device.physical_damping_ns_per_m > 0.0
                              ? fmt::format("has {:.4g} N s/m", device.physical_damping_ns_per_m)
                              : std::string("does not state its own");
  return fmt::format(
      "the virtual coupling is passive only on a device with a physical damping of at least {:.4g} N s/m (K T/2 + "
      "|B|); the "
      "device '{}' {}",
      needed, device.name, has);
}

std::optional<std::string> torque_warning(const VirtualCoupling& coupling, const DeviceSpec& device,
                                          const DeviceScale& scale) {
  if (!device.actuates_torque) {
    return fmt::format("the device '{}' exerts no torque: the hand feels only the virtual coupling's force",
                       device.name);
  }
  const double felt_nm_per_rad = scale.force * coupling.k_r_nm_per_rad;
  if (!(device.max_angular_stiffness_nm_per_rad > 0.0) || felt_nm_per_rad <= device.max_angular_stiffness_nm_per_rad) {
    return std::nullopt;
  }
  return fmt::format(
      "the virtual coupling's k_r of {:.4g} N m/rad{} exceeds the {:.4g} N m/rad that the device '{}' can render",
      felt_nm_per_rad, felt_nm_per_rad != coupling.k_r_nm_per_rad ? " at the device" : "",
      device.max_angular_stiffness_nm_per_rad, device.name);
}

}  // namespace odds::haptics
