// Bodies push each other apart: a spring and damper for each pair, solved implicitly.
#include "haptics/effects/list.hpp"

namespace odds::haptics::effects {
namespace {

struct Parameters {
  double stiffness_n_per_m = 20000.0;
  double damping_ns_per_m = 20.0;
  double max_correcting_velocity_m_per_s = 1.0;
};

class Contact final : public Effect {
 public:
  explicit Contact(const Parameters& parameters) : parameters_(parameters) {}
  [[nodiscard]] std::uint32_t needs() const noexcept override { return need_patch; }
  [[nodiscard]] std::uint32_t stages() const noexcept override { return stage_after_step; }
  [[nodiscard]] std::string_view evaluates() const noexcept override { return "contacts"; }
  void configure(ode::WorldOptions& options) const override {
    options.contact.responds = true;
    options.contact.stiffness_n_per_m = parameters_.stiffness_n_per_m;
    options.contact.damping_ns_per_m = parameters_.damping_ns_per_m;
    options.contact.max_correcting_velocity_m_per_s = parameters_.max_correcting_velocity_m_per_s;
  }
  std::uint32_t after_step(const TickView& tick) noexcept override { return tick.step->contacts; }

 private:
  Parameters parameters_;
};

}  // namespace

Result<std::unique_ptr<Effect>> make_contact(const EffectRequest& request) {
  SettingsReader reader(*request.settings);
  Parameters parameters;
  reader.number("stiffness_n_per_m", Range::positive(), parameters.stiffness_n_per_m);
  reader.number("damping_ns_per_m", Range::not_negative(), parameters.damping_ns_per_m);
  reader.number("max_correcting_velocity_m_per_s", Range::positive(), parameters.max_correcting_velocity_m_per_s);
  if (auto error = reader.finish()) return *error;
  return std::unique_ptr<Effect>(std::make_unique<Contact>(parameters));
}

}  // namespace odds::haptics::effects
