// Latencies second by second, for HdrHistogram's log analysers.
#include <algorithm>
#include <cmath>

#include "report/run_files.hpp"
#include "report/skipped_periods.hpp"

namespace odds::report {

void for_each_second(const RunInfo& info, std::span<const haptics::TickRecord> ticks,
                     const std::function<void(const HlogInterval&)>& take) {
  constexpr double second_ns = 1e9;
  if (ticks.empty()) return;
  const std::int64_t start_ns = ticks.front().planned_ns;
  const auto second_of = [&](const haptics::TickRecord& tick) {
    return std::floor(static_cast<double>(tick.planned_ns - start_ns) / second_ns);
  };
  for (std::size_t begin = 0; begin < ticks.size();) {
    const double second = second_of(ticks[begin]);
    HlogInterval tick{"", second, 1.0, Histogram()};
    HlogInterval wake{"wake", second, 1.0, Histogram()};
    HlogInterval query{"query", second, 1.0, Histogram()};
    std::size_t end = begin;
    for (; end < ticks.size() && second_of(ticks[end]) == second; ++end) {
      const haptics::TickRecord& t = ticks[end];
      for (std::uint64_t i = 0; i <= std::min<std::uint64_t>(t.skipped_before, 1'000'000); ++i) {
        tick.histogram.record(t.done_ns - t.planned_ns + static_cast<std::int64_t>(i) * info.period_ns);
      }
      wake.histogram.record(t.woke_ns - t.planned_ns);
      if (t.queries > 0 && std::isfinite(t.query_gross_us))
        query.histogram.record(std::llround(t.query_gross_us * 1e3));
    }
    if (end == ticks.size()) {
      for (const std::int64_t wait_ns : waits_at_the_end(info, ticks)) tick.histogram.record(wait_ns);
    }
    for (const HlogInterval* interval : {&tick, &wake, &query}) take(*interval);
    begin = end;
  }
}

}  // namespace odds::report
