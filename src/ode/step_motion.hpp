// How far bodies have moved in the step that has led to the collision under way: set by a world for its own thread.
#pragma once

#include <cstdint>

#include "odds/math/pose.hpp"
#include "ode/geom_data.hpp"

namespace odds::ode {

/// One call of a space's broad phase that asks for all pairs that are near, and the step before it.
struct StepMotion {
  std::uint64_t number = 0;  ///< counts these calls
  double step_s = 0.0;       ///< by which bodies have come to where they are with the velocities that they have
};

/// The calling thread's; null where not all pairs that are near are asked for, or nobody says when.
inline thread_local const StepMotion* current_step = nullptr;

/// Where a geom stood before the step, by its body's velocities (ODE's integrator is semi-implicit); as it is if it has
/// no body.
[[nodiscard]] math::Pose before_step(dGeomID geom, const math::Pose& pose, double step_s) noexcept;

}  // namespace odds::ode
