// What the query of a pair said, for the meeting that it led to and for the step.
#pragma once

#include <ode/ode.h>

#include "odds/ode/meeting.hpp"
#include "odds/ode/world.hpp"

namespace odds::ode {

/// Adds the pair's last answer to the summary of the step, and writes it into the meeting; nothing where the pair has
/// none.
void note_answer(dGeomID a, dGeomID b, Meeting& meeting, StepSummary& summary) noexcept;

}  // namespace odds::ode
