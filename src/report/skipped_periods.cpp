#include "report/skipped_periods.hpp"

#include <algorithm>

namespace odds::report {

using haptics::TickRecord;

std::uint64_t skipped_at_the_end(const RunInfo& info, std::span<const TickRecord> ticks) {
  if (ticks.empty()) return 0;
  const auto less = [](std::uint64_t all, std::uint64_t some) { return all > some ? all - some : 0; };
  std::uint64_t unseen = info.loop.skipped;
  for (const TickRecord& tick : ticks) unseen = less(unseen, tick.skipped_before);
  // Where records were lost, the skips of lost ticks are unseen, too; the number of the last tick tells them apart.
  return std::min(unseen, less(info.loop.ran + info.loop.skipped, ticks.back().tick + 1));
}

std::vector<std::int64_t> waits_at_the_end(const RunInfo& info, std::span<const TickRecord> ticks) {
  std::vector<std::int64_t> waits;
  const std::uint64_t skipped = skipped_at_the_end(info, ticks);
  const auto planned_after = [&](std::uint64_t i) {
    return ticks.back().planned_ns + static_cast<std::int64_t>(i) * info.period_ns;
  };
  for (std::uint64_t i = 1; i <= std::min(skipped, most_skipped_recorded); ++i) {
    waits.push_back(std::max(ticks.back().done_ns, planned_after(skipped + 1)) - planned_after(i));
  }
  return waits;
}

}  // namespace odds::report
