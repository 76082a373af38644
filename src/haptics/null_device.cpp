// The device that rests.
#include "odds/haptics/null_device.hpp"

#include "haptics/simulated_spec.hpp"

namespace odds::haptics {

NullDevice::NullDevice(const math::Pose& pose)
    : position_m_(pose.translation),
      orientation_(Quat(pose.rotation).normalized()),
      spec_(simulated_spec("null", pose.translation)) {}

Result<std::unique_ptr<Device>> NullDevice::make(const DeviceRequest& request) {
  SettingsReader reader(*request.settings);
  reader.allow(common_device_keys);
  Vec3 position = Vec3::Zero();
  Quat orientation = Quat::Identity();
  reader.vector("position_m", position);
  reader.quaternion_wxyz("orientation_wxyz", orientation);
  if (auto error = reader.finish()) return *error;
  return std::unique_ptr<Device>(std::make_unique<NullDevice>(math::Pose::from_quaternion(position, orientation)));
}

bool NullDevice::read(std::int64_t now_ns, DeviceState& state) noexcept {
  state = DeviceState{};
  state.t_ns = now_ns;
  state.position_m = position_m_;
  state.orientation = orientation_;
  state.fresh = true;
  return true;
}

}  // namespace odds::haptics
