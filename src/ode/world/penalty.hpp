// Contacts as forces of the step's beginning: the penalty law of haptic renderers.
#pragma once

#include <ode/ode.h>

#include "odds/ode/meeting.hpp"
#include "odds/ode/world.hpp"

namespace odds::ode {

/// A point of contact as a row of the solver: a spring, whose force is that of the depth of now, and a damper, which
/// the solver solves with everything else, so that it takes energy away however many pairs a body is in. Friction is
/// bounded by their sum. Where the row of a compliant contact, held to `max_correcting_velocity_m_per_s`, pushes less
/// at the velocity of now, it is that one. Without damping the row yields to its force to a millionth. Null bodies
/// stand still; one of the two moves. The world's greatest correcting velocity must be infinite.
[[nodiscard]] dContact penalty_rows(const ContactPoint& point, const dContactGeom& found, dBodyID a, dBodyID b,
                                    double step_s, double max_correcting_velocity_m_per_s) noexcept;

}  // namespace odds::ode
