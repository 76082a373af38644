// Sums of drags, and the exact decay over a step.
#include "ode/world/fluids.hpp"

#include <cmath>

namespace odds::ode {
namespace {

// The coefficient whose explicit force has the effect of the exact decay over one step: it never turns a speed round.
double coefficient(double drag, double inertia, double step_s) noexcept {
  return -inertia * std::expm1(-drag * step_s / inertia) / step_s;
}

}  // namespace

void Fluids::add(const Drag& drag) noexcept {
  force_ns_per_m_ += drag.force_ns_per_m;
  torque_nms_per_rad_ += drag.torque_nms_per_rad;
  at_rest_n_ += drag.force_ns_per_m * drag.flow_m_per_s;
}

Wrench Fluids::over_one_step(const BodyState& state, double mass_kg, double inertia_kg_m2,
                             double step_s) const noexcept {
  Wrench wrench;
  if (force_ns_per_m_ > 0.0) {
    const Vec3 flow_m_per_s = at_rest_n_ / force_ns_per_m_;
    wrench.force_n = coefficient(force_ns_per_m_, mass_kg, step_s) * (flow_m_per_s - state.velocity_m_per_s);
  }
  wrench.torque_nm = -coefficient(torque_nms_per_rad_, inertia_kg_m2, step_s) * state.angular_velocity_rad_per_s;
  return wrench;
}

}  // namespace odds::ode
