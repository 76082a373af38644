// Spring and damper, explicitly, with bounds that keep the damper from adding energy. As rows with bounds of their own,
// beside forces on the bodies, friction would depend on itself where contacts lie in a plane: ODE's solver gives up
// then.
#include "ode/penalty.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "ode/contact_rows.hpp"
#include "ode/vectors.hpp"

namespace odds::ode {
namespace {

/// How readily a body gives way at a point, 1/kg.
double inverse_mass_at(dBodyID body, const Vec3& position, const Vec3& direction) noexcept {
  if (body == nullptr) return 0.0;
  dMass mass;
  dBodyGetMass(body, &mass);
  const Mat3 rotation = matrix_of(dBodyGetRotation(body));
  const Vec3 turn = rotation.transpose() * (position - vector_of(dBodyGetPosition(body))).cross(direction);
  return 1.0 / mass.mass + turn.dot(matrix_of(mass.I).inverse() * turn);
}

/// Along the normal, on a, N, >= 0. `speed_per_force`: of a step, m/s per N.
double force_of(const ContactPoint& point, std::size_t count, double speed_per_force, double step_s,
                double max_correcting_velocity_m_per_s) noexcept {
  const Surface& surface = point.surface;
  const double apart = point.velocity_m_per_s.dot(point.normal);
  // The points of a pair share its mass as they share its stiffness.
  const double force_per_speed = 1.0 / (speed_per_force * static_cast<double>(count));
  const double spring = surface.pushes ? surface.stiffness_n_per_m * std::max(0.0, point.depth_m) : 0.0;
  // Where the spring is silent it still stops an approach, as its row of the solver would.
  const double damping = surface.damping_ns_per_m + (surface.pushes ? 0.0 : step_s * surface.stiffness_n_per_m);
  const double damper = -apart * std::min(damping, force_per_speed);
  return std::clamp(spring + damper, 0.0, force_per_speed * std::max(0.0, max_correcting_velocity_m_per_s - apart));
}

}  // namespace

dContact penalty_rows(const ContactPoint& point, const dContactGeom& found, std::size_t count, dBodyID a, dBodyID b,
                      double step_s, double max_correcting_velocity_m_per_s) noexcept {
  constexpr double softness = 1e6;  // of the row, in terms of the mass that it moves
  const double speed_per_force = step_s * (inverse_mass_at(a, point.position_m, point.normal) +
                                           inverse_mass_at(b, point.position_m, point.normal));
  const double force = force_of(point, count, speed_per_force, step_s, max_correcting_velocity_m_per_s);
  dContact contact = contact_rows(point, found, step_s);
  contact.surface.mode |= dContactMotionN;
  contact.surface.soft_erp = 0.0;
  contact.surface.soft_cfm = softness * speed_per_force;
  contact.surface.motionN = force * contact.surface.soft_cfm;
  return contact;
}

}  // namespace odds::ode
