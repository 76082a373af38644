// Softness, friction, rolling and bounce of a contact joint.
#include "ode/world/contact_rows.hpp"

#include <algorithm>
#include <cmath>

#include "ode/vectors.hpp"

namespace odds::ode {
namespace {

// Slip slower than this is sticking: its direction is noise and says nothing about the direction of friction.
constexpr double least_slip_m_per_s = 1e-3;

// One axis of the friction pyramid along the slip makes it a cone where it counts.
void add_friction(const ContactPoint& point, dContact& contact) {
  const Vec3& belt = point.surface.surface_velocity;
  contact.surface.mode |= dContactApprox1;
  contact.surface.mu = point.surface.friction;
  Vec3 slip = point.velocity_m_per_s - belt;
  slip -= slip.dot(point.normal) * point.normal;
  const double speed = slip.norm();
  const bool slides = speed > least_slip_m_per_s;
  const bool carried = belt.squaredNorm() > 0.0;
  if (!slides && !carried) return;
  const Vec3 first = slides ? Vec3(slip / speed) : Vec3(point.normal.unitOrthogonal());
  contact.surface.mode |= dContactFDir1;
  Eigen::Map<Vec3>(contact.fdir1) = first;
  if (!carried) return;
  contact.surface.mode |= dContactMotion1 | dContactMotion2;
  contact.surface.motion1 = belt.dot(first);
  contact.surface.motion2 = belt.dot(point.normal.cross(first));  // ODE's second direction
}

}  // namespace

ContactModel of_pair(const ContactModel& model, double step_s, dBodyID a, dBodyID b) noexcept {
  ContactModel pair = model;
  if (model.law != ContactLaw::constraint) return pair;
  constexpr double yielding = 1e-6;  // less, and the rows of many contacts of a pair depend on each other
  double inverse_mass = 0.0;
  for (const dBodyID body : {a, b}) {
    if (body == nullptr) continue;
    dMass mass;
    dBodyGetMass(body, &mass);
    inverse_mass += 1.0 / mass.mass;
  }
  const double weight = 1.0 / (yielding * step_s * inverse_mass);
  pair.stiffness_n_per_m = model.error_reduction * weight / step_s;
  pair.damping_ns_per_m = (1.0 - model.error_reduction) * weight;
  return pair;
}

ContactPoint contact_point(const dContactGeom& found, int count, const ContactModel& pair, bool velocity, dBodyID a,
                           dBodyID b) noexcept {
  ContactPoint point;
  point.position_m = vector_of(found.pos);
  point.normal = vector_of(found.normal);
  point.depth_m = found.depth;
  // The contacts of a pair are springs side by side: each takes its share, so that the pair is as stiff as asked.
  point.surface.stiffness_n_per_m = pair.stiffness_n_per_m / count;
  point.surface.damping_ns_per_m = pair.damping_ns_per_m / count;
  point.surface.friction = pair.friction;
  if (!velocity) return point;
  dVector3 at_point;
  if (a != nullptr) {
    dBodyGetPointVel(a, found.pos[0], found.pos[1], found.pos[2], at_point);
    point.velocity_m_per_s += vector_of(at_point);
  }
  if (b != nullptr) {
    dBodyGetPointVel(b, found.pos[0], found.pos[1], found.pos[2], at_point);
    point.velocity_m_per_s -= vector_of(at_point);
  }
  return point;
}

bool can_be_solved(const ContactPoint& p) noexcept {
  const Surface& s = p.surface;
  return p.position_m.allFinite() && p.normal.allFinite() && std::isfinite(p.depth_m) &&
         std::isfinite(s.stiffness_n_per_m + s.damping_ns_per_m + s.friction + s.rolling_m + s.spinning_m +
                       s.restitution + s.restitution_from_m_per_s) &&
         s.surface_velocity.allFinite() && s.stiffness_n_per_m + s.damping_ns_per_m > 0.0;
}

double greatest_correction(const ContactPoint& point, double step_s, double most_m_per_s) noexcept {
  const Surface& surface = point.surface;
  const double weight = step_s * surface.stiffness_n_per_m + surface.damping_ns_per_m;
  const double apart = point.velocity_m_per_s.dot(point.normal);
  if (!(surface.weight_of_law_ns_per_m > weight) || !(apart < most_m_per_s)) return most_m_per_s;
  return apart + surface.weight_of_law_ns_per_m / weight * (most_m_per_s - apart);
}

dContact contact_rows(const ContactPoint& point, const dContactGeom& found, double step_s,
                      double max_correcting_velocity_m_per_s) noexcept {
  const Surface& surface = point.surface;
  const double weight = step_s * surface.stiffness_n_per_m + surface.damping_ns_per_m;
  dContact contact{};
  contact.geom = found;
  Eigen::Map<Vec3>(contact.geom.pos) = point.position_m;
  Eigen::Map<Vec3>(contact.geom.normal) = point.normal;
  // Not by ODE's own bound, which knows one for all points: the spring is stretched no farther.
  const double stretched = greatest_correction(point, step_s, max_correcting_velocity_m_per_s) * weight;
  contact.geom.depth = std::clamp(point.depth_m, 0.0, stretched / surface.stiffness_n_per_m);
  contact.surface.mode = dContactSoftERP | dContactSoftCFM;
  contact.surface.soft_erp = surface.pushes ? step_s * surface.stiffness_n_per_m / weight : 0.0;
  contact.surface.soft_cfm = 1.0 / weight;
  if (surface.restitution > 0.0) {
    contact.surface.mode |= dContactBounce;
    contact.surface.bounce = surface.restitution;
    contact.surface.bounce_vel = surface.restitution_from_m_per_s;
  }
  if (surface.friction > 0.0) add_friction(point, contact);
  if (surface.rolling_m > 0.0 || surface.spinning_m > 0.0) {
    contact.surface.mode |= dContactApprox1 | dContactRolling | dContactAxisDep;
    contact.surface.mu2 = contact.surface.mu;
    contact.surface.rho = surface.rolling_m;
    contact.surface.rho2 = surface.rolling_m;
    contact.surface.rhoN = surface.spinning_m;
  }
  return contact;
}

}  // namespace odds::ode
