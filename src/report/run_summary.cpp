// One pass over the records of a run.
#include "odds/report/run_summary.hpp"

#include <algorithm>
#include <cmath>

#include "report/run_checks.hpp"
#include "report/skipped_periods.hpp"

namespace odds::report {
namespace {

using haptics::TickRecord;

double length(const std::array<double, 3>& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

template <std::size_t N>
bool finite(const std::array<double, N>& numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double number) { return std::isfinite(number); });
}

bool finite(const TickRecord& t) {
  return finite(std::array{t.query_gross_us, t.query_stall_us, t.query_net_us, t.query_overshoot_us,
                           t.query_net_overshoot_us, t.probability, t.collision_us, t.step_us, t.processor_us,
                           t.max_depth_m}) &&
         finite(t.device_position_m) && finite(t.device_orientation_wxyz) && finite(t.tool_position_m) &&
         finite(t.tool_orientation_wxyz) && finite(t.force_n) && finite(t.torque_nm);
}

/// Microseconds of a record as whole nanoseconds; what is not finite is counted elsewhere and left out here.
void record_us(Histogram& histogram, double us) {
  if (std::isfinite(us)) histogram.record(std::llround(std::clamp(us, 0.0, 1e12) * 1e3));
}

void add_query(RunSummary& summary, const TickRecord& tick) {
  summary.queries += tick.queries;
  summary.node_pairs += tick.node_pairs;
  summary.triangle_pairs += tick.triangle_pairs;
  if (tick.queries == 0) return;
  ++summary.ticks_with_query;
  ++summary.by_basis[std::min<std::size_t>(static_cast<std::size_t>(tick.basis), 2)];
  if (tick.verdict == query::Verdict::hit) ++summary.hits;
  record_us(summary.query_gross, tick.query_gross_us);
  record_us(summary.query_net, tick.query_net_us);
  record_us(summary.query_overshoot, tick.query_net_overshoot_us);
  summary.longest_overshoot_us = std::fmax(summary.longest_overshoot_us, tick.query_overshoot_us);  // fmax drops NaN
}

void add_conditions(RunSummary& summary, const TickRecord& tick) {
  if (tick.allocations != haptics::not_measured)
    summary.allocations = summary.allocations.value_or(0) + tick.allocations;
  summary.minor_faults += tick.minor_faults;
  summary.major_faults += tick.major_faults;
  summary.voluntary_switches += tick.voluntary_switches;
  summary.involuntary_switches += tick.involuntary_switches;
  for (std::size_t bit = 0; bit < summary.safety.size(); ++bit) summary.safety[bit] += (tick.safety >> bit) & 1U;
  if (!finite(tick)) ++summary.not_finite;
  summary.most_contacts = std::max(summary.most_contacts, tick.contacts);
  summary.deepest_m = std::fmax(summary.deepest_m, tick.max_depth_m);
  summary.largest_force_n = std::fmax(summary.largest_force_n, length(tick.force_n));
  summary.least_energy_j = std::fmin(summary.least_energy_j, tick.observed_energy_j);
  summary.largest_torque_nm = std::fmax(summary.largest_torque_nm, length(tick.torque_nm));
}

/// See run_summary.hpp.
double net_us(const TickRecord& tick) {
  const double awake_us = 1e-3 * static_cast<double>(tick.done_ns - tick.woke_ns) - tick.query_stall_us;
  return tick.processor_us > 0.0 ? std::fmin(awake_us, tick.processor_us) : awake_us;
}

/// Latencies and misses of one tick and of the periods skipped before it.
void add_times(RunSummary& summary, const TickRecord& tick, std::int64_t period_ns, std::uint64_t& miss_run) {
  const std::int64_t latency_ns = tick.done_ns - tick.planned_ns;
  summary.wake.record(tick.woke_ns - tick.planned_ns);
  summary.tick.record(latency_ns);
  for (std::uint64_t i = 1; i <= std::min(tick.skipped_before, most_skipped_recorded); ++i) {
    summary.tick.record(latency_ns + static_cast<std::int64_t>(i) * period_ns);
  }
  const bool late = latency_ns > period_ns;
  summary.late += late ? 1 : 0;
  miss_run += tick.skipped_before + (late ? 1 : 0);
  summary.longest_miss_run = std::max(summary.longest_miss_run, miss_run);
  if (!late) miss_run = 0;
}

}  // namespace

const char* name(Check::State state) noexcept {
  switch (state) {
    case Check::State::met:
      return "met";
    case Check::State::missed:
      return "missed";
    case Check::State::inconclusive:
      return "inconclusive";
    case Check::State::not_measured:
      break;
  }
  return "not measured";
}

RunSummary summarize(const RunInfo& info, std::span<const TickRecord> ticks) {
  RunSummary summary;
  summary.ran = info.loop.ran;
  summary.skipped = info.loop.skipped;
  summary.planned = summary.ran + summary.skipped;
  summary.records_lost = summary.ran - std::min<std::uint64_t>(summary.ran, ticks.size());
  std::uint64_t miss_run = 0;
  double stall_us = 0.0;
  double gross_us = 0.0;
  for (const TickRecord& tick : ticks) {
    add_times(summary, tick, info.period_ns, miss_run);
    add_query(summary, tick);
    add_conditions(summary, tick);
    record_us(summary.tick_net, net_us(tick));
    record_us(summary.collision, tick.collision_us);
    record_us(summary.step, tick.step_us);
    if (!std::isfinite(tick.query_gross_us) || !std::isfinite(tick.query_stall_us)) continue;
    stall_us += tick.query_stall_us;
    gross_us += tick.query_gross_us;
  }
  for (const std::int64_t wait_ns : waits_at_the_end(info, ticks)) summary.tick.record(wait_ns);
  summary.longest_miss_run = std::max(summary.longest_miss_run, miss_run + skipped_at_the_end(info, ticks));
  summary.stall_share = gross_us > 0.0 ? stall_us / gross_us : 0.0;
  summary.checks = run_checks(info, summary);
  return summary;
}

}  // namespace odds::report
