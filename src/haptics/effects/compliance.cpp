// A soft body: its own spring in series with that of the contact.
#include "haptics/effects/body_key.hpp"
#include "haptics/effects/list.hpp"
#include "haptics/effects/shares.hpp"

namespace odds::haptics::effects {
namespace {

class Compliance final : public Effect {
 public:
  Compliance(ode::BodyId body, double stiffness, double damping) : body_(body), k_(stiffness), b_(damping) {}
  [[nodiscard]] std::uint32_t needs() const noexcept override { return need_patch | need_velocity; }
  [[nodiscard]] std::uint32_t stages() const noexcept override { return stage_meeting; }
  [[nodiscard]] std::string_view evaluates() const noexcept override { return "contacts"; }
  [[nodiscard]] std::string_view rests_on() const noexcept override { return "contact"; }
  [[nodiscard]] bool repeatable() const noexcept override { return true; }
  std::uint32_t meet(const TickView& tick, ode::Meeting& meeting) noexcept override {
    if (!involves(meeting, body_)) return 0;
    const double all = stiffness_of_all(meeting);
    for (ode::ContactPoint& point : meeting.contacts) {
      ode::Surface& surface = point.surface;
      double& k = surface.stiffness_n_per_m;
      const double share = k / all;
      if (!(surface.weight_of_law_ns_per_m > 0.0)) {
        surface.weight_of_law_ns_per_m = tick.step_s * k + surface.damping_ns_per_m;
      }
      k = in_series(k, k_ * share);
      surface.damping_ns_per_m = b_ * share;
    }
    return static_cast<std::uint32_t>(meeting.contacts.size());
  }
  [[nodiscard]] double pair_stiffness_n_per_m(ode::BodyId a, ode::BodyId b, double before) const noexcept override {
    return a == body_ || b == body_ ? in_series(before, k_) : before;
  }

 private:
  [[nodiscard]] static double in_series(double one, double other) noexcept { return one * other / (one + other); }
  ode::BodyId body_;
  double k_;
  double b_;
};

}  // namespace

Result<std::unique_ptr<Effect>> make_compliance(const EffectRequest& request) {
  SettingsReader reader(*request.settings);
  ode::BodyId body;
  double stiffness = 0.0;
  double damping = 0.0;
  read_body(reader, "body", request.bodies, false, body);
  reader.require("stiffness_n_per_m");
  reader.number("stiffness_n_per_m", Range::positive(), stiffness);
  reader.number("damping_ns_per_m", Range::not_negative(), damping);
  if (auto error = reader.finish()) return *error;
  return std::unique_ptr<Effect>(std::make_unique<Compliance>(body, stiffness, damping));
}

}  // namespace odds::haptics::effects
