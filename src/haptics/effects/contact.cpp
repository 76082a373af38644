// Bodies push each other apart: a spring and damper for each pair, solved implicitly or as an explicit penalty force,
// or a constraint.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <limits>

#include "haptics/effects/list.hpp"

namespace odds::haptics::effects {
namespace {

class Contact final : public Effect {
 public:
  explicit Contact(const ode::ContactModel& model) : model_(model) {}
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
    lightest_kg_ = std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < world.body_count(); ++i) {
      if (world.is_dynamic({i})) lightest_kg_ = std::min(lightest_kg_, world.mass({i}).mass_kg);
    }
    step_s_ = world.options().step_s;
    return std::nullopt;
  }
  std::uint32_t after_step(const TickView& tick) noexcept override { return tick.step->contacts; }
  // A point at a lever arm feels a quarter of the mass of a slender body.
  [[nodiscard]] std::vector<std::string> warnings(const DeviceSpec&, const DeviceScale&, double) const override {
    if (model_.law != ode::ContactLaw::penalty) return {};
    const double felt_kg = 0.25 * lightest_kg_;
    const double most = felt_kg / (step_s_ * step_s_);
    if (model_.stiffness_n_per_m <= most) return {};
    return {
        fmt::format("contact: a penalty of {:.6g} N/m may tremble on a body of {:.3g} kg with steps of {:.3g} ms: stay "
                    "below {:.6g} N/m, or take law = \"compliant\"",
                    model_.stiffness_n_per_m, lightest_kg_, 1e3 * step_s_, most)};
  }

 private:
  ode::ContactModel model_;
  double lightest_kg_ = std::numeric_limits<double>::infinity();
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
  return std::unique_ptr<Effect>(std::make_unique<Contact>(model));
}

}  // namespace odds::haptics::effects
