// What contacts do to a body's kinetic energy, measured from momenta.
#pragma once

#include <ode/ode.h>

#include "odds/ode/world.hpp"

namespace odds::ode {

/// Of one body before a step.
struct Momentum {
  Vec3 velocity_m_per_s = Vec3::Zero();
  Vec3 spin_rad_per_s = Vec3::Zero();
  Vec3 linear_ns = Vec3::Zero();    ///< that the body would have after the step without contacts and coupling
  Vec3 angular_nms = Vec3::Zero();  ///< likewise, about the centre of mass
};

/// Call it when all forces of the step are known to the body.
[[nodiscard]] Momentum momentum_without_contacts(dBodyID body, const MassProperties& mass, const Vec3& gravity_m_per_s2,
                                                 double step_s) noexcept;

/// What contacts did to one body in a step.
struct ContactEffect {
  Vec3 impulse_ns = Vec3::Zero();  ///< world frame
  double work_j = 0.0;             ///< change of kinetic energy
};

/// After the step. `pull`: what the coupling exerted. An impulse times the mean of the velocities before and after it
/// is the change of kinetic energy exactly.
[[nodiscard]] ContactEffect effect_of_contacts(const Momentum& before, dBodyID body, const MassProperties& mass,
                                               const Wrench& pull, double step_s) noexcept;

}  // namespace odds::ode
