// Momentum before, momentum after, and what else acted in between.
#include "ode/world/contact_work.hpp"

#include "ode/vectors.hpp"

namespace odds::ode {
namespace {

Vec3 angular_momentum(dBodyID body, const MassProperties& mass) noexcept {
  const Mat3 r = matrix_of(dBodyGetRotation(body));
  return r * (mass.inertia_kg_m2 * (r.transpose() * vector_of(dBodyGetAngularVel(body))));
}

}  // namespace

Momentum momentum_without_contacts(dBodyID body, const MassProperties& mass, const Vec3& gravity_m_per_s2,
                                   double step_s) noexcept {
  Momentum m;
  m.velocity_m_per_s = vector_of(dBodyGetLinearVel(body));
  m.spin_rad_per_s = vector_of(dBodyGetAngularVel(body));
  const Vec3 force = vector_of(dBodyGetForce(body)) + mass.mass_kg * gravity_m_per_s2;
  m.linear_ns = mass.mass_kg * m.velocity_m_per_s + step_s * force;
  m.angular_nms = angular_momentum(body, mass) + step_s * vector_of(dBodyGetTorque(body));
  return m;
}

ContactEffect effect_of_contacts(const Momentum& before, dBodyID body, const MassProperties& mass, const Wrench& pull,
                                 double step_s) noexcept {
  const Vec3 velocity = vector_of(dBodyGetLinearVel(body));
  const Vec3 spin = vector_of(dBodyGetAngularVel(body));
  const Vec3 impulse = mass.mass_kg * velocity - before.linear_ns - step_s * pull.force_n;
  const Vec3 turn = angular_momentum(body, mass) - before.angular_nms - step_s * pull.torque_nm;
  return {impulse,
          0.5 * impulse.dot(velocity + before.velocity_m_per_s) + 0.5 * turn.dot(spin + before.spin_rad_per_s)};
}

}  // namespace odds::ode
