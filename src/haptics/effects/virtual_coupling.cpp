// The spring and damper between the hand and its body, and what the hand feels of it.
#include "odds/haptics/virtual_coupling.hpp"
#include "haptics/effects/list.hpp"

namespace odds::haptics::effects {
namespace {

class Coupling final : public Effect {
 public:
  Coupling(const VirtualCoupling& coupling, bool torque) : coupling_(coupling), torque_(torque) {}
  [[nodiscard]] std::uint32_t needs() const noexcept override { return need_device | need_motion; }
  [[nodiscard]] std::uint32_t stages() const noexcept override { return stage_before_step | stage_hand; }
  [[nodiscard]] std::string_view evaluates() const noexcept override { return "ticks"; }
  std::uint32_t before_step(const TickView& tick) noexcept override {
    if (tick.device == nullptr) return 0;
    tick.world->set_coupling(tick.tool, coupling_.towards(*tick.device));
    return 1;
  }
  std::uint32_t on_hand(const TickView& tick, ode::Wrench& on_hand) noexcept override {
    const ode::Wrench on_body = tick.world->coupling_wrench(tick.tool);
    if (!torque_) {
      on_hand.force_n -= on_body.force_n;
      return 0;
    }
    const Vec3 center = tick.world->state(tick.tool).pose * tick.world->mass(tick.tool).center_m;
    const ode::Wrench reaction = reaction_on_hand(on_body, center, tick.device->position_m);
    on_hand.force_n += reaction.force_n;
    on_hand.torque_nm += reaction.torque_nm;
    return 0;  // the same tick
  }
  [[nodiscard]] std::vector<std::string> device_warnings(const DeviceSpec& device, const DeviceScale& scale,
                                                         double period_s) const override {
    std::vector<std::string> all;
    if (auto warning = passivity_warning(coupling_, device, period_s, scale)) all.push_back(std::move(*warning));
    if (!torque_) return all;
    if (auto warning = torque_warning(coupling_, device, scale)) all.push_back(std::move(*warning));
    return all;
  }

 private:
  VirtualCoupling coupling_;
  bool torque_;  // false: a device of three degrees of freedom
};

}  // namespace

Result<std::unique_ptr<Effect>> make_virtual_coupling(const EffectRequest& request) {
  SettingsReader reader(*request.settings);
  VirtualCoupling coupling;
  std::int64_t freedom = 6;
  reader.number("k_t_n_per_m", Range::positive(), coupling.k_t_n_per_m);
  reader.number("b_t_ns_per_m", Range::not_negative(), coupling.b_t_ns_per_m);
  reader.number("k_r_nm_per_rad", Range::positive(), coupling.k_r_nm_per_rad);
  reader.number("b_r_nms_per_rad", Range::not_negative(), coupling.b_r_nms_per_rad);
  reader.number("max_force_n", Range::positive(), coupling.max_force_n);
  reader.number("max_torque_nm", Range::positive(), coupling.max_torque_nm);
  if (reader.integer("degrees_of_freedom", 3, 6, freedom) && freedom != 3 && freedom != 6) {
    reader.reject("degrees_of_freedom", "a hand feels a force, or a force and a torque", "give 3 or 6");
  }
  if (auto error = reader.finish()) return *error;
  return std::unique_ptr<Effect>(std::make_unique<Coupling>(coupling, freedom == 6));
}

}  // namespace odds::haptics::effects
