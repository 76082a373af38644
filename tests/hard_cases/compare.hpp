// Forces of a run beside those of the exact one.
#pragma once

#include "hard_cases/run_case.hpp"

namespace odds::hard_cases {

/// Fills in errors, onset and noise of `figures` where both runs have the same ticks. Noise: RMS of the second
/// difference of the force from tick to tick over the square root of 6, which is that of white noise and passes what is
/// faster than about a sixth of the rate, less the exact run's; as a share of the mean force.
void compare(const Figures& exact, double touching_n, Figures& figures);

}  // namespace odds::hard_cases
