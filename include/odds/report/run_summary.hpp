// The figures of a finished run, and what they mean for the promises of the loop.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "odds/haptics/tick_record.hpp"
#include "odds/report/histogram.hpp"
#include "odds/report/run_info.hpp"

namespace odds::report {

/// One promise and what became of it.
struct Check {
  enum class State : std::uint8_t {
    met,
    missed,
    inconclusive,  ///< the machine was too restless to judge times on
    not_measured,
  };
  std::string key;       ///< "deadline"; stable, for programs
  std::string question;  ///< "Was every force out before the next tick was due?"
  std::string finding;   ///< "yes: 10,000 of 10,000 ticks"
  State state = State::not_measured;
};

[[nodiscard]] const char* name(Check::State state) noexcept;

/// All histograms in nanoseconds.
struct RunSummary {
  Histogram wake;             ///< woke - planned
  Histogram tick;             ///< done - planned; a skipped period counts with the next tick that ran (see summarize)
  Histogram tick_net;         ///< the tick's own work: see summarize
  Histogram query_gross;      ///< per tick with a query
  Histogram query_net;        ///< gross without stalls
  Histogram query_overshoot;  ///< net, beyond the budget; the largest of the tick's queries
  Histogram collision;        ///< gross; broad phase, queries and contact joints
  Histogram step;             ///< gross; the world step

  std::uint64_t planned = 0;
  std::uint64_t ran = 0;
  std::uint64_t skipped = 0;
  std::uint64_t late = 0;              ///< ran, and ended after the next tick was due
  std::uint64_t longest_miss_run = 0;  ///< most periods in a row that were late or skipped
  std::uint64_t records_lost = 0;      ///< ran, and no record reached the report

  std::uint64_t queries = 0;
  std::uint64_t ticks_with_query = 0;
  std::array<std::uint64_t, 3> by_basis{};  ///< ticks, index: query::Basis; the weakest basis of the tick
  std::uint64_t hits = 0;                   ///< ticks whose verdict is hit
  double longest_overshoot_us = 0.0;        ///< gross
  double stall_share = 0.0;                 ///< of the gross query time, in [0, 1]
  std::uint64_t node_pairs = 0;
  std::uint64_t triangle_pairs = 0;

  std::optional<std::uint64_t> allocations;  ///< within ticks; nothing if not counted
  std::uint64_t minor_faults = 0;
  std::uint64_t major_faults = 0;
  std::uint64_t voluntary_switches = 0;
  std::uint64_t involuntary_switches = 0;
  std::array<std::uint64_t, haptics::safety_flag_count> safety{};  ///< ticks per bit of haptics::SafetyFlag
  std::uint64_t not_finite = 0;                                    ///< records with a number that is not finite
  std::uint32_t most_contacts = 0;
  double deepest_m = 0.0;
  double largest_force_n = 0.0;
  double largest_torque_nm = 0.0;
  double least_energy_j = 0.0;  ///< lowest balance of energy at the hand, <= 0; below zero: more given than taken

  std::vector<Check> checks;
};

/// From the records of a run, in order of their ticks.
///
/// Latencies count from the planned start, so that a late wake-up is part of them. A skipped period has no force of its
/// own: it counts with the time from its planned start to the end of the next tick that ran, which is how long the hand
/// waited. Where none followed, until the last tick ended, but no less than until its own end. Without this the worst
/// moments would be missing from the percentiles (coordinated omission).
///
/// The net time of a tick is bounded from above in two ways, of which the smaller counts: from waking up to the force,
/// less the stalls in its queries; and the time in which the loop's thread ran (TickRecord::processor_us), where it was
/// measured. A thread that lost the processor outside a query shows in the second, a stolen processor in the first.
[[nodiscard]] RunSummary summarize(const RunInfo& info, std::span<const haptics::TickRecord> ticks);

}  // namespace odds::report
