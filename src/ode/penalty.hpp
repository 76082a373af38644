// Contacts as forces of the step's beginning: the penalty law of haptic renderers.
#pragma once

#include <ode/ode.h>

#include "odds/ode/meeting.hpp"
#include "odds/ode/world.hpp"

namespace odds::ode {

/// One of `count` points of a pair, as a row of the solver that yields so much that its force is what spring and damper
/// give by depth and velocity of now, to a millionth; the solver then bounds friction by it. The damper does not turn
/// an approach round within the step, and the force brings bodies apart no faster than
/// `max_correcting_velocity_m_per_s`, both by the mass that the point feels. Null bodies stand still; one of the two
/// moves. The world's greatest correcting velocity must be infinite.
[[nodiscard]] dContact penalty_rows(const ContactPoint& point, const dContactGeom& found, std::size_t count, dBodyID a,
                                    dBodyID b, double step_s, double max_correcting_velocity_m_per_s) noexcept;

}  // namespace odds::ode
