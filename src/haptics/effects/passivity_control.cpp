// Damps the hand while the simulation has given it more energy than it took in.
#include <algorithm>

#include "haptics/effects/list.hpp"

namespace odds::haptics::effects {
namespace {

class PassivityControl final : public Effect {
 public:
  PassivityControl(double most, double most_angular) : most_ns_per_m_(most), most_nms_per_rad_(most_angular) {}
  [[nodiscard]] std::uint32_t needs() const noexcept override { return need_device | need_history; }
  [[nodiscard]] std::uint32_t stages() const noexcept override { return stage_hand; }
  [[nodiscard]] std::string_view evaluates() const noexcept override { return "damped ticks"; }
  // As much damping as would take back, in one period at the hand's speed, what was given too much; Hannaford and Ryu's
  // controller in its impedance form, bounded because a sampled damper is itself active beyond some strength. What the
  // hand's way is too short for, its turn is asked for.
  std::uint32_t on_hand(const TickView& tick, ode::Wrench& on_hand) noexcept override {
    if (tick.energy == nullptr || !(tick.energy->energy_j() < 0.0)) return 0;
    double owed_j = -tick.energy->energy_j();
    // The device's own velocities, as its energy.
    const Vec3 force = damping(tick.energy->step_m() / tick.moved_s, tick.step_s, most_ns_per_m_, owed_j);
    const Vec3 torque = damping(tick.energy->turn_rad() / tick.moved_s, tick.step_s, most_nms_per_rad_, owed_j);
    on_hand.force_n += force / tick.force_scale;
    on_hand.torque_nm += torque / tick.force_scale;
    return force.isZero(0.0) && torque.isZero(0.0) ? 0 : 1;
  }

 private:
  /// What slows the velocity down, and takes in a period of what is owed all that it may.
  static Vec3 damping(const Vec3& velocity, double step_s, double most, double& owed_j) noexcept {
    const double speed_squared = velocity.squaredNorm();
    if (!(speed_squared > 0.0)) return Vec3::Zero();
    const double strength = std::min(most, owed_j / (speed_squared * step_s));
    owed_j = strength < most ? 0.0 : owed_j - strength * speed_squared * step_s;
    return -strength * velocity;
  }

  double most_ns_per_m_;
  double most_nms_per_rad_;
};

}  // namespace

Result<std::unique_ptr<Effect>> make_passivity_control(const EffectRequest& request) {
  SettingsReader reader(*request.settings);
  double most = 5.0;
  double most_angular = 0.005;
  reader.number("max_damping_ns_per_m", Range::positive(), most);
  reader.number("max_angular_damping_nms_per_rad", Range::positive(), most_angular);
  if (auto error = reader.finish()) return *error;
  return std::unique_ptr<Effect>(std::make_unique<PassivityControl>(most, most_angular));
}

}  // namespace odds::haptics::effects
