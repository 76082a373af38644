// A magnet: two bodies draw each other, most at a certain distance, not at all far away.
#include <fmt/core.h>

#include <array>

#include "haptics/effects/body_key.hpp"
#include "haptics/effects/list.hpp"

namespace odds::haptics::effects {
namespace {

struct Magnet {
  ode::BodyId body;
  ode::BodyId to;
  std::string names;  // of both, for people
  double max_force_n = 0.0;
  double range_m = 0.0;
};

// Potential -U / (1 + x^2) with x = distance / range. Its force is greatest at x = 1 / sqrt(3), and without bound
// nowhere.
class Attraction final : public Effect {
 public:
  explicit Attraction(const Magnet& magnet) : magnet_(magnet) {}
  [[nodiscard]] std::uint32_t needs() const noexcept override { return need_motion; }
  [[nodiscard]] std::uint32_t stages() const noexcept override { return stage_before_step; }
  [[nodiscard]] std::string_view evaluates() const noexcept override { return "pairs"; }
  [[nodiscard]] bool repeatable() const noexcept override { return true; }
  [[nodiscard]] std::optional<Error> bind(const ode::World& world) override {
    // Near the magnet the force is a spring: as stiff as one step can hold, and no stiffer.
    double inverse_mass = 0.0;
    for (const ode::BodyId body : {magnet_.body, magnet_.to}) {
      if (world.is_dynamic(body)) inverse_mass += 1.0 / world.mass(body).mass_kg;
    }
    centers_ = {center_of(world, magnet_.body), center_of(world, magnet_.to)};
    const double step_s = world.options().step_s;
    step_s_ = step_s;
    softening_ = 1.0 + step_s * step_s * steepest * magnet_.max_force_n / magnet_.range_m * inverse_mass;
    return std::nullopt;
  }
  [[nodiscard]] std::vector<std::string> warnings(const EffectSet&) const override {
    if (softening_ <= bearable) return {};
    return {
        fmt::format("attraction: with steps of {:.3g} ms the magnet of {:.3g} N between {} is {:.3g} N strong at most, "
                    "for more would "
                    "tremble on so little mass: give a greater 'range_m', a smaller 'max_force_n', or a higher rate_hz",
                    1e3 * step_s_, magnet_.max_force_n, magnet_.names, magnet_.max_force_n / softening_)};
  }
  std::uint32_t before_step(const TickView& tick) noexcept override {
    const Vec3 away =
        tick.world->state(magnet_.to).pose * centers_[1] - tick.world->state(magnet_.body).pose * centers_[0];
    const Vec3 x = away / magnet_.range_m;
    const double fade = 1.0 + x.squaredNorm();
    const Vec3 force = steepest * magnet_.max_force_n / (fade * fade * softening_) * x;
    tick.world->apply(magnet_.body, {force, Vec3::Zero()});
    tick.world->apply(magnet_.to, {-force, Vec3::Zero()});
    return 1;
  }

 private:
  static constexpr double bearable = 1.05;  // of the softening: a change that nobody feels
  static constexpr double steepest =
      3.0792014356780042;  // 16 / (3 sqrt(3)): the greatest value of x / (1 + x^2)^2, inverted
  // In the mesh's frame. A fixed body has no mass: the middle of its bounding box.
  static Vec3 center_of(const ode::World& world, ode::BodyId body) noexcept {
    const mesh::TriangleMesh& mesh = world.shape(body)->mesh();
    return world.is_dynamic(body) ? world.mass(body).center_m : Vec3(0.5 * (mesh.lower() + mesh.upper()));
  }
  Magnet magnet_;
  std::array<Vec3, 2> centers_ = {Vec3::Zero(), Vec3::Zero()};  // of the body and of what draws it
  double softening_ = 1.0;
  double step_s_ = 0.0;
};

}  // namespace

Result<std::unique_ptr<Effect>> make_attraction(const EffectRequest& request) {
  SettingsReader reader(*request.settings);
  Magnet magnet;
  read_body(reader, "body", request.bodies, true, magnet.body);
  read_body(reader, "to", request.bodies, false, magnet.to);
  if (magnet.body.index < request.bodies.size() && magnet.to.index < request.bodies.size()) {
    magnet.names =
        fmt::format("'{}' and '{}'", request.bodies[magnet.body.index].name, request.bodies[magnet.to.index].name);
  }
  reader.require("max_force_n");
  reader.require("range_m");
  reader.number("max_force_n", Range::positive(), magnet.max_force_n);
  reader.number("range_m", {1e-6, 1e3}, magnet.range_m);
  if (reader.has("to") && reader.has("body") && magnet.body == magnet.to) {
    reader.reject("to", "a body cannot attract itself", "name another body");
  }
  if (auto error = reader.finish()) return *error;
  return std::unique_ptr<Effect>(std::make_unique<Attraction>(magnet));
}

}  // namespace odds::haptics::effects
