// Speeds of all bodies decay exponentially, as ODE does it.
#include "haptics/effects/list.hpp"

namespace odds::haptics::effects {
namespace {

class BodyDamping final : public Effect {
 public:
  explicit BodyDamping(const ode::Damping& damping) : damping_(damping) {}
  [[nodiscard]] std::uint32_t needs() const noexcept override { return need_motion; }
  [[nodiscard]] std::uint32_t stages() const noexcept override { return stage_after_step; }
  [[nodiscard]] std::string_view evaluates() const noexcept override { return "bodies"; }
  void configure(ode::WorldOptions& options) const override { options.damping = damping_; }
  std::uint32_t after_step(const TickView& tick) noexcept override { return tick.step->bodies_stepped; }

 private:
  ode::Damping damping_;
};

}  // namespace

Result<std::unique_ptr<Effect>> make_damping(const EffectRequest& request) {
  SettingsReader reader(*request.settings);
  ode::Damping damping;
  reader.number("linear_per_s", Range::not_negative(), damping.linear_per_s);
  reader.number("angular_per_s", Range::not_negative(), damping.angular_per_s);
  if (auto error = reader.finish()) return *error;
  return std::unique_ptr<Effect>(std::make_unique<BodyDamping>(damping));
}

}  // namespace odds::haptics::effects
