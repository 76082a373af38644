// The drag of the fluids about a body in one step.
#pragma once

#include "odds/ode/world.hpp"

namespace odds::ode {

/// Fluids add up before their decay over the step is taken: of each by itself, two strong ones would turn a speed
/// round, and three would have it grow.
class Fluids {
 public:
  void add(const Drag& drag) noexcept;
  /// Force and torque that, held over the step, leave the speeds that the fluids would. `inertia`: the least of the
  /// body's moments.
  [[nodiscard]] Wrench over_one_step(const BodyState& state, double mass_kg, double inertia_kg_m2,
                                     double step_s) const noexcept;

 private:
  double force_ns_per_m_ = 0.0;
  double torque_nms_per_rad_ = 0.0;
  Vec3 at_rest_n_ = Vec3::Zero();  // what the flows exert on a body at rest
};

}  // namespace odds::ode
