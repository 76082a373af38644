// The equation of motion of hand and handle.
#include "odds/haptics/human_arm_device.hpp"

#include <algorithm>
#include <cmath>

#include "haptics/simulated_spec.hpp"

namespace odds::haptics {
namespace {

constexpr std::int64_t longest_step_ns = 20'000;
// A loop that was away for longer finds the hand where it would be after this time: nobody waits for the integration.
constexpr std::int64_t longest_gap_ns = 100'000'000;

// Shortest turn from `from` to `to`, axis times angle.
Vec3 turn_between(const Quat& from, const Quat& to) noexcept {
  Quat difference = to * from.conjugate();
  if (difference.w() < 0.0) difference.coeffs() *= -1.0;
  const Eigen::AngleAxisd turn(difference);
  return turn.angle() * turn.axis();
}

// Velocity after h of m dv/dt = force - b v - k dx, dx from the start of the step, by the implicit midpoint rule.
Vec3 midpoint(const Vec3& velocity, const Vec3& force, double mass, double b, double k, double h) noexcept {
  const double soft = 0.5 * h * b + 0.25 * h * h * k;
  return ((mass - soft) * velocity + h * force) / (mass + soft);
}

}  // namespace

HumanArmDevice::HumanArmDevice(std::unique_ptr<ScriptedDevice> script, const HumanArm& arm)
    : script_(std::move(script)), arm_(arm), spec_(simulated_spec("human_arm", script_->spec().workspace_center_m)) {
  spec_.physical_damping_ns_per_m = arm.device_damping_ns_per_m;
  spec_.max_stiffness_n_per_m = 0.0;  // not known: to be found out
  spec_.max_angular_stiffness_nm_per_rad = 0.0;
}

Result<std::unique_ptr<Device>> HumanArmDevice::make(const DeviceRequest& request) {
  SettingsReader reader(*request.settings);
  reader.allow(common_device_keys);
  HumanArm arm;
  reader.number("device_mass_kg", {1e-3, 1e3}, arm.device_mass_kg);
  reader.number("physical_damping_ns_per_m", Range::not_negative(), arm.device_damping_ns_per_m);
  reader.number("arm_mass_kg", Range::not_negative(), arm.arm_mass_kg);
  reader.number("arm_stiffness_n_per_m", Range::not_negative(), arm.arm_stiffness_n_per_m);
  reader.number("arm_damping_ns_per_m", Range::not_negative(), arm.arm_damping_ns_per_m);
  reader.number("inertia_kg_m2", {1e-9, 1e3}, arm.inertia_kg_m2);
  reader.number("turn_stiffness_nm_per_rad", Range::not_negative(), arm.turn_stiffness_nm_per_rad);
  reader.number("turn_damping_nms_per_rad", Range::not_negative(), arm.turn_damping_nms_per_rad);
  reader.number("resolution_m", Range::not_negative(), arm.resolution_m);
  auto script = ScriptedDevice::read_script(reader);
  if (!script) return script.error();
  if (auto error = reader.finish()) return *error;
  return std::unique_ptr<Device>(std::make_unique<HumanArmDevice>(std::move(script).value(), arm));
}

void HumanArmDevice::begin(std::int64_t now_ns) noexcept {
  (void)script_->read(now_ns, handle_);
  handle_.velocity_m_per_s.setZero();
  handle_.angular_velocity_rad_per_s.setZero();
  reading_ = handle_;
  force_n_.setZero();
  torque_nm_.setZero();
  begun_ = true;
}

void HumanArmDevice::advance(std::int64_t to_ns) noexcept {
  const std::int64_t way_ns = std::min(to_ns - handle_.t_ns, longest_gap_ns);
  const std::int64_t steps = (way_ns + longest_step_ns - 1) / longest_step_ns;
  const double h = 1e-9 * static_cast<double>(way_ns) / static_cast<double>(std::max<std::int64_t>(steps, 1));
  const double mass = arm_.device_mass_kg + arm_.arm_mass_kg;
  const Vec3 force = forces_on_ ? force_n_ : Vec3::Zero().eval();
  const Vec3 torque = forces_on_ ? torque_nm_ : Vec3::Zero().eval();
  DeviceState target;
  for (std::int64_t i = 0; i < steps; ++i) {
    const std::int64_t middle_ns = to_ns - way_ns + (2 * i + 1) * way_ns / (2 * steps);
    (void)script_->read(middle_ns, target);
    Vec3& x = handle_.position_m;
    Vec3& v = handle_.velocity_m_per_s;
    const Vec3 v0 = v;
    const Vec3 push = force + arm_.arm_stiffness_n_per_m * (target.position_m - x) +
                      arm_.arm_damping_ns_per_m * target.velocity_m_per_s;
    const double b = arm_.device_damping_ns_per_m + arm_.arm_damping_ns_per_m;
    v = midpoint(v0, push, mass, b, arm_.arm_stiffness_n_per_m, h);
    x += 0.5 * h * (v0 + v);
    Vec3& w = handle_.angular_velocity_rad_per_s;
    const Vec3 w0 = w;
    const Vec3 twist = torque + arm_.turn_stiffness_nm_per_rad * turn_between(handle_.orientation, target.orientation) +
                       arm_.turn_damping_nms_per_rad * target.angular_velocity_rad_per_s;
    w = midpoint(w0, twist, arm_.inertia_kg_m2, arm_.turn_damping_nms_per_rad, arm_.turn_stiffness_nm_per_rad, h);
    const Vec3 turn = 0.5 * h * (w0 + w);
    const double angle = turn.norm();
    if (angle > 0.0) {
      handle_.orientation = (Quat(Eigen::AngleAxisd(angle, turn / angle)) * handle_.orientation).normalized();
    }
  }
  handle_.t_ns = to_ns;
}

// What the sensors say: the position in whole steps of the resolution, velocities as differences of such positions.
DeviceState HumanArmDevice::sensed(std::int64_t now_ns) noexcept {
  DeviceState state = handle_;
  state.fresh = true;
  state.buttons = 0;
  if (!(arm_.resolution_m > 0.0)) return state;
  state.position_m = arm_.resolution_m * (handle_.position_m / arm_.resolution_m).array().round().matrix();
  const double dt_s = 1e-9 * static_cast<double>(now_ns - reading_.t_ns);
  state.velocity_m_per_s =
      dt_s > 0.0 ? Vec3((state.position_m - reading_.position_m) / dt_s) : reading_.velocity_m_per_s;
  return state;
}

bool HumanArmDevice::read(std::int64_t now_ns, DeviceState& state) noexcept {
  if (!begun_ || now_ns < handle_.t_ns) begin(now_ns);
  if (now_ns > handle_.t_ns) advance(now_ns);
  reading_ = sensed(now_ns);
  state = reading_;
  return true;
}

bool HumanArmDevice::write(const DeviceCommand& command) noexcept {
  if (!command.force_n.allFinite() || !command.torque_nm.allFinite()) return false;
  force_n_ = command.force_n;
  torque_nm_ = command.torque_nm;
  return true;
}

bool HumanArmDevice::enable_forces(bool on) noexcept {
  forces_on_ = on;
  if (on) begun_ = false;  // the loop's time begins
  return true;
}

}  // namespace odds::haptics
