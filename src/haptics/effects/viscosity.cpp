// A fluid that drags bodies along, everywhere or in a box.
#include <limits>

#include "haptics/effects/list.hpp"

namespace odds::haptics::effects {
namespace {

struct Fluid {
  ode::Drag drag;
  Vec3 lower_m = Vec3::Constant(-std::numeric_limits<double>::infinity());
  Vec3 upper_m = Vec3::Constant(std::numeric_limits<double>::infinity());
};

class Viscosity final : public Effect {
 public:
  explicit Viscosity(const Fluid& fluid) : fluid_(fluid) {}
  [[nodiscard]] std::uint32_t needs() const noexcept override { return need_motion; }
  [[nodiscard]] std::uint32_t stages() const noexcept override { return stage_before_step; }
  [[nodiscard]] std::string_view evaluates() const noexcept override { return "bodies"; }
  [[nodiscard]] bool repeatable() const noexcept override { return true; }
  std::uint32_t before_step(const TickView& tick) noexcept override {
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < tick.world->body_count(); ++i) {
      if (!tick.world->is_dynamic({i})) continue;
      const Vec3 center = tick.world->state({i}).pose * tick.world->mass({i}).center_m;
      if ((center.array() < fluid_.lower_m.array()).any() || (center.array() > fluid_.upper_m.array()).any()) continue;
      tick.world->add_drag({i}, fluid_.drag);
      ++count;
    }
    return count;
  }

 private:
  Fluid fluid_;
};

}  // namespace

Result<std::unique_ptr<Effect>> make_viscosity(const EffectRequest& request) {
  SettingsReader reader(*request.settings);
  Fluid fluid;
  reader.require("drag_ns_per_m");
  reader.number("drag_ns_per_m", Range::not_negative(), fluid.drag.force_ns_per_m);
  reader.number("angular_drag_nms_per_rad", Range::not_negative(), fluid.drag.torque_nms_per_rad);
  reader.vector("flow_m_per_s", fluid.drag.flow_m_per_s);
  reader.vector("lower_m", fluid.lower_m);
  reader.vector("upper_m", fluid.upper_m);
  if (reader.has("upper_m") && (fluid.lower_m.array() >= fluid.upper_m.array()).any()) {
    reader.reject("upper_m", "the box of the fluid is empty", "let every number be greater than that of 'lower_m'");
  }
  if (auto error = reader.finish()) return *error;
  return std::unique_ptr<Effect>(std::make_unique<Viscosity>(fluid));
}

}  // namespace odds::haptics::effects
