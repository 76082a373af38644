// Whether this machine, right now, is quiet enough to judge times on.
#pragma once

#include <cstdint>
#include <string>

#include "odds/realtime/clock.hpp"
#include "odds/realtime/stall_ledger.hpp"

namespace odds::realtime {

/// When a machine counts as unfit.
struct FitnessLimits {
  std::int64_t probe_ns = 200'000'000;                            ///< how long to watch
  std::int64_t threshold_ns = StallLedger::default_threshold_ns;  ///< a longer gap between two readings is a stall
  double largest_stall_share = 0.02;                              ///< of the probe's time
  std::int64_t longest_gap_ns = 2'000'000;                        ///< two periods of a 1 kHz loop
};

/// What the probe saw.
struct Fitness {
  bool fit = false;
  double stall_share = 0.0;  ///< in [0, 1]
  std::int64_t longest_gap_ns = 0;
  std::uint32_t stalls = 0;
  std::uint64_t involuntary_switches = 0;  ///< of this thread: other programs wanted the processor
  std::string reason;                      ///< one sentence with the figures
};

/// Reads the clock in a tight loop for `limits.probe_ns` and sums the gaps in which the thread did not run. A verdict
/// on times that was reached on an unfit machine should be "inconclusive", never "passed" or "failed".
[[nodiscard]] Fitness probe_fitness(const FitnessLimits& limits = {}, Clock clock = fastest_clock());

}  // namespace odds::realtime
