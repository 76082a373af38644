// Periods of a run that stand in no record, for no tick followed them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "odds/haptics/tick_record.hpp"
#include "odds/report/run_summary.hpp"

namespace odds::report {

/// Of the periods skipped before a tick, or at the end, as many stand in histograms: a run that stood still for days
/// needs no memory for each of them.
inline constexpr std::uint64_t most_skipped_recorded = 1'000'000;

/// Periods skipped after the last tick of a run.
[[nodiscard]] std::uint64_t skipped_at_the_end(const RunInfo& info, std::span<const haptics::TickRecord> ticks);
/// How long each of them waited: until the last tick ended, but no less than until its own end, for the loop skips only
/// what has passed. Nanoseconds.
[[nodiscard]] std::vector<std::int64_t> waits_at_the_end(const RunInfo& info,
                                                         std::span<const haptics::TickRecord> ticks);

}  // namespace odds::report
