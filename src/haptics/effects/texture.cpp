// Ridges or bumps on a surface, finer than its mesh: they raise the depth and tilt the normal.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "haptics/effects/body_key.hpp"
#include "haptics/effects/list.hpp"

namespace odds::haptics::effects {
namespace {

struct Relief {
  ode::BodyId body;
  bool bumps = false;
  double amplitude_m = 0.0;
  double wavelength_m = 0.0;
  Vec3 direction = Vec3::UnitX();  // unit, body frame: across the ridges
  Vec3 second = Vec3::UnitY();     // unit, body frame: of bumps
};

// Height h(x) over the surface. Depth d + h and a normal tilted by the slope of h are the gradient of one potential, so
// that nothing is gained by going round: the tool is pushed back down a ridge as it was pushed up.
class Texture final : public Effect {
 public:
  explicit Texture(const Relief& relief) : relief_(relief) {}
  [[nodiscard]] std::uint32_t needs() const noexcept override { return need_patch; }
  [[nodiscard]] std::uint32_t stages() const noexcept override { return stage_meeting; }
  [[nodiscard]] std::string_view evaluates() const noexcept override { return "contacts"; }
  [[nodiscard]] std::string_view rests_on() const noexcept override { return "contact"; }
  [[nodiscard]] bool repeatable() const noexcept override { return true; }
  std::uint32_t meet(const TickView& tick, ode::Meeting& meeting) noexcept override {
    if (!involves(meeting, relief_.body) || meeting.contacts.empty()) return 0;
    const math::Pose pose = tick.world->state(relief_.body).pose;
    const double outward = meeting.b == relief_.body ? 1.0 : -1.0;  // normals point into a
    for (ode::ContactPoint& point : meeting.contacts) {
      const auto [height, slope] = at(pose.inverse() * point.position_m);
      const Vec3 tilt = pose.rotation * slope;
      point.depth_m = std::max(0.0, point.depth_m + height);
      // The gradient of the potential is the longer, the steeper the surface. With a mere unit normal, who
      // goes in on a flank and out in a valley would gain.
      const Vec3 gradient = point.normal - outward * (tilt - tilt.dot(point.normal) * point.normal);
      const double length = gradient.norm();
      point.normal = gradient / length;
      point.surface.stiffness_n_per_m *= length;
      point.surface.damping_ns_per_m *= length;
    }
    return static_cast<std::uint32_t>(meeting.contacts.size());
  }

 private:
  [[nodiscard]] std::pair<double, Vec3> at(const Vec3& local_m) const noexcept {
    const double k = 2.0 * std::numbers::pi / relief_.wavelength_m;
    const double u = k * local_m.dot(relief_.direction);
    const double a = relief_.amplitude_m;
    if (!relief_.bumps) return {a * std::sin(u), a * k * std::cos(u) * relief_.direction};
    const double v = k * local_m.dot(relief_.second);
    return {a * std::sin(u) * std::sin(v),
            a * k * (std::cos(u) * std::sin(v) * relief_.direction + std::sin(u) * std::cos(v) * relief_.second)};
  }
  Relief relief_;
};

}  // namespace

Result<std::unique_ptr<Effect>> make_texture(const EffectRequest& request) {
  SettingsReader reader(*request.settings);
  static constexpr std::array<std::string_view, 2> kinds = {"ridges", "bumps"};
  Relief relief;
  std::size_t kind = 0;
  read_body(reader, "body", request.bodies, false, relief.body);
  reader.choice("kind", kinds, kind);
  relief.bumps = kind == 1;
  reader.require("amplitude_m");
  reader.require("wavelength_m");
  reader.number("amplitude_m", Range::positive(), relief.amplitude_m);
  reader.number("wavelength_m", Range::positive(), relief.wavelength_m);
  reader.direction("direction", relief.direction);
  Vec3 normal = Vec3::UnitZ();
  reader.direction("normal", normal);
  relief.second = normal.cross(relief.direction);
  if (relief.second.norm() < 1e-6) {
    reader.reject("direction", "the direction of the texture is its normal",
                  "give a direction along the surface, or another 'normal'");
  }
  relief.second.normalize();
  if (relief.amplitude_m * 2.0 * std::numbers::pi > relief.wavelength_m) {
    reader.reject("amplitude_m", "the texture is steeper than 45 degrees",
                  "give an amplitude of at most a sixth of the wavelength");
  }
  if (auto error = reader.finish()) return *error;
  return std::unique_ptr<Effect>(std::make_unique<Texture>(relief));
}

}  // namespace odds::haptics::effects
