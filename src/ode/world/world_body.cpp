// ODE's bodies have their origin at the centre of mass, meshes theirs where they please.
#include "ode/world/world_body.hpp"

#include "ode/vectors.hpp"

namespace odds::ode {

BodyState state_of(const Body& body) noexcept {
  if (body.body == nullptr) return body.last_good;
  BodyState state;
  state.pose.rotation = matrix_of(dBodyGetRotation(body.body));
  state.pose.translation = vector_of(dBodyGetPosition(body.body)) - state.pose.rotation * body.mass.center_m;
  state.velocity_m_per_s = vector_of(dBodyGetLinearVel(body.body));
  state.angular_velocity_rad_per_s = vector_of(dBodyGetAngularVel(body.body));
  return state;
}

void leave_fluids(Body& body) noexcept {
  body.fluids = {};
  body.of_fluids = {};
}

void place(Body& body, const BodyState& state) noexcept {
  dMatrix3 rotation;
  to_ode(state.pose.rotation, rotation);
  const Vec3& p = state.pose.translation;
  body.last_good = state;
  if (body.body == nullptr) {
    dGeomSetRotation(body.geom.id(), rotation);
    dGeomSetPosition(body.geom.id(), p.x(), p.y(), p.z());
    return;
  }
  const Vec3 center = state.pose * body.mass.center_m;
  const Vec3& v = state.velocity_m_per_s;
  const Vec3& w = state.angular_velocity_rad_per_s;
  dBodySetRotation(body.body, rotation);
  dBodySetPosition(body.body, center.x(), center.y(), center.z());
  dBodySetLinearVel(body.body, v.x(), v.y(), v.z());
  dBodySetAngularVel(body.body, w.x(), w.y(), w.z());
  dBodySetForce(body.body, 0.0, 0.0, 0.0);
  dBodySetTorque(body.body, 0.0, 0.0, 0.0);
  leave_fluids(body);
}

}  // namespace odds::ode
