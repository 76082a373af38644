// The weight of bodies, as ODE adds it.
#include "haptics/effects/list.hpp"

namespace odds::haptics::effects {
namespace {

class Gravity final : public Effect {
 public:
  explicit Gravity(const Vec3& g_m_per_s2) : g_m_per_s2_(g_m_per_s2) {}
  [[nodiscard]] std::uint32_t needs() const noexcept override { return need_motion; }
  [[nodiscard]] std::uint32_t stages() const noexcept override { return stage_after_step; }
  [[nodiscard]] std::string_view evaluates() const noexcept override { return "bodies"; }
  void configure(ode::WorldOptions& options) const override { options.gravity_m_per_s2 = g_m_per_s2_; }
  std::uint32_t after_step(const TickView& tick) noexcept override { return tick.step->bodies_stepped; }

 private:
  Vec3 g_m_per_s2_;
};

}  // namespace

Result<std::unique_ptr<Effect>> make_gravity(const EffectRequest& request) {
  SettingsReader reader(*request.settings);
  Vec3 g_m_per_s2(0.0, 0.0, -9.81);
  reader.vector("g_m_per_s2", g_m_per_s2);
  if (auto error = reader.finish()) return *error;
  return std::unique_ptr<Effect>(std::make_unique<Gravity>(g_m_per_s2));
}

}  // namespace odds::haptics::effects
