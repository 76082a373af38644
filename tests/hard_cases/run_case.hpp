// Runs a hard case and judges it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hard_cases/hard_case.hpp"
#include "odds/math/error.hpp"
#include "odds/report/force_comparison.hpp"

namespace odds::hard_cases {

/// What one run left of a tick.
struct Sample {
  double t_s = 0.0;
  double force_n[3] = {};
  double energy_j = 0.0;
  double depth_m = 0.0;
  bool overlaps_deeply = false;  ///< by an exact query at the same poses
  std::uint32_t contacts = 0;
};

/// The figures of one run of a case with one budget.
struct Figures {
  std::string budget;  ///< "none", "50 us", "5 us", and of the starved run "1 us" or "N units"
  std::uint64_t ticks = 0;
  std::uint64_t not_finite = 0;
  double largest_force_n = 0.0;
  double given_j = 0.0;  ///< most that the hand has got beyond what it has put in, >= 0
  std::uint64_t missed_deep =
      0;                   ///< ticks that are the second or a later one in a row without a contact in a deep overlap
  std::uint64_t deep = 0;  ///< ticks with a deep overlap
  std::uint64_t failed_reads = 0;
  std::uint64_t rescued = 0;
  std::uint64_t left_out = 0;
  std::uint64_t safety_ticks = 0;  ///< in which a safety stage changed the force
  std::uint32_t most_contacts = 0;
  double deepest_m = 0.0;
  double end_height_m = 0.0;              ///< of the body that the case names
  std::optional<double> force_error_p95;  ///< on the hand, of this run on its own; share of the exact run's force
  std::optional<double> angle_error_p95_deg;
  std::optional<int> onset_ticks;     ///< between the first contact of this run and that of the exact one
  std::optional<double> noise_share;  ///< from 50 to 500 Hz, beyond the exact run's, of its mean force
  /// The force of contacts on the tool, in each tick at the pose of the exact run. Not where nobody holds a tool.
  std::optional<report::ForceDifference> at_same_poses;
  double wall_s = 0.0;
  bool has_hand = false;  ///< else there is no force, and no exact query beside the ticks
  std::string picture;    ///< bytes of a PNG: the bodies where a contact was deepest
  std::vector<Sample> samples;
  std::vector<std::string> harmful;  ///< numbers, forces or energy that must never be, at any budget
  std::vector<std::string> missed;   ///< deep contacts that were not seen, bodies that fell through
  std::vector<std::string> off;      ///< forces that differ from the exact run's by more than people notice

  [[nodiscard]] bool safe() const { return harmful.empty() && missed.empty(); }
  /// Whether it is long enough for forces as without one.
  [[nodiscard]] bool feel_is_judged() const { return budget == "none" || budget == "50 us"; }
  [[nodiscard]] bool holds() const { return harmful.empty() && missed.empty() && (off.empty() || !feel_is_judged()); }
};

struct Outcome {
  const HardCase* hard_case = nullptr;
  std::vector<Figures> runs;  ///< the exact one first
};

struct RunOptions {
  double share_of_seconds = 1.0;
  std::uint64_t starved_units = 20;  ///< of the run with the least work; 20 are 1 us
};

/// Runs without a limit, with 1000 work units (50 us), with 100 (5 us) and with those of a starved one.
Result<Outcome> run_case(const HardCase& hard_case, const std::string& folder, const RunOptions& options);

}  // namespace odds::hard_cases
