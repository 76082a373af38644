#include "ode/budget_clock.hpp"

namespace odds::ode {
namespace {

realtime::Clock chosen;

}  // namespace

void use_budget_clock(realtime::Clock clock) noexcept { chosen = clock; }

realtime::Clock budget_clock() noexcept { return chosen.now_ns != nullptr ? chosen : realtime::fastest_clock(); }

}  // namespace odds::ode
