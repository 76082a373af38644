// Coulomb's friction, with stick-slip and a viscous part where the scene asks for them.
#include <algorithm>
#include <cmath>

#include "haptics/effects/list.hpp"
#include "haptics/effects/shares.hpp"

namespace odds::haptics::effects {
namespace {

struct Parameters {
  double mu = 0.0;
  double static_mu = 0.0;         // at rest; mu where the scene gives none
  double stick_m_per_s = 0.01;    // below about this slip the static one holds (Stribeck)
  double viscous_ns_per_m = 0.0;  // of a pair
  Place viscous_place;
};

class Friction final : public Effect {
 public:
  explicit Friction(const Parameters& parameters) : parameters_(parameters) {}
  [[nodiscard]] std::uint32_t needs() const noexcept override { return need_patch | need_velocity; }
  [[nodiscard]] std::uint32_t stages() const noexcept override {
    return stage_after_step | (depends_on_slip() ? std::uint32_t{stage_meeting} : 0U);
  }
  [[nodiscard]] std::string_view evaluates() const noexcept override { return "contacts"; }
  [[nodiscard]] std::string_view rests_on() const noexcept override { return "contact"; }
  void configure(ode::WorldOptions& options) const override { options.contact.friction = parameters_.mu; }
  [[nodiscard]] std::optional<Error> check(const ode::WorldOptions& options) const override {
    if (!(parameters_.viscous_ns_per_m > 0.0) || options.contact.law != ode::ContactLaw::constraint) return {};
    return Error{"", parameters_.viscous_place.text(),
                 "viscous friction needs the normal force, which a constraint tells only when it is solved",
                 "take law = \"compliant\" or \"penalty\" in [effects.contact], or remove 'viscous_ns_per_m'"};
  }
  std::uint32_t meet(const TickView&, ode::Meeting& meeting) noexcept override {
    const double all = stiffness_of_all(meeting);
    for (ode::ContactPoint& point : meeting.contacts) {
      point.surface.friction = at(point, point.surface.stiffness_n_per_m / all);
    }
    return 0;  // counted by the rows
  }
  std::uint32_t after_step(const TickView& tick) noexcept override { return tick.step->friction_rows / 2; }

 private:
  [[nodiscard]] bool depends_on_slip() const noexcept {
    return parameters_.static_mu > parameters_.mu || parameters_.viscous_ns_per_m > 0.0;
  }
  // The viscous force as a share of the normal force: the solver bounds friction by mu times that, and never lets it
  // turn the slip round, however large it is.
  [[nodiscard]] double at(const ode::ContactPoint& point, double share) const noexcept {
    const Vec3 relative = point.velocity_m_per_s - point.surface.surface_velocity;
    const double out = relative.dot(point.normal);
    const double slip = (relative - out * point.normal).norm();
    const double r = slip / parameters_.stick_m_per_s;
    double mu = parameters_.mu + (parameters_.static_mu - parameters_.mu) * std::exp(-r * r);
    const double normal_n = point.surface.stiffness_n_per_m * point.depth_m - point.surface.damping_ns_per_m * out;
    if (normal_n > 0.0) mu += parameters_.viscous_ns_per_m * share * slip / normal_n;
    return std::min(mu, most_mu);
  }
  static constexpr double most_mu = 1e3;
  Parameters parameters_;
};

}  // namespace

Result<std::unique_ptr<Effect>> make_friction(const EffectRequest& request) {
  SettingsReader reader(*request.settings);
  Parameters parameters;
  reader.require("mu");
  reader.number("mu", {0.0, 100.0, true}, parameters.mu);
  parameters.static_mu = parameters.mu;
  if (reader.number("static_mu", {0.0, 100.0, true}, parameters.static_mu) && parameters.static_mu < parameters.mu) {
    reader.reject("static_mu", "friction at rest is less than in motion", "give at least 'mu'");
  }
  reader.number("stick_m_per_s", Range::positive(), parameters.stick_m_per_s);
  reader.number("viscous_ns_per_m", Range::not_negative(), parameters.viscous_ns_per_m);
  parameters.viscous_place = reader.place_of("viscous_ns_per_m");
  if (reader.has("stick_m_per_s") && !reader.has("static_mu")) {
    reader.reject("stick_m_per_s", "without 'static_mu' nothing sticks", "add 'static_mu', or remove this key");
  }
  if (auto error = reader.finish()) return *error;
  return std::unique_ptr<Effect>(std::make_unique<Friction>(parameters));
}

}  // namespace odds::haptics::effects
