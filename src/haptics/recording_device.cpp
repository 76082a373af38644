// Remembering what a device said.
#include "odds/haptics/recording_device.hpp"

namespace odds::haptics {

RecordingDevice::RecordingDevice(std::unique_ptr<Device> inner, std::size_t capacity)
    : inner_(std::move(inner)), states_(capacity) {}

bool RecordingDevice::read(std::int64_t now_ns, DeviceState& state) noexcept {
  if (!inner_->read(now_ns, state)) return false;
  const bool later = used_ == 0 || state.t_ns > states_[used_ - 1].t_ns;
  DeviceState usable = state;  // what is recorded can be replayed
  if (!state.fresh || !later || !make_usable(usable)) return true;
  if (used_ < states_.size()) {
    states_[used_++] = usable;
  } else {
    ++lost_;
  }
  return true;
}

DeviceTrack RecordingDevice::track() const {
  return {{states_.begin(), states_.begin() + static_cast<std::ptrdiff_t>(used_)}};
}

}  // namespace odds::haptics
