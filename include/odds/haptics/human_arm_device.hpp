// A mechanism held by a hand that gives way: masses, springs and dampers that react to the force.
#pragma once

#include <memory>

#include "odds/haptics/device.hpp"
#include "odds/haptics/device_registry.hpp"
#include "odds/haptics/scripted_device.hpp"

namespace odds::haptics {

/// SI. The arm pulls the handle towards where its script wants to be; the same in all directions.
struct HumanArm {
  double device_mass_kg = 0.1;             ///< of the handle, > 0; moves with the hand
  double device_damping_ns_per_m = 0.5;    ///< of the mechanism, >= 0: the b of the sampled-data rule
  double arm_mass_kg = 0.2;                ///< that moves with the handle, >= 0
  double arm_stiffness_n_per_m = 300.0;    ///< of the grip, towards the script, >= 0
  double arm_damping_ns_per_m = 3.0;       ///< towards the script's velocity, >= 0
  double inertia_kg_m2 = 2e-4;             ///< of handle and hand together, > 0
  double turn_stiffness_nm_per_rad = 2.0;  ///< >= 0
  double turn_damping_nms_per_rad = 0.02;  ///< >= 0
  double resolution_m = 0.0;  ///< of the position sensor; then velocities are differences of readings. 0: exact
};

/// A hand on a device. Between two reads the last force is held and the equation of motion is integrated in steps of at
/// most 20 microseconds, by the implicit midpoint rule, which adds no energy of its own. A function of the loop's times
/// and the forces alone: the same run gives the same path. When time goes back it begins anew, at rest where its
/// script then is.
class HumanArmDevice final : public Device {
 public:
  HumanArmDevice(std::unique_ptr<ScriptedDevice> script, const HumanArm& arm);
  /// Keys: those of `scripted`, and the fields of HumanArm; physical_damping_ns_per_m is the device's damping.
  [[nodiscard]] static Result<std::unique_ptr<Device>> make(const DeviceRequest& request);

  [[nodiscard]] std::optional<Error> open() override { return std::nullopt; }
  void close() noexcept override { forces_on_ = false; }
  [[nodiscard]] const DeviceSpec& spec() const noexcept override { return spec_; }
  [[nodiscard]] bool read(std::int64_t now_ns, DeviceState& state) noexcept override;
  bool write(const DeviceCommand& command) noexcept override;
  bool enable_forces(bool on) noexcept override;
  [[nodiscard]] std::string_view last_error() const noexcept override { return {}; }

 private:
  void begin(std::int64_t now_ns) noexcept;
  void advance(std::int64_t to_ns) noexcept;
  [[nodiscard]] DeviceState sensed(std::int64_t now_ns) noexcept;

  std::unique_ptr<ScriptedDevice> script_;
  HumanArm arm_;
  DeviceSpec spec_;
  DeviceState handle_;   // as it is
  DeviceState reading_;  // as it was last told
  bool begun_ = false;
  bool forces_on_ = false;
  Vec3 force_n_ = Vec3::Zero();
  Vec3 torque_nm_ = Vec3::Zero();
};

}  // namespace odds::haptics
