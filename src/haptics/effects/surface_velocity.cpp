// A conveyor: the surface of a body that stands still carries others along.
#include "haptics/effects/body_key.hpp"
#include "haptics/effects/list.hpp"

namespace odds::haptics::effects {
namespace {

class SurfaceVelocity final : public Effect {
 public:
  SurfaceVelocity(ode::BodyId body, const Vec3& velocity) : body_(body), velocity_m_per_s_(velocity) {}
  [[nodiscard]] std::uint32_t needs() const noexcept override { return need_patch | need_velocity; }
  [[nodiscard]] std::uint32_t stages() const noexcept override { return stage_meeting; }
  [[nodiscard]] std::string_view evaluates() const noexcept override { return "contacts"; }
  [[nodiscard]] std::string_view rests_on() const noexcept override { return "friction"; }
  [[nodiscard]] bool repeatable() const noexcept override { return true; }
  std::uint32_t meet(const TickView& tick, ode::Meeting& meeting) noexcept override {
    if (!involves(meeting, body_) || meeting.contacts.empty()) return 0;
    const Vec3 along = tick.world->state(body_).pose.rotation * velocity_m_per_s_;
    const double sign = meeting.b == body_ ? 1.0 : -1.0;
    for (ode::ContactPoint& point : meeting.contacts) {
      point.surface.surface_velocity += sign * (along - along.dot(point.normal) * point.normal);
    }
    return static_cast<std::uint32_t>(meeting.contacts.size());
  }

 private:
  ode::BodyId body_;
  Vec3 velocity_m_per_s_;  // in the body's frame
};

}  // namespace

Result<std::unique_ptr<Effect>> make_surface_velocity(const EffectRequest& request) {
  SettingsReader reader(*request.settings);
  ode::BodyId body;
  Vec3 velocity = Vec3::Zero();
  read_body(reader, "body", request.bodies, false, body);
  reader.require("velocity_m_per_s");
  reader.vector("velocity_m_per_s", velocity);
  if (auto error = reader.finish()) return *error;
  return std::unique_ptr<Effect>(std::make_unique<SurfaceVelocity>(body, velocity));
}

}  // namespace odds::haptics::effects
