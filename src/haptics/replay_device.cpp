// Playing back a recorded track.
#include "odds/haptics/replay_device.hpp"

#include <algorithm>

#include "haptics/simulated_spec.hpp"

namespace odds::haptics {

ReplayDevice::ReplayDevice(DeviceTrack track)
    : track_(std::move(track)), spec_(simulated_spec("replay", track_.states.front().position_m)) {}

Result<std::unique_ptr<Device>> ReplayDevice::make(const DeviceRequest& request) {
  SettingsReader reader(*request.settings);
  reader.allow(common_device_keys);
  std::string file;
  reader.require("file");
  reader.text("file", file);
  if (auto error = reader.finish()) return *error;
  Result<DeviceTrack> track = read_track(request.base_directory / file);
  if (!track) return track.error();
  return std::unique_ptr<Device>(std::make_unique<ReplayDevice>(std::move(track).value()));
}

bool ReplayDevice::read(std::int64_t now_ns, DeviceState& state) noexcept {
  const std::vector<DeviceState>& rows = track_.states;
  if (rows[row_].t_ns > now_ns) row_ = 0;  // time went back: a new run
  const auto next = std::upper_bound(rows.begin() + static_cast<std::ptrdiff_t>(row_), rows.end(), now_ns,
                                     [](std::int64_t time, const DeviceState& row) { return time < row.t_ns; });
  row_ = next == rows.begin() ? 0 : static_cast<std::size_t>(next - rows.begin()) - 1;
  const DeviceState& a = rows[row_];
  state = a;
  state.t_ns = now_ns;
  if (next == rows.end() && now_ns > a.t_ns) {
    state.velocity_m_per_s.setZero();
    state.angular_velocity_rad_per_s.setZero();
    state.fresh = false;
  } else if (next != rows.end() && now_ns > a.t_ns) {
    const DeviceState& b = *next;
    state.fresh = b.fresh;
    const double share = static_cast<double>(now_ns - a.t_ns) / static_cast<double>(b.t_ns - a.t_ns);
    state.position_m += share * (b.position_m - a.position_m);
    state.orientation = a.orientation.slerp(share, b.orientation);
    if (track_.gives_velocities) {
      state.velocity_m_per_s += share * (b.velocity_m_per_s - a.velocity_m_per_s);
      state.angular_velocity_rad_per_s += share * (b.angular_velocity_rad_per_s - a.angular_velocity_rad_per_s);
    } else {
      const Velocities on_the_way = velocities_between(a, b);  // those of the pose: a hand that rests has none
      state.velocity_m_per_s = on_the_way.linear_m_per_s;
      state.angular_velocity_rad_per_s = on_the_way.angular_rad_per_s;
    }
  }
  return true;
}

}  // namespace odds::haptics
