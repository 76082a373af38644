// The interface of a haptic device: what a hand holds, or what stands in for it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "odds/haptics/settings.hpp"
#include "odds/math/error.hpp"
#include "odds/math/types.hpp"

namespace odds::haptics {

/// What a device can do, in its own frame and SI units. A force or torque of 0 means "cannot", infinity "no limit
/// known"; a stiffness, damping or radius of 0 means "not known".
struct DeviceSpec {
  std::string name;   ///< name of the type, as in the registry
  std::string maker;  ///< who makes it; "odds" for the ones without hardware
  double max_force_n = 0.0;
  double max_torque_nm = 0.0;
  double max_stiffness_n_per_m = 0.0;             ///< largest closed-loop stiffness at 1 kHz
  double max_angular_stiffness_nm_per_rad = 0.0;  ///< the same for turning
  double physical_damping_ns_per_m = 0.0;         ///< of the mechanism itself: what the sampled-data rule asks about
  double workspace_radius_m = 0.0;         ///< how far the handle goes from the centre; who leaves it is warned of
  Vec3 workspace_center_m = Vec3::Zero();  ///< devices without hardware: where they begin
  bool senses_position = true;             ///< false: the handle stays where it was at the start, whatever read() says
  bool senses_orientation = true;          ///< false: it keeps the orientation that it had at the start
  bool actuates_force = false;             ///< false: write() is given no force
  bool actuates_torque = false;            ///< false: write() is given no torque
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

/// Whether a state can be used: no number is beyond 1e12, and its quaternion has length 1 to within 1e-3. That is then
/// made a unit quaternion; one of length 1 to within 1e-12 keeps its bits. What cannot be used is left alone.
[[nodiscard]] bool make_usable(DeviceState& state) noexcept;

/// What a device senses of what it says; the rest stays as it is in `last`, at rest.
[[nodiscard]] DeviceState sensed(const DeviceSpec& spec, const DeviceState& said, const DeviceState& last) noexcept;

/// How a device stands to the scene, as in CHAI3D: a small device explores a large scene, or a strong one a weak scene.
/// A stiffness k of the scene is k * force * workspace at the device (stiffness()), a damping likewise. Angles are not
/// scaled, so an angular stiffness is multiplied by `force` alone.
struct DeviceScale {
  double force = 1.0;            ///< the device's force and torque are this multiple of the scene's; > 0
  double workspace = 1.0;        ///< a way of the device, and its linear velocity, is this multiple in the scene; > 0
  Vec3 origin_m = Vec3::Zero();  ///< the point that is the same in both: the centre of the device's workspace

  [[nodiscard]] double stiffness() const noexcept { return force * workspace; }
  /// A state of the device, in the scene. A scale of 1 keeps every bit.
  [[nodiscard]] DeviceState in_scene(const DeviceState& state) const noexcept;
};

/// Reads force_scale, workspace_scale and workspace_origin_m from a device's table; keys left out keep what is there.
void read_device_scale(SettingsReader& reader, DeviceScale& scale);

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
  /// Returns false, and leaves `state` alone, if there is none (last_error() says why). A state that make_usable()
  /// refuses counts as none.
  [[nodiscard]] virtual bool read(std::int64_t now_ns, DeviceState& state) noexcept = 0;
  /// Hands over force and torque. Returns false if the device did not take them: then the last ones that it took are
  /// counted as those on the hand.
  virtual bool write(const DeviceCommand& command) noexcept = 0;
  /// Forces are off after open.
  virtual bool enable_forces(bool on) noexcept = 0;
  /// Why the last read, write or enable_forces failed; "" if it did not. Valid until the next call.
  [[nodiscard]] virtual std::string_view last_error() const noexcept = 0;
};

}  // namespace odds::haptics
