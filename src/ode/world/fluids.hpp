// The drag of the fluids about a body in one step.
#pragma once

#include "odds/ode/world.hpp"

namespace odds::ode {

/// How hardly a body turns, about which axes of its mesh's frame.
struct PrincipalAxes {
  Mat3 axes = Mat3::Identity();  ///< columns
  Vec3 moments_kg_m2 = Vec3::Ones();
};
[[nodiscard]] PrincipalAxes principal_axes(const Mat3& inertia_kg_m2);

/// Fluids add up before their decay over the step is taken: of each by itself, two strong ones would turn a speed
/// round, and three would have it grow.
class Fluids {
 public:
  void add(const Drag& drag) noexcept;
  /// Force and torque that, held over the step, leave the speeds that the fluids would.
  [[nodiscard]] Wrench over_one_step(const BodyState& state, double mass_kg, const PrincipalAxes& principal,
                                     double step_s) const noexcept;

 private:
  double force_ns_per_m_ = 0.0;
  double torque_nms_per_rad_ = 0.0;
  Vec3 at_rest_n_ = Vec3::Zero();  // what the flows exert on a body at rest
};

}  // namespace odds::ode
