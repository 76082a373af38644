// Damps the hand while the simulation has given it more energy than it took in.
#include <algorithm>

#include "haptics/effects/list.hpp"

namespace odds::haptics::effects {
namespace {

class PassivityControl final : public Effect {
 public:
  explicit PassivityControl(double most) : most_ns_per_m_(most) {}
  [[nodiscard]] std::uint32_t needs() const noexcept override { return need_device | need_history; }
  [[nodiscard]] std::uint32_t stages() const noexcept override { return stage_hand; }
  [[nodiscard]] std::string_view evaluates() const noexcept override { return "damped ticks"; }
  // As much damping as would take back, in one period at the hand's speed, what was given too much; Hannaford and Ryu's
  // controller in its impedance form, bounded because a sampled damper is itself active beyond some strength.
  std::uint32_t on_hand(const TickView& tick, ode::Wrench& on_hand) noexcept override {
    if (tick.energy == nullptr || !(tick.energy->energy_j() < 0.0)) return 0;
    const Vec3 velocity = tick.energy->step_m() / tick.passed_s;  // the device's own, as its energy
    const double speed_squared = velocity.squaredNorm();
    if (!(speed_squared > 0.0)) return 0;
    const double damping = std::min(most_ns_per_m_, -tick.energy->energy_j() / (speed_squared * tick.step_s));
    on_hand.force_n -= damping / tick.force_scale * velocity;
    return 1;
  }

 private:
  double most_ns_per_m_;
};

}  // namespace

Result<std::unique_ptr<Effect>> make_passivity_control(const EffectRequest& request) {
  SettingsReader reader(*request.settings);
  double most = 5.0;
  reader.number("max_damping_ns_per_m", Range::positive(), most);
  if (auto error = reader.finish()) return *error;
  return std::unique_ptr<Effect>(std::make_unique<PassivityControl>(most));
}

}  // namespace odds::haptics::effects
