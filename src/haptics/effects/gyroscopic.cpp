// The torque that makes a spinning body precess and a tumbling one wobble.
#include <Eigen/LU>
#include <vector>

#include "haptics/effects/list.hpp"

namespace odds::haptics::effects {
namespace {

// Spin after one implicit step of free rotation, in the body's frame: one Newton step of I (w1 - w) + h w1 x I w1 = 0
// (Catto, Numerical Methods, Game Developers Conference 2015). The explicit term would feed energy to fast spins.
Vec3 spin_after(const Mat3& inertia, const Vec3& spin, double h) noexcept {
  const auto skew = [](const Vec3& v) {
    Mat3 m;
    m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
    return m;
  };
  const Vec3 momentum = inertia * spin;
  const Mat3 slope = inertia + h * (skew(spin) * inertia - skew(momentum));
  return spin - slope.inverse() * (h * spin.cross(momentum));
}

class Gyroscopic final : public Effect {
 public:
  [[nodiscard]] std::uint32_t needs() const noexcept override { return need_motion; }
  [[nodiscard]] std::uint32_t stages() const noexcept override { return stage_before_step; }
  [[nodiscard]] std::string_view evaluates() const noexcept override { return "bodies"; }
  [[nodiscard]] std::optional<Error> bind(const ode::World& world) override {
    moving_.clear();
    for (std::uint32_t i = 0; i < world.body_count(); ++i) {
      if (world.is_dynamic({i})) moving_.push_back({i});
    }
    return std::nullopt;
  }
  std::uint32_t before_step(const TickView& tick) noexcept override {
    for (const ode::BodyId body : moving_) {
      const ode::BodyState state = tick.world->state(body);
      const Mat3& inertia = tick.world->mass(body).inertia_kg_m2;
      const Vec3 spin = state.pose.rotation.transpose() * state.angular_velocity_rad_per_s;
      const Vec3 change = spin_after(inertia, spin, tick.step_s) - spin;
      tick.world->apply(body, {Vec3::Zero(), state.pose.rotation * (inertia * change) / tick.step_s});
    }
    return static_cast<std::uint32_t>(moving_.size());
  }

 private:
  std::vector<ode::BodyId> moving_;
};

}  // namespace

Result<std::unique_ptr<Effect>> make_gyroscopic(const EffectRequest& request) {
  SettingsReader reader(*request.settings);
  if (auto error = reader.finish()) return *error;
  return std::unique_ptr<Effect>(std::make_unique<Gyroscopic>());
}

}  // namespace odds::haptics::effects
