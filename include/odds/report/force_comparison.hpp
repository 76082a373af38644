// How the force on the hand changes with the budget: runs of one scene against the run without a limit.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "odds/haptics/tick_record.hpp"
#include "odds/math/error.hpp"

namespace odds::report {

/// What a comparison needs to know of a tick. Newton, world frame.
struct ForceSample {
  double t_s = 0.0;
  Vec3 force_n = Vec3::Zero();
  std::uint32_t contacts = 0;
};

[[nodiscard]] std::vector<ForceSample> force_samples(std::span<const haptics::TickRecord> ticks,
                                                     std::int64_t period_ns);

/// Differences of a run from the exact one, tick by tick. Where the exact run has no ticks to compare, the optional
/// figures are empty.
struct ForceDifference {
  std::uint64_t ticks = 0;    ///< compared: those in which the exact run's force is at least `touching_n`
  double mean_force_n = 0.0;  ///< of the exact run in these
  double error_p50 = 0.0;     ///< difference of the magnitudes, share of the exact force
  double error_p95 = 0.0;
  double angle_p50_deg = 0.0;  ///< between the forces
  double angle_p95_deg = 0.0;
  double noise_share = 0.0;         ///< RMS of the force in the noise_band() in these ticks, share of the mean force
  double added_noise_share = 0.0;   ///< what of it the exact run has not: root of the difference of the squares, >= 0
  std::uint64_t onsets = 0;         ///< of contact in the exact run, after at least five ticks without
  std::uint64_t onsets_missed = 0;  ///< without one in this run within 20 ticks
  std::optional<double> onset_p99_ticks;  ///< how far apart they are
  /// Ticks in which this run has no contact although the exact run has one and its force is at least `touching_n`, and
  /// so in the tick before.
  std::uint64_t missed_in_row = 0;
  double largest_false_n = 0.0;  ///< difference of the forces in ticks in which the exact run's is below `touching_n`
};

/// Both runs have the same ticks; their shorter length counts. `rate_hz` > 0.
[[nodiscard]] ForceDifference compare_forces(std::span<const ForceSample> exact, std::span<const ForceSample> run,
                                             double touching_n, double rate_hz);

/// One run of the scene.
struct ComparedRun {
  std::string name;                    ///< "no limit", "20 us"
  std::optional<double> proved_share;  ///< of the queries' ticks, [0, 1]; none if there was no query
  double units_per_query = 0.0;        ///< mean work
  std::vector<ForceSample> samples;
  ForceDifference difference;
  /// Of the force of contacts on the tool, in each tick at the pose of the exact run. None for runs without a limit.
  std::optional<ForceDifference> at_same_poses;
};

struct Comparison {
  std::string scene;
  std::string version;
  double rate_hz = 1000.0;
  double touching_n = 0.05;
  /// Of the scene's frame, for all queries of a step: the runs with a budget keep it, those without a limit have none.
  std::uint64_t frame_work_units = std::numeric_limits<std::uint64_t>::max();
  std::vector<ComparedRun> runs;  ///< the exact one first
};

/// From where the filter begins to half the rate, as "50-500 Hz".
[[nodiscard]] std::string noise_band(double rate_hz);

/// What the runs with a budget keep of the scene's own limits, a sentence; empty if there is nothing.
[[nodiscard]] std::string kept_frame(const Comparison& comparison);

/// Writes DIR/comparison.html and DIR/comparison.csv. DIR is there.
[[nodiscard]] std::optional<Error> write_comparison(const std::filesystem::path& folder, const Comparison& comparison);

}  // namespace odds::report
