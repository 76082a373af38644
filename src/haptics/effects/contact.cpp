// Bodies push each other apart: a spring and damper for each pair, solved implicitly or as an explicit penalty force,
// or a constraint.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <limits>

#include "haptics/effects/list.hpp"
#include "odds/haptics/effect_set.hpp"

namespace odds::haptics::effects {
namespace {

class Contact final : public Effect {
 public:
  Contact(const ode::ContactModel& model, std::span<const BodyInfo> bodies)
      : model_(model), bodies_(bodies.begin(), bodies.end()) {}
  [[nodiscard]] std::uint32_t needs() const noexcept override {
    return need_patch | (model_.law == ode::ContactLaw::penalty ? std::uint32_t{need_velocity} : 0U);
  }
  [[nodiscard]] std::uint32_t stages() const noexcept override { return stage_after_step; }
  [[nodiscard]] std::string_view evaluates() const noexcept override { return "contacts"; }
  void configure(ode::WorldOptions& options) const override {
    const double friction = options.contact.friction;  // another effect's
    options.contact = model_;
    options.contact.friction = friction;
  }
  [[nodiscard]] std::optional<Error> bind(const ode::World& world) override {
    masses_kg_.clear();
    for (std::uint32_t i = 0; i < world.body_count(); ++i) {
      masses_kg_.push_back(world.is_dynamic({i}) ? world.mass({i}).mass_kg : std::numeric_limits<double>::infinity());
    }
    step_s_ = world.options().step_s;
    return std::nullopt;
  }
  std::uint32_t after_step(const TickView& tick) noexcept override { return tick.step->contacts; }
  [[nodiscard]] std::vector<std::string> warnings(const EffectSet& all) const override {
    if (model_.law != ode::ContactLaw::penalty) return {};
    Worst worst;
    for (std::uint32_t a = 0; a < masses_kg_.size(); ++a) {
      for (std::uint32_t b = a + 1; b < masses_kg_.size(); ++b) {
        const Worst pair{a, b, all.pair_stiffness_n_per_m({a}, {b}, model_.stiffness_n_per_m),
                         most_n_per_m(std::min(masses_kg_[a], masses_kg_[b]))};
        if (pair.stiffness_n_per_m * worst.most_n_per_m > worst.stiffness_n_per_m * pair.most_n_per_m) worst = pair;
      }
    }
    if (worst.stiffness_n_per_m <= worst.most_n_per_m) return {};
    const std::uint32_t lighter = masses_kg_[worst.a] < masses_kg_[worst.b] ? worst.a : worst.b;
    return {
        fmt::format("contact: a penalty of {:.6g} N/m between '{}' and '{}' may tremble on a body of {:.3g} kg with "
                    "steps of {:.3g} "
                    "ms: stay below {:.6g} N/m, or take law = \"compliant\"",
                    worst.stiffness_n_per_m, bodies_[worst.a].name, bodies_[worst.b].name, masses_kg_[lighter],
                    1e3 * step_s_, worst.most_n_per_m)};
  }

 private:
  /// The pair that is stiffest for its lighter body.
  struct Worst {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    double stiffness_n_per_m = 0.0;
    double most_n_per_m = 1.0;
  };
  // A point at a lever arm feels a quarter of the mass of a slender body.
  [[nodiscard]] double most_n_per_m(double mass_kg) const noexcept { return 0.25 * mass_kg / (step_s_ * step_s_); }

  ode::ContactModel model_;
  std::vector<BodyInfo> bodies_;
  std::vector<double> masses_kg_;  // infinite: fixed
  double step_s_ = 0.0;
};

}  // namespace

Result<std::unique_ptr<Effect>> make_contact(const EffectRequest& request) {
  SettingsReader reader(*request.settings);
  static constexpr std::array<std::string_view, 3> laws = {"compliant", "penalty", "constraint"};
  std::size_t law = 0;
  ode::ContactModel model;
  reader.choice("law", laws, law);
  model.law = std::array{ode::ContactLaw::compliant, ode::ContactLaw::penalty, ode::ContactLaw::constraint}[law];
  reader.number("stiffness_n_per_m", Range::positive(), model.stiffness_n_per_m);
  reader.number("damping_ns_per_m", Range::not_negative(), model.damping_ns_per_m);
  reader.number("error_reduction", {0.0, 1.0, true}, model.error_reduction);
  reader.number("max_correcting_velocity_m_per_s", Range::positive(), model.max_correcting_velocity_m_per_s);
  const bool constraint = model.law == ode::ContactLaw::constraint;
  for (const std::string_view key : {"stiffness_n_per_m", "damping_ns_per_m"}) {
    if (!constraint || !reader.has(key)) continue;
    reader.reject(key, "a constraint does not yield", "remove this key, or take law = \"compliant\" or \"penalty\"");
  }
  if (!constraint && reader.has("error_reduction")) {
    reader.reject("error_reduction", "only a constraint takes a share of the overlap away in each step",
                  "remove this key, or take law = \"constraint\"");
  }
  if (auto error = reader.finish()) return *error;
  return std::unique_ptr<Effect>(std::make_unique<Contact>(model, request.bodies));
}

}  // namespace odds::haptics::effects
