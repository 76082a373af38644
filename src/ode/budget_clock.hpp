// The clock that budgets are measured by.
#pragma once

#include "odds/realtime/clock.hpp"

namespace odds::ode {

/// Of collisions and of frames; null (default): the processor's. With one that moves by as much at every look, starved
/// scenes have the same contacts on every run and machine. Set it before the first collision; it must outlive the last.
void use_budget_clock(realtime::Clock clock) noexcept;

/// Never null.
[[nodiscard]] realtime::Clock budget_clock() noexcept;

}  // namespace odds::ode
