// The spring explicitly, the damper by the solver: of a body in many pairs an explicit damper would act many times. The
// spring's force is told as the speed at which its row would be at rest. As a force on the bodies, beside rows with
// bounds of their own, friction would depend on itself where contacts lie in a plane: ODE's solver gives up then.
#include "ode/world/penalty.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "ode/vectors.hpp"
#include "ode/world/contact_rows.hpp"

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

}  // namespace

dContact penalty_rows(const ContactPoint& point, const dContactGeom& found, dBodyID a, dBodyID b, double step_s,
                      double max_correcting_velocity_m_per_s) noexcept {
  constexpr double softness = 1e6;  // of the row of a spring alone, in terms of the mass that it moves
  const Surface& surface = point.surface;
  const double speed_per_force = step_s * (inverse_mass_at(a, point.position_m, point.normal) +
                                           inverse_mass_at(b, point.position_m, point.normal));
  const double spring_n = surface.stiffness_n_per_m * std::max(0.0, point.depth_m);
  const double lag = step_s * surface.stiffness_n_per_m;  // by so much a compliant row is damped more
  const double apart = point.velocity_m_per_s.dot(point.normal);
  const double correction = greatest_correction(point, step_s, max_correcting_velocity_m_per_s);
  const bool deep = spring_n > (lag + surface.damping_ns_per_m) * correction - lag * apart;
  // Where it is too deep, or the spring is silent, the row is that of a compliant contact.
  double weight = lag + surface.damping_ns_per_m;
  double at_rest = surface.pushes ? correction : 0.0;  // m/s
  if (surface.pushes && !deep) {
    weight = std::max(surface.damping_ns_per_m, 1.0 / (softness * speed_per_force));
    at_rest = spring_n / weight;
  }
  dContact contact = contact_rows(point, found, step_s, max_correcting_velocity_m_per_s);
  contact.surface.mode |= dContactMotionN;
  if (surface.pushes) contact.surface.mode &= ~dContactBounce;  // it would take the spring's speed for an approach
  contact.surface.soft_erp = 0.0;
  contact.surface.soft_cfm = 1.0 / weight;
  contact.surface.motionN = at_rest;
  return contact;
}

}  // namespace odds::ode
