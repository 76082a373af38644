// A point of contact as rows of ODE's solver.
#pragma once

#include <ode/ode.h>

#include "odds/ode/meeting.hpp"
#include "odds/ode/world.hpp"

namespace odds::ode {

/// The stiffness and damping of a pair by the model's law. A constraint is the spring and damper that takes
/// error_reduction of the overlap away in a step, and yields by a millionth of what the pair's reduced mass would. Null
/// bodies stand still.
[[nodiscard]] ContactModel of_pair(const ContactModel& model, double step_s, dBodyID a, dBodyID b) noexcept;

/// One of `count` points of a pair, with its share of the pair's stiffness and damping. `velocity`: whether to compute
/// that too. Null bodies stand still.
[[nodiscard]] ContactPoint contact_point(const dContactGeom& found, int count, const ContactModel& pair, bool velocity,
                                         dBodyID a, dBodyID b) noexcept;

/// False if a number is not finite or nothing would push: such a point must not reach the solver.
[[nodiscard]] bool can_be_solved(const ContactPoint& point) noexcept;

/// How fast the point's overlap may be pushed apart where the law's own contacts may be by `most_m_per_s`, m/s. More
/// for a point that an effect has made softer: at the velocity of now both push alike, so that neither leaves faster.
[[nodiscard]] double greatest_correction(const ContactPoint& point, double step_s, double most_m_per_s) noexcept;

/// What ODE is told. With step h the row of the normal is v + lambda / (h k + b) = h k / (h k + b) depth / h: the
/// backward Euler step of a spring and damper, stable for every stiffness and damping. The right side is held to the
/// greatest correction; the world's own greatest correcting velocity must be infinite.
[[nodiscard]] dContact contact_rows(const ContactPoint& point, const dContactGeom& found, double step_s,
                                    double max_correcting_velocity_m_per_s) noexcept;

}  // namespace odds::ode
