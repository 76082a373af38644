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
    const double scale = tick.force_scale;
    const Vec3 force = damping({tick.energy->step_m() / tick.moved_s, scale * on_hand.force_n, tick.max_force_n},
                               tick.step_s, most_ns_per_m_, owed_j);
    const Vec3 torque = damping({tick.energy->turn_rad() / tick.moved_s, scale * on_hand.torque_nm, tick.max_torque_nm},
                                tick.step_s, most_nms_per_rad_, owed_j);
    on_hand.force_n += force / scale;
    on_hand.torque_nm += torque / scale;
    return force.isZero(0.0) && torque.isZero(0.0) ? 0 : 1;
  }

 private:
  /// How the hand moves along, or turns about, and what it is given in it.
  struct Port {
    Vec3 velocity;
    Vec3 force;    // without the damping, before the limit
    double limit;  // of the force's length
    [[nodiscard]] Vec3 given(const Vec3& wanted) const noexcept {
      const double length = wanted.stableNorm();
      return length > limit ? Vec3(wanted * (limit / length)) : wanted;
    }
  };

  /// What slows the velocity down, and takes in a period of what is owed all that it may, as far as the limit lets it.
  static Vec3 damping(const Port& port, double step_s, double most, double& owed_j) noexcept {
    const double speed_squared = port.velocity.squaredNorm();
    if (!(speed_squared > 0.0) || !(port.limit > 0.0)) return Vec3::Zero();
    const double strength = std::min(most, owed_j / (speed_squared * step_s));
    const Vec3 force = -strength * port.velocity;
    const Vec3 whole = port.force + force;
    if (std::max(port.force.stableNorm(), whole.stableNorm()) > port.limit) {
      owed_j -= step_s * std::max(0.0, (port.given(port.force) - port.given(whole)).dot(port.velocity));
    } else {
      owed_j = strength < most ? 0.0 : owed_j - strength * speed_squared * step_s;
    }
    owed_j = std::max(0.0, owed_j);
    return force;
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
