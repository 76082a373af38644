// Torques against rolling and against spinning on the spot, in proportion to the normal force.
#include "haptics/effects/list.hpp"

namespace odds::haptics::effects {
namespace {

class RollingFriction final : public Effect {
 public:
  RollingFriction(double rolling_m, double spinning_m) : rolling_m_(rolling_m), spinning_m_(spinning_m) {}
  [[nodiscard]] std::uint32_t needs() const noexcept override { return need_patch | need_angular_rows; }
  [[nodiscard]] std::uint32_t stages() const noexcept override { return stage_meeting; }
  [[nodiscard]] std::string_view evaluates() const noexcept override { return "contacts"; }
  [[nodiscard]] std::string_view rests_on() const noexcept override { return "contact"; }
  std::uint32_t meet(const TickView&, ode::Meeting& meeting) noexcept override {
    for (ode::ContactPoint& point : meeting.contacts) {
      point.surface.rolling_m = rolling_m_;
      point.surface.spinning_m = spinning_m_;
    }
    return static_cast<std::uint32_t>(meeting.contacts.size());
  }

 private:
  double rolling_m_;
  double spinning_m_;
};

}  // namespace

Result<std::unique_ptr<Effect>> make_rolling_friction(const EffectRequest& request) {
  SettingsReader reader(*request.settings);
  double rolling_m = 0.0;
  double spinning_m = 0.0;
  reader.number("rolling_m", Range::positive(), rolling_m);
  reader.number("spinning_m", Range::positive(), spinning_m);
  if (!reader.has("rolling_m") && !reader.has("spinning_m")) {
    reader.reject(request.settings->place, "rolling friction without a coefficient does nothing",
                  "add 'rolling_m', 'spinning_m' or both");
  }
  if (auto error = reader.finish()) return *error;
  return std::unique_ptr<Effect>(std::make_unique<RollingFriction>(rolling_m, spinning_m));
}

}  // namespace odds::haptics::effects
