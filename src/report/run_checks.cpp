// The promises of the loop, one function each.
#include "report/run_checks.hpp"

#include <fmt/format.h>

#include <cmath>

#include "report/text.hpp"

namespace odds::report {
namespace {

using State = Check::State;

/// Above this share of stalls in the queries' own time no verdict on times is given (realtime/fitness.hpp: the same).
constexpr double largest_stall_share = 0.02;

bool machine_was_quiet(const RunInfo& info, const RunSummary& summary) {
  return summary.stall_share <= largest_stall_share && (!info.fitness || info.fitness->fit);
}

Check answered(const RunInfo& info, const RunSummary& s) {
  Check check{"answered", "Did every planned tick run, with an answer to every query?", "", State::met};
  check.finding = fmt::format("{} of {} ticks ran, {} queries, all answered", grouped(s.ran), grouped(s.planned),
                              grouped(s.queries));
  if (info.pairs_left_out > 0) {
    check.finding += fmt::format("; {} pairs had to wait for a later tick", grouped(info.pairs_left_out));
  }
  if (s.skipped > 0) check.finding += fmt::format("; {} periods skipped", grouped(s.skipped));
  return check;
}

Check deadline(const RunInfo& info, const RunSummary& s) {
  Check check{"deadline", "Was every force out before the next tick was due?", "", State::met};
  const std::uint64_t missed = s.late + s.skipped;
  if (missed == 0) {
    check.finding = fmt::format("yes; the slowest took {} of {}", duration(static_cast<double>(s.tick.max())),
                                duration(static_cast<double>(info.period_ns)));
  } else {
    check.finding = fmt::format("{} of {} periods missed ({} late, {} skipped), at most {} in a row", grouped(missed),
                                grouped(s.planned), grouped(s.late), grouped(s.skipped), grouped(s.longest_miss_run));
  }
  return check;
}

/// What is told of the limit of all collisions of a step, if there is one.
std::string budget_of_a_step(const RunInfo& info) {
  if (std::isfinite(info.frame_us)) {
    return fmt::format("; all of a step in {}: at most {} beyond it", limit_text(info.frame_us, info.frame_work_units),
                       duration(info.frame_overshoot_us * 1e3));
  }
  if (info.frame_work_units == RunInfo{}.frame_work_units) return "";
  return fmt::format("; {} for all of a step", limit_text(info.frame_us, info.frame_work_units));
}

Check budget(const RunInfo& info, const RunSummary& s) {
  Check check{"budget", "Did every query end within its budget?", "", State::met};
  if (!std::isfinite(info.budget_us) || s.ticks_with_query == 0) {
    check.state = State::not_measured;
    if (s.ticks_with_query == 0) {
      check.finding = "no query was made";
    } else {
      const std::string limit = limit_text(info.budget_us, info.work_units);
      check.finding = limit == "none" ? "no query had a budget" : limit + " for a query: counted work, without a clock";
    }
    check.finding += budget_of_a_step(info);
    return check;
  }
  const auto overshoot_ns = static_cast<double>(s.query_overshoot.value_at_percentile(99.9));
  if (overshoot_ns > info.allowed_overshoot_us * 1e3) check.state = State::missed;
  check.finding = fmt::format("{} budget; net overshoot: 99.9 % within {}, longest {} (allowed {}); gross longest {}",
                              duration(info.budget_us * 1e3), duration(overshoot_ns),
                              duration(static_cast<double>(s.query_overshoot.max())),
                              duration(info.allowed_overshoot_us * 1e3), duration(s.longest_overshoot_us * 1e3));
  check.finding += budget_of_a_step(info);
  return check;
}

Check memory(const RunInfo& info, const RunSummary& s) {
  Check check{"memory", "Did the ticks stay free of allocations, page faults and waiting?", "", State::met};
  const std::uint64_t faults = s.minor_faults + s.major_faults;
  const std::string allocations = s.allocations ? grouped(*s.allocations) : "uncounted";
  check.finding = fmt::format("{} allocations, {} page faults, {} voluntary switches within ticks", allocations,
                              grouped(faults), grouped(s.voluntary_switches));
  // Nothing is locked into memory for simulated time, so its page faults tell nothing about a loop in real time.
  const std::uint64_t judged_faults = info.simulated_time ? 0 : faults;
  if (s.allocations.value_or(0) + judged_faults + s.voluntary_switches > 0) {
    check.state = State::missed;
  } else if (!s.allocations) {
    check.state = State::not_measured;
  }
  return check;
}

Check force(const RunSummary& s) {
  static constexpr const char* stages[] = {"not finite",   "gentle rise",     "force clamped", "torque clamped",
                                           "force slewed", "torque slewed",   "stale device",  "fault latched",
                                           "force scaled", "rise begun again"};
  Check check{"force", "Were all forces finite, and no fault latched?", "", State::met};
  std::string interventions;
  for (std::size_t bit = 0; bit < s.safety.size(); ++bit) {
    if (s.safety[bit] == 0) continue;
    interventions += fmt::format("{}{}: {}", interventions.empty() ? "" : ", ", stages[bit], grouped(s.safety[bit]));
  }
  check.finding = fmt::format("largest {:.3g} N and {:.3g} N·m; safety stages (ticks): {}", s.largest_force_n,
                              s.largest_torque_nm, interventions.empty() ? "none acted" : interventions);
  if (s.not_finite > 0)
    check.finding += fmt::format("; {} records with numbers that are not finite", grouped(s.not_finite));
  if (s.not_finite + s.safety[0] + s.safety[7] > 0) check.state = State::missed;
  return check;
}

Check recording(const RunSummary& s) {
  return {"recording", "Did every tick reach this report?",
          s.records_lost == 0
              ? fmt::format("all {} records", grouped(s.ran))
              : fmt::format("{} records were dropped because the writer fell behind", grouped(s.records_lost)),
          s.records_lost == 0 ? State::met : State::missed};
}

Check machine(const RunInfo& info, const RunSummary& s) {
  Check check{"machine", "Was the machine quiet enough to judge times?", "", State::met};
  check.finding = fmt::format("stalls took {} of the queries' time (limit {})", percent(s.stall_share),
                              percent(largest_stall_share));
  if (info.fitness) check.finding += "; before the run " + info.fitness->reason;
  if (!machine_was_quiet(info, s)) check.state = State::inconclusive;
  if (info.simulated_time) {
    check.state = State::not_measured;
    check.finding = "simulated time: stalls are not measured";
  }
  return check;
}

}  // namespace

std::vector<Check> run_checks(const RunInfo& info, const RunSummary& summary) {
  const bool quiet = machine_was_quiet(info, summary);
  std::vector<Check> checks{answered(info, summary), deadline(info, summary), budget(info, summary),
                            memory(info, summary),   force(summary),          recording(summary),
                            machine(info, summary)};
  const std::uint64_t missed = summary.late + summary.skipped;
  if (summary.skipped > 0) checks[0].state = quiet ? State::missed : State::inconclusive;
  if (missed > 0) checks[1].state = quiet ? State::missed : State::inconclusive;
  if (checks[2].state != State::not_measured && !quiet) checks[2].state = State::inconclusive;
  if (info.simulated_time) {
    checks[1].state = State::not_measured;
    checks[1].finding = "simulated time: the loop ran as fast as it could, without deadlines";
  }
  return checks;
}

}  // namespace odds::report
