// A spring and damper to a moving target, as six rows of ODE's constraint solver.
#pragma once

#include <ode/ode.h>

#include "odds/ode/world.hpp"

namespace odds::ode {

/// Two motors, one linear and one angular, whose softness makes them an implicit spring and damper: with step h the row
/// v + CFM lambda = c, CFM = 1 / (h k + b), c = (k e + b v_target) / (h k + b) is lambda = k (e - h v) + b (v_target -
/// v), the backward Euler step. A spring at its limit L has k = L / |e|. Owned by the world (destroyed with it). Must
/// not move: ODE writes its feedback here.
class CouplingJoint {
 public:
  CouplingJoint(dWorldID world, dBodyID body);
  CouplingJoint(const CouplingJoint&) = delete;
  CouplingJoint& operator=(const CouplingJoint&) = delete;

  /// Of the next steps. What is not finite switches the coupling off until the next call.
  void set(const Coupling& coupling) noexcept { coupling_ = coupling; }
  /// Before each step: its rows, from where the body is. `center_m`: of mass, in the body's mesh frame.
  void begin_step(const Vec3& center_m, double step_s) noexcept;
  /// ODE writes nothing where the coupling is off.
  void forget_wrench() noexcept;
  /// On the body, in the last step.
  [[nodiscard]] Wrench wrench() const noexcept;

 private:
  dBodyID body_;
  Coupling coupling_;  // without stiffness and damping: off
  dJointID linear_;
  dJointID angular_;
  dJointFeedback linear_feedback_{};
  dJointFeedback angular_feedback_{};
};

}  // namespace odds::ode
