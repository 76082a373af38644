// Between a device's frame and the scene's.
#include "odds/haptics/device.hpp"

namespace odds::haptics {
namespace {

// Beyond these a slip of the unit is likelier than a wish, and no product of numbers that a scene takes overflows.
constexpr Range scale_range{1e-6, 1e6};

}  // namespace

DeviceState DeviceScale::in_scene(const DeviceState& state) const noexcept {
  DeviceState result = state;
  if (workspace == 1.0) return result;
  result.position_m = origin_m + workspace * (state.position_m - origin_m);
  result.velocity_m_per_s *= workspace;
  return result;
}

void read_device_scale(SettingsReader& reader, DeviceScale& scale) {
  reader.number("force_scale", scale_range, scale.force);
  reader.number("workspace_scale", scale_range, scale.workspace);
  reader.vector("workspace_origin_m", scale.origin_m);
}

}  // namespace odds::haptics
