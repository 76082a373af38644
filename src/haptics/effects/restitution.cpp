// Bodies bounce: after an impact they part with a share of the speed at which they met.
#include <cmath>

#include "haptics/effects/list.hpp"

namespace odds::haptics::effects {
namespace {

class Restitution final : public Effect {
 public:
  Restitution(double coefficient, double from_m_per_s) : coefficient_(coefficient), from_m_per_s_(from_m_per_s) {}
  [[nodiscard]] std::uint32_t needs() const noexcept override { return need_patch | need_velocity; }
  [[nodiscard]] std::uint32_t stages() const noexcept override { return stage_meeting; }
  [[nodiscard]] std::string_view evaluates() const noexcept override { return "contacts"; }
  [[nodiscard]] std::string_view rests_on() const noexcept override { return "contact"; }
  [[nodiscard]] std::optional<Error> check(const ode::WorldOptions& options) const override {
    if (options.contact.law != ode::ContactLaw::penalty) return std::nullopt;
    return Error{"", "", "a penalty force knows no impact, and so no restitution",
                 "take law = \"compliant\" or \"constraint\" in [effects.contact], or remove [effects.restitution]"};
  }
  // An impact is over within a tick: the contact is rigid then, and its spring, which would add a speed of its own, is
  // silent until the bodies have parted or come to rest.
  std::uint32_t meet(const TickView&, ode::Meeting& meeting) noexcept override {
    std::uint32_t count = 0;
    for (ode::ContactPoint& point : meeting.contacts) {
      const double out = point.velocity_m_per_s.dot(point.normal);
      if (std::abs(out) <= from_m_per_s_) continue;
      point.surface.pushes = false;
      ++count;
      if (out > 0.0) continue;
      point.surface.restitution = coefficient_;
      point.surface.restitution_from_m_per_s = from_m_per_s_;
      point.surface.stiffness_n_per_m *= rigid;
      point.surface.damping_ns_per_m *= rigid;
    }
    return count;
  }

 private:
  static constexpr double rigid = 1e4;
  double coefficient_;
  double from_m_per_s_;
};

}  // namespace

Result<std::unique_ptr<Effect>> make_restitution(const EffectRequest& request) {
  SettingsReader reader(*request.settings);
  double coefficient = 0.0;
  double from_m_per_s = 0.05;
  reader.require("coefficient");
  reader.number("coefficient", {0.0, 1.0, true}, coefficient);
  reader.number("from_m_per_s", Range::positive(), from_m_per_s);
  if (auto error = reader.finish()) return *error;
  return std::unique_ptr<Effect>(std::make_unique<Restitution>(coefficient, from_m_per_s));
}

}  // namespace odds::haptics::effects
