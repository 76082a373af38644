// Sums of drags, and the exact decay over a step.
#include "ode/world/fluids.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace odds::ode {
namespace {

// The coefficient whose explicit force has the effect of the exact decay over one step: it never turns a speed round.
double coefficient(double drag, double inertia, double step_s) noexcept {
  return -inertia * std::expm1(-drag * step_s / inertia) / step_s;
}

}  // namespace

PrincipalAxes principal_axes(const Mat3& inertia_kg_m2) {
  const Eigen::SelfAdjointEigenSolver<Mat3> found(inertia_kg_m2);
  return {found.eigenvectors(), found.eigenvalues()};
}

void Fluids::add(const Drag& drag) noexcept {
  force_ns_per_m_ += drag.force_ns_per_m;
  torque_nms_per_rad_ += drag.torque_nms_per_rad;
  at_rest_n_ += drag.force_ns_per_m * drag.flow_m_per_s;
}

Wrench Fluids::over_one_step(const BodyState& state, double mass_kg, const PrincipalAxes& principal,
                             double step_s) const noexcept {
  Wrench wrench;
  if (force_ns_per_m_ > 0.0) {
    const Vec3 flow_m_per_s = at_rest_n_ / force_ns_per_m_;
    wrench.force_n = coefficient(force_ns_per_m_, mass_kg, step_s) * (flow_m_per_s - state.velocity_m_per_s);
  }
  if (torque_nms_per_rad_ > 0.0) {
    const Mat3 axes = state.pose.rotation * principal.axes;
    Vec3 about = axes.transpose() * state.angular_velocity_rad_per_s;
    for (int i = 0; i < 3; ++i) about[i] *= -coefficient(torque_nms_per_rad_, principal.moments_kg_m2[i], step_s);
    wrench.torque_nm = axes * about;
  }
  return wrench;
}

}  // namespace odds::ode
