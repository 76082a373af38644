// Contacts give back no more energy than they took in: a change of the contact set adds none.
#include <algorithm>

#include "haptics/effects/list.hpp"

namespace odds::haptics::effects {
namespace {

class EnergyTank final : public Effect {
 public:
  EnergyTank(double initial_j, double capacity_j) : initial_j_(initial_j), capacity_j_(capacity_j) {}
  [[nodiscard]] std::uint32_t needs() const noexcept override { return need_patch | need_contact_work | need_history; }
  [[nodiscard]] std::uint32_t stages() const noexcept override { return stage_meeting | stage_after_step; }
  [[nodiscard]] std::string_view evaluates() const noexcept override { return "contacts held back"; }
  [[nodiscard]] std::string_view rests_on() const noexcept override { return "contact"; }
  void reset() noexcept override { level_j_ = initial_j_; }
  void keep() noexcept override { kept_j_ = level_j_; }
  void put_back() noexcept override { level_j_ = kept_j_; }
  // With an empty tank contacts stop an approach and push no further. Bodies then sink slowly, which fills it again.
  std::uint32_t meet(const TickView&, ode::Meeting& meeting) noexcept override {
    if (level_j_ > 0.0) return 0;
    for (ode::ContactPoint& point : meeting.contacts) point.surface.pushes = false;
    return static_cast<std::uint32_t>(meeting.contacts.size());
  }
  std::uint32_t after_step(const TickView& tick) noexcept override {
    level_j_ = std::min(capacity_j_, level_j_ - tick.step->contact_work_j);
    return 0;
  }

 private:
  double initial_j_;
  double capacity_j_;
  double level_j_ = 0.0;
  double kept_j_ = 0.0;
};

}  // namespace

Result<std::unique_ptr<Effect>> make_energy_tank(const EffectRequest& request) {
  SettingsReader reader(*request.settings);
  double initial_j = 1e-4;
  double capacity_j = 1.0;
  reader.number("initial_j", Range::not_negative(), initial_j);
  reader.number("capacity_j", Range::positive(), capacity_j);
  if (initial_j > capacity_j) {
    reader.reject("initial_j", "the tank holds more at the start than it can", "give at most 'capacity_j'");
  }
  if (auto error = reader.finish()) return *error;
  return std::unique_ptr<Effect>(std::make_unique<EnergyTank>(initial_j, capacity_j));
}

}  // namespace odds::haptics::effects
