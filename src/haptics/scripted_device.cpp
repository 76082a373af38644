// The scripted device and the keys that describe its motions.
#include "odds/haptics/scripted_device.hpp"

#include <fmt/core.h>

#include <cmath>

#include "haptics/simulated_spec.hpp"

namespace odds::haptics {
namespace {

// Beyond this the hand would jump at every repetition.
constexpr double closed_within_m = 1e-9;
constexpr double closed_within_rad = 1e-9;

void read_kind(SettingsReader& reader, Motion& m) {
  const auto needs = [&](std::string_view key) { reader.require(key); };
  switch (m.kind) {
    case MotionKind::hold:
      break;
    case MotionKind::press:
      needs("depth_m");
      reader.direction("direction", m.direction);
      reader.number("depth_m", Range::any(), m.depth_m);
      m.rise_s = m.duration_s / 4.0;
      reader.number("rise_s", {0.0, m.duration_s / 2.0, true}, m.rise_s);
      break;
    case MotionKind::slide:
      needs("by_m");
      reader.vector("by_m", m.by_m);
      break;
    case MotionKind::tap: {
      needs("depth_m");
      std::int64_t taps = 1;
      reader.direction("direction", m.direction);
      reader.number("depth_m", Range::any(), m.depth_m);
      reader.integer("taps", 1, 1'000'000, taps);
      m.taps = static_cast<double>(taps);
      break;
    }
    case MotionKind::sine:
      needs("amplitude_m");
      needs("frequency_hz");
      reader.direction("direction", m.direction);
      reader.number("amplitude_m", Range::any(), m.amplitude_m);
      reader.number("frequency_hz", {2.0 / m.duration_s, std::numeric_limits<double>::infinity(), false},
                    m.frequency_hz);
      break;
    case MotionKind::spiral:
      needs("radius_m");
      reader.direction("normal", m.normal);
      reader.number("radius_m", Range::not_negative(), m.radius_m);
      reader.number("turns", Range::any(), m.turns);
      break;
  }
}

Result<Motion> read_motion(const Settings& settings) {
  SettingsReader reader(settings);
  Motion motion;
  std::size_t kind = 0;
  reader.require("kind");
  reader.require("duration_s");
  const bool known = reader.choice("kind", motion_names, kind);
  motion.kind = static_cast<MotionKind>(kind);
  reader.number("duration_s", Range::positive(), motion.duration_s);
  if (known) read_kind(reader, motion);
  reader.direction("turn_axis", motion.turn_axis);
  reader.number("turn_rad", Range::any(), motion.turn_rad);
  if (!known) return *reader.finish();  // the other keys depend on the kind
  if (auto error = reader.finish()) return *error;
  return motion;
}

}  // namespace

ScriptedDevice::ScriptedDevice(const math::Pose& start, std::vector<Motion> motions, bool repeat)
    : repeat_(repeat), spec_(simulated_spec("scripted", start.translation)) {
  if (motions.empty()) motions.push_back({});
  Vec3 position = start.translation;
  Quat orientation = Quat(start.rotation).normalized();
  for (const Motion& motion : motions) {
    pieces_.push_back({motion, duration_s_, position, orientation});
    const MotionSample end = sample(motion, motion.duration_s);
    position += end.offset_m;
    orientation = (Quat(Eigen::AngleAxisd(end.turned_rad, motion.turn_axis)) * orientation).normalized();
    duration_s_ += motion.duration_s;
  }
}

Result<std::unique_ptr<Device>> ScriptedDevice::make(const DeviceRequest& request) {
  SettingsReader reader(*request.settings);
  reader.allow(common_device_keys);
  auto device = read_script(reader);
  if (!device) return device.error();
  if (auto error = reader.finish()) return *error;
  return std::unique_ptr<Device>(std::move(device).value());
}

Result<std::unique_ptr<ScriptedDevice>> ScriptedDevice::read_script(SettingsReader& reader) {
  Vec3 position = Vec3::Zero();
  Quat orientation = Quat::Identity();
  bool repeat = false;
  reader.vector("position_m", position);
  reader.quaternion_wxyz("orientation_wxyz", orientation);
  reader.flag("repeat", repeat);
  std::vector<Motion> motions;
  for (const Settings* settings : reader.tables("motion")) {
    Result<Motion> motion = read_motion(*settings);
    if (!motion) return motion.error();
    motions.push_back(motion.value());
  }
  const auto start = math::Pose::from_quaternion(position, orientation);
  auto device = std::make_unique<ScriptedDevice>(start, std::move(motions), repeat);
  if (repeat) {
    DeviceState end;
    device->repeat_ = false;
    (void)device->read(std::numeric_limits<std::int64_t>::max(), end);
    device->repeat_ = true;
    const double gap_m = (end.position_m - position).norm();
    const double gap_rad = end.orientation.angularDistance(orientation);
    if (gap_m > closed_within_m || gap_rad > closed_within_rad) {
      reader.reject(
          "repeat",
          fmt::format("the motions end {:.4g} m and {:.4g} rad from where they began, so repeating them would jump",
                      gap_m, gap_rad),
          "add a motion that leads back, or leave 'repeat' out");
    }
  }
  return device;
}

bool ScriptedDevice::read(std::int64_t now_ns, DeviceState& state) noexcept {
  double time_s = 1e-9 * static_cast<double>(now_ns);
  if (repeat_) time_s = std::fmod(time_s, duration_s_);
  std::size_t i = pieces_.size() - 1;
  while (i > 0 && pieces_[i].begin_s > time_s) --i;
  const Piece& piece = pieces_[i];
  const MotionSample moved = sample(piece.motion, time_s - piece.begin_s);
  state.t_ns = now_ns;
  state.position_m = piece.position + moved.offset_m;
  state.orientation = Quat(Eigen::AngleAxisd(moved.turned_rad, piece.motion.turn_axis)) * piece.orientation;
  state.velocity_m_per_s = moved.velocity_m_per_s;
  state.angular_velocity_rad_per_s = moved.turn_rate_rad_per_s * piece.motion.turn_axis;
  state.buttons = 0;
  state.fresh = true;
  return true;
}

}  // namespace odds::haptics
