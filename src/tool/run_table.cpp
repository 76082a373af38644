// The figures of a run as a table on the terminal.
#include "tool/run_table.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace odds::tool {
namespace {

void line(const char* what, const std::string& text) { fmt::print("  {:<22} {}\n", what, text); }

std::string percentiles(const report::Histogram& h) {
  if (h.count() == 0) return "none";
  const auto us = [&](double percentile) { return 1e-3 * static_cast<double>(h.value_at_percentile(percentile)); };
  return fmt::format("p50 {:.1f}, p99 {:.1f}, p99.9 {:.1f}, max {:.1f} us", us(50.0), us(99.0), us(99.9),
                     1e-3 * static_cast<double>(h.max()));
}

std::string budget(const report::RunInfo& info) {
  const bool units = info.work_units != report::RunInfo{}.work_units;
  const std::string count = units ? fmt::format("{} work units", info.work_units) : "none";
  if (!std::isfinite(info.budget_us)) return count;
  return fmt::format("{} us{}", info.budget_us, units ? " and " + count : "");
}

std::string safety(const haptics::SafetyCounts& c) {
  std::string text;
  const auto add = [&](const char* what, std::uint64_t count) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", what, count);
  };
  add("not finite", c.not_finite);
  add("scaled", c.scaled);
  add("rising", c.force_rise);
  add("force clamped", c.force_clamped);
  add("torque clamped", c.torque_clamped);
  add("force slewed", c.force_slewed);
  add("torque slewed", c.torque_slewed);
  add("stale", c.stale);
  add("faulted", c.faulted);
  add("rise begun again", c.restarted);
  return text.empty() ? "no tick changed" : text + " (ticks)";
}

}  // namespace

void print_run_table(const report::RunInfo& info, const report::RunSummary& s, const scene::RunOutcome& outcome) {
  fmt::print("{}{}\n", info.scene, info.simulated_time ? " (simulated time)" : "");
  line("ticks", fmt::format("{} of {} ran, {} late, {} skipped{}", s.ran, s.planned, s.late, s.skipped,
                            outcome.loop.stopped ? ", stopped early" : ""));
  line("allocations in ticks", s.allocations ? std::to_string(*s.allocations) : "not measured");
  line("page faults in ticks", fmt::format("{} minor, {} major", s.minor_faults, s.major_faults));
  if (!info.simulated_time) line("wake-up latency", percentiles(s.wake));
  if (!info.simulated_time) line("tick latency", percentiles(s.tick));
  if (!info.simulated_time) line("tick, net", percentiles(s.tick_net));
  line("queries", fmt::format("{} in {} ticks, budget {}", s.queries, s.ticks_with_query, budget(info)));
  line(info.simulated_time ? "query, gross" : "query, net",
       percentiles(info.simulated_time ? s.query_gross : s.query_net));
  if (!info.simulated_time) line("query overshoot, net", percentiles(s.query_overshoot));
  line("collision phase", percentiles(s.collision));
  line("world step", percentiles(s.step));
  line("answers (ticks)", fmt::format("{} proved, {} estimated, {} ended by the budget; {} hits", s.by_basis[0],
                                      s.by_basis[1], s.by_basis[2], s.hits));
  line("contacts", fmt::format("at most {}, deepest {:.2f} mm", s.most_contacts, 1e3 * s.deepest_m));
  line("force", fmt::format("at most {:.2f} N, torque at most {:.3f} N m", s.largest_force_n, s.largest_torque_nm));
  line("safety", safety(outcome.safety));
  for (const report::RunEffect& effect : info.effect_costs) {
    const double ticks = static_cast<double>(std::max<std::uint64_t>(effect.ticks, 1));
    line("effect", fmt::format("{}: {:.2f} evaluations a tick, {:.3f} us in its own code, longest {:.1f}", effect.name,
                               static_cast<double>(effect.evaluations) / ticks,
                               1e-3 * static_cast<double>(effect.total_ns) / ticks,
                               1e-3 * static_cast<double>(effect.longest_ns)));
  }
  if (outcome.device_track.states.size() > 1) {
    line("energy at the hand", fmt::format("lowest balance {:.3g} J", outcome.least_energy_j));
  }
  if (outcome.events_lost > 0) line("events", fmt::format("{} found no room", outcome.events_lost));
  if (outcome.failed_reads > 0) line("device", fmt::format("{} reads failed", outcome.failed_reads));
  if (outcome.rescued_steps > 0)
    line("world", fmt::format("{} steps held a body's speed or put it back", outcome.rescued_steps));
  if (outcome.pairs_left_out > 0) line("pairs without time", std::to_string(outcome.pairs_left_out));
  if (outcome.contacts_left_out > 0) line("contacts left out", std::to_string(outcome.contacts_left_out));
  for (const realtime::SetupLine& setup : info.thread) line("asked", setup.text());
  for (const report::Check& check : s.checks) {
    fmt::print("  [{:<12}] {} {}\n", report::name(check.state), check.question, check.finding);
  }
}

}  // namespace odds::tool
