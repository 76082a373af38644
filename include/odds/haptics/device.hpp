// The interface of a haptic device: what a hand holds, or what stands in for it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "odds/math/error.hpp"
#include "odds/math/types.hpp"

namespace odds::haptics {

/// What a device can do. SI units; a limit of 0 means "cannot", infinity "no limit known".
struct DeviceSpec {
  std::string name;   ///< name of the type, as in the registry
  std::string maker;  ///< who makes it; "odds" for the ones without hardware
  double max_force_n = 0.0;
  double max_torque_nm = 0.0;
  double max_stiffness_n_per_m = 0.0;  ///< largest closed-loop stiffness at 1 kHz
  double max_angular_stiffness_nm_per_rad = 0.0;
  double physical_damping_ns_per_m = 0.0;  ///< of the mechanism itself: what the sampled-data rule asks about
  double workspace_radius_m = 0.0;
  bool senses_position = true;
  bool senses_orientation = true;
  bool actuates_force = false;
  bool actuates_torque = false;
};

/// Pose and motion of the handle, world frame, SI.
struct DeviceState {
  std::int64_t t_ns = 0;  ///< when it was measured, in the time given to read()
  Vec3 position_m = Vec3::Zero();
  Quat orientation = Quat::Identity();  ///< handle frame in the world frame
  Vec3 velocity_m_per_s = Vec3::Zero();
  Vec3 angular_velocity_rad_per_s = Vec3::Zero();
  std::uint32_t buttons = 0;  ///< bit i: button i is pressed
  bool fresh = false;         ///< false: nothing new since the last read; the rest repeats the last state
};

/// What the device shall exert on the hand, world frame, SI.
struct DeviceCommand {
  std::int64_t t_ns = 0;
  Vec3 force_n = Vec3::Zero();
  Vec3 torque_nm = Vec3::Zero();
  std::uint32_t flags = 0;  ///< SafetyFlag bits (tick_record.hpp)
};

/// A device. open and close may take their time and allocate; read, write and enable_forces are called inside the loop
/// and must not allocate, lock or wait. One thread at a time.
class Device {
 public:
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  virtual ~Device() = default;

  /// Makes the device ready; says why not, if it cannot. Opening an open device does nothing.
  [[nodiscard]] virtual std::optional<Error> open() = 0;
  virtual void close() noexcept = 0;
  /// What the device can do; valid also while closed.
  [[nodiscard]] virtual const DeviceSpec& spec() const noexcept = 0;
  /// The latest state. `now_ns` is the loop's time since its start: a device without hardware is a function of it, so
  /// that its path does not depend on how punctual the loop was; a real one only translates its own stamps to it.
  /// Returns false, and leaves `state` alone, if there is none (last_error() says why).
  [[nodiscard]] virtual bool read(std::int64_t now_ns, DeviceState& state) noexcept = 0;
  /// Hands over force and torque. Returns false if the device did not take them.
  virtual bool write(const DeviceCommand& command) noexcept = 0;
  /// Forces are off after open.
  virtual bool enable_forces(bool on) noexcept = 0;
  /// Why the last read, write or enable_forces failed; "" if it did not. Valid until the next call.
  [[nodiscard]] virtual std::string_view last_error() const noexcept = 0;
};

}  // namespace odds::haptics
