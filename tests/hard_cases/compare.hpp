// Forces of a run beside those of the exact one.
#pragma once

#include <cstddef>
#include <vector>

#include "hard_cases/run_case.hpp"

namespace odds::hard_cases {

inline constexpr double rate_hz = 1000.0;  ///< of every case

/// Fills in errors, onset and noise of `figures` where both runs have the same ticks (report::compare_forces).
void compare(const Figures& exact, double touching_n, Figures& figures);

/// Of the run with that index of all cases together, each on its own: every tick in which a case's exact run touches
/// counts once. Errors and angles only.
[[nodiscard]] report::ForceDifference of_all_ticks(const std::vector<Outcome>& outcomes, std::size_t run);

}  // namespace odds::hard_cases
