// A tight loop over the clock, watched by the stall ledger.
#include "odds/realtime/fitness.hpp"

#include <cstdio>

#include "odds/realtime/usage.hpp"

namespace odds::realtime {

Fitness probe_fitness(const FitnessLimits& limits, Clock clock) {
  const ThreadUsage before = thread_usage();
  const std::int64_t start_ns = clock();
  StallLedger ledger(start_ns, limits.threshold_ns);
  for (std::int64_t now_ns = start_ns; now_ns - start_ns < limits.probe_ns;) {
    now_ns = clock();
    ledger.poll(now_ns);
  }
  Fitness fitness;
  const auto gross = static_cast<double>(ledger.gross_ns());
  fitness.stall_share = gross > 0.0 ? static_cast<double>(ledger.stall_ns()) / gross : 0.0;
  fitness.longest_gap_ns = ledger.longest_gap_ns();
  fitness.stalls = ledger.stalls();
  fitness.involuntary_switches = (thread_usage() - before).involuntary_switches;

  const bool share_good = fitness.stall_share <= limits.largest_stall_share;
  const bool gap_good = fitness.longest_gap_ns <= limits.longest_gap_ns;
  fitness.fit = share_good && gap_good;
  char text[320];
  std::snprintf(text, sizeof text,
                "%s: in %.0f ms the processor was away for %.2f %% of the time (limit %.2f %%), longest %.0f us (limit "
                "%.0f us), %u stalls, %llu involuntary switches",
                fitness.fit ? "fit" : "unfit", gross * 1e-6, 100.0 * fitness.stall_share,
                100.0 * limits.largest_stall_share, static_cast<double>(fitness.longest_gap_ns) * 1e-3,
                static_cast<double>(limits.longest_gap_ns) * 1e-3, fitness.stalls,
                static_cast<unsigned long long>(fitness.involuntary_switches));
  fitness.reason = text;
  return fitness;
}

}  // namespace odds::realtime
