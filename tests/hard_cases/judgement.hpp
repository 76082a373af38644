// Two questions about each run: was it safe, and did it feel as without a budget?
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "hard_cases/run_case.hpp"

namespace odds::hard_cases {

/// Fills in what did not hold: Figures::harmful, missed and off.
void judge(const HardCase& hard_case, Figures& figures);

/// Whether a run on its own stays within 7 % and 18 degrees of the exact one, or has no such figures.
[[nodiscard]] bool stays_near(const Figures& figures);

/// Whether a run has forces to compare with those of the exact one.
[[nodiscard]] bool compared(const Figures& figures);

/// How many runs with one budget are safe, and how many of those with forces to compare feel as without a budget.
struct Tally {
  std::string budget;
  std::size_t runs = 0;
  std::size_t harmless = 0;  ///< numbers, forces and energy within bounds
  std::size_t safe = 0;      ///< and nothing deep missed
  std::size_t compared = 0;
  std::size_t feels_right = 0;
  // Of the hand, each run on its own; where runs part for good a small difference early makes a great one later.
  std::size_t runs_compared = 0;
  std::size_t runs_near = 0;  ///< within 7 % and 18 degrees at the 95th percentile of their ticks
  report::ForceDifference all_ticks = {};
  [[nodiscard]] bool all_ticks_near() const;
};
/// One for each budget, in the order of the runs.
[[nodiscard]] std::vector<Tally> tally(const std::vector<Outcome>& outcomes);

}  // namespace odds::hard_cases
