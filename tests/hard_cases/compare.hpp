// Forces of a run beside those of the exact one.
#pragma once

#include "hard_cases/run_case.hpp"

namespace odds::hard_cases {

inline constexpr double rate_hz = 1000.0;  ///< of every case

/// Fills in errors, onset and noise of `figures` where both runs have the same ticks (report::compare_forces).
void compare(const Figures& exact, double touching_n, Figures& figures);

}  // namespace odds::hard_cases
