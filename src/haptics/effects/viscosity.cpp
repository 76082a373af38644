// A fluid that drags bodies along, everywhere or in a box.
#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <vector>

#include "haptics/effects/list.hpp"

namespace odds::haptics::effects {
namespace {

struct Fluid {
  double drag_ns_per_m = 0.0;
  double angular_drag_nms_per_rad = 0.0;
  Vec3 flow_m_per_s = Vec3::Zero();
  Vec3 lower_m = Vec3::Constant(-std::numeric_limits<double>::infinity());
  Vec3 upper_m = Vec3::Constant(std::numeric_limits<double>::infinity());
};

// The coefficient whose explicit force has the effect of the exact decay over one step: it never turns a speed round.
double over_one_step(double drag, double inertia, double step_s) noexcept {
  return -inertia * std::expm1(-drag * step_s / inertia) / step_s;
}

class Viscosity final : public Effect {
 public:
  explicit Viscosity(const Fluid& fluid) : fluid_(fluid) {}
  [[nodiscard]] std::uint32_t needs() const noexcept override { return need_motion; }
  [[nodiscard]] std::uint32_t stages() const noexcept override { return stage_before_step; }
  [[nodiscard]] std::string_view evaluates() const noexcept override { return "bodies"; }
  [[nodiscard]] bool repeatable() const noexcept override { return true; }
  [[nodiscard]] std::optional<Error> bind(const ode::World& world) override {
    moving_.clear();
    for (std::uint32_t i = 0; i < world.body_count(); ++i) {
      if (!world.is_dynamic({i})) continue;
      const Eigen::SelfAdjointEigenSolver<Mat3> axes(world.mass({i}).inertia_kg_m2);
      moving_.push_back({{i}, axes.eigenvalues().minCoeff()});
    }
    return std::nullopt;
  }
  std::uint32_t before_step(const TickView& tick) noexcept override {
    std::uint32_t count = 0;
    for (const Moving& moving : moving_) {
      const ode::BodyState state = tick.world->state(moving.body);
      const ode::MassProperties& mass = tick.world->mass(moving.body);
      const Vec3 center = state.pose * mass.center_m;
      if ((center.array() < fluid_.lower_m.array()).any() || (center.array() > fluid_.upper_m.array()).any()) continue;
      const double drag = over_one_step(fluid_.drag_ns_per_m, mass.mass_kg, tick.step_s);
      const double turn = over_one_step(fluid_.angular_drag_nms_per_rad, moving.least_inertia_kg_m2, tick.step_s);
      tick.world->apply(moving.body, {drag * (fluid_.flow_m_per_s - state.velocity_m_per_s),
                                      -turn * state.angular_velocity_rad_per_s});
      ++count;
    }
    return count;
  }

 private:
  struct Moving {
    ode::BodyId body;
    double least_inertia_kg_m2 = 0.0;
  };
  Fluid fluid_;
  std::vector<Moving> moving_;
};

}  // namespace

Result<std::unique_ptr<Effect>> make_viscosity(const EffectRequest& request) {
  SettingsReader reader(*request.settings);
  Fluid fluid;
  reader.require("drag_ns_per_m");
  reader.number("drag_ns_per_m", Range::not_negative(), fluid.drag_ns_per_m);
  reader.number("angular_drag_nms_per_rad", Range::not_negative(), fluid.angular_drag_nms_per_rad);
  reader.vector("flow_m_per_s", fluid.flow_m_per_s);
  reader.vector("lower_m", fluid.lower_m);
  reader.vector("upper_m", fluid.upper_m);
  if (reader.has("upper_m") && (fluid.lower_m.array() >= fluid.upper_m.array()).any()) {
    reader.reject("upper_m", "the box of the fluid is empty", "let every number be greater than that of 'lower_m'");
  }
  if (auto error = reader.finish()) return *error;
  return std::unique_ptr<Effect>(std::make_unique<Viscosity>(fluid));
}

}  // namespace odds::haptics::effects
