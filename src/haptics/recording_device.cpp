// Remembering what a device said.
#include "odds/haptics/recording_device.hpp"

namespace odds::haptics {

RecordingDevice::RecordingDevice(std::unique_ptr<Device> inner, std::size_t capacity)
    : inner_(std::move(inner)), states_(capacity) {}

bool RecordingDevice::read(std::int64_t now_ns, DeviceState& state) noexcept {
  const bool told = inner_->read(now_ns, state);
  if (told) state = sensed(inner_->spec(), state, start_ ? *start_ : state);
  DeviceState usable = state;  // what is recorded can be replayed
  if (told && make_usable(usable)) {
    if (!start_) start_ = usable;
    note(now_ns, usable, state.fresh);
  } else if (written_ > 0) {
    note(now_ns, states_[written_ - 1], false);
  }
  return told;
}

void RecordingDevice::note(std::int64_t now_ns, const DeviceState& state, bool fresh) noexcept {
  const bool again = written_ > 0 && now_ns <= states_[written_ - 1].t_ns;
  if (again && now_ns < states_[written_ - 1].t_ns) return;
  if (!again && written_ == states_.size()) {
    lost_ += fresh ? 1 : 0;
    return;
  }
  if (!again) ++written_;
  DeviceState& noted = states_[written_ - 1];
  noted = state;
  noted.t_ns = now_ns;
  noted.fresh = fresh;
}

DeviceTrack RecordingDevice::track() const {
  return {{states_.begin(), states_.begin() + static_cast<std::ptrdiff_t>(written_)}};
}

}  // namespace odds::haptics
