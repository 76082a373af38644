// A study of accuracy: poses with their truth, answers under many limits, and the figures drawn from them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "odds/query/answer.hpp"
#include "odds/report/accuracy/contact_region.hpp"
#include "odds/report/accuracy/forecast.hpp"
#include "odds/report/accuracy/poses.hpp"

namespace odds::report {

/// One limit under which every pose is answered.
struct Trial {
  enum class Kind : std::uint8_t {
    time,   ///< time-critical method, `amount` microseconds
    work,   ///< time-critical method, `amount` work units
    exact,  ///< depth-first search without a limit, for comparison
  };
  Kind kind = Kind::exact;
  double amount = 0.0;  ///< 0 for exact
  double p_min = 1.0;   ///< threshold of the stop on probability; 1: never

  friend bool operator==(const Trial&, const Trial&) = default;
  [[nodiscard]] std::string label() const;  ///< "5 us", "128 units, p >= 0.99", "exact"
};

/// As in the files of a study: "us", "work", "exact".
[[nodiscard]] constexpr std::string_view name(Trial::Kind kind) noexcept {
  return kind == Trial::Kind::time ? "us" : kind == Trial::Kind::work ? "work" : "exact";
}

/// What must be the same in two studies for their answers to be comparable.
struct StudySettings {
  std::string mesh_a;  ///< as named on the command line
  std::string mesh_b;
  double scale_a = 1.0;
  double scale_b = 1.0;
  std::uint64_t triangles_a = 0;
  std::uint64_t triangles_b = 0;
  std::string checksum_a;  ///< of the mesh's vertices and triangles: a file may change under its name; may be empty
  std::string checksum_b;
  double size_m = 0.0;  ///< what parts of the size refer to
  std::string bounding_volume;
  double tau = 0.25;
  std::string estimator;
  std::uint32_t k_min = 10;
  int contacts = 1;  ///< most contacts asked of each answer
  Procedure procedure = Procedure::distance;
  std::uint64_t seed = 0;
  std::uint64_t poses_per_band = 0;
  std::uint32_t calibration_poses = 0;  ///< see query::PairOptions
  std::vector<Trial> trials;

  friend bool operator==(const StudySettings&, const StudySettings&) = default;
  [[nodiscard]] std::uint64_t pose_count() const { return poses_per_band * pose_bands(procedure).size(); }
};

inline constexpr std::uint64_t most_poses_per_band = 10'000'000;
inline constexpr std::uint64_t most_shards = 1'000'000;

/// Shard i of n answers the poses whose index is i modulo n.
struct Shard {
  std::uint64_t number = 0;
  std::uint64_t of = 1;
};

/// A pose and what is true in it, proved by the exact search of the wide engine.
struct PoseTruth {
  MadePose pose;
  bool hit = false;
  std::uint32_t contacts = 0;      ///< in the exact contact set, at most 8
  query::Contact deepest_contact;  ///< its first; meaningless without contacts
};

/// How far an answer's first contact (or its most probable cell pair) was from the nearest contact of the exact set.
struct ContactError {
  double position = 0.0;    ///< part of the size
  double normal_deg = 0.0;  ///< 0 .. 180
  double depth = 0.0;       ///< part of the size, without sign
};

/// One answer.
struct Sample {
  query::Verdict verdict = query::Verdict::clear;
  query::Basis basis = query::Basis::proved;
  double probability = 0.0;
  std::uint64_t node_pairs = 0;
  std::uint64_t triangle_pairs = 0;
  double wall_us = 0.0;
  double stall_us = 0.0;
  double net_overshoot_us = 0.0;
  std::optional<ContactError>
      contact;               ///< if it gives a place, be it of a proof or the likeliest, and the truth has one
  Vec3 push = Vec3::Zero();  ///< depth times normal of that place, metres; zero if there is none
};

/// Poses in ascending index; samples[t][i] answers poses[i] under settings.trials[t].
struct Study {
  StudySettings settings;
  Shard shard;
  std::string version;
  double started_epoch_s = 0.0;
  bool machine_fit = true;   ///< to measure times on; of a merged study: every machine
  std::string machine_note;  ///< why not, or what was seen
  std::vector<PoseTruth> poses;
  std::vector<std::vector<Sample>> samples;
};

/// Of wall times and the like; zero without samples.
struct Tail {
  std::uint64_t count = 0;
  double p50 = 0.0, p99 = 0.0, p999 = 0.0, max = 0.0;
};

/// Medians and 90th percentiles of contact errors.
struct ContactFigures {
  std::uint64_t count = 0;
  ContactError p50, p90;
};

/// The figures of one trial on one set of poses.
struct AccuracyRow {
  std::size_t trial = 0;  ///< into settings.trials
  std::string scope;      ///< "all", "group" or "band"
  std::string band;       ///< name of the band or group; "all"
  std::uint64_t poses = 0, hits = 0;
  std::uint64_t proved = 0, estimated = 0, at_budget = 0;
  std::uint64_t false_hits = 0;    ///< verdict hit, truth clear
  std::uint64_t false_misses = 0;  ///< verdict clear, truth hit
  ForecastQuality unproved;        ///< of the answers without proof, which alone state a probability
  double brier_all = 0.0;          ///< mean squared error of the probability over all answers, proofs included
  Tail wall_us, net_overshoot_us;
  ContactFigures contact;
  ContactFigures fallback;  ///< the same of the answers without proof alone

  [[nodiscard]] std::uint64_t wrong() const noexcept { return false_hits + false_misses; }
  [[nodiscard]] Interval wrong_interval() const noexcept { return wilson(wrong(), poses); }
  [[nodiscard]] Interval false_hit_interval() const noexcept { return wilson(false_hits, poses - hits); }
  [[nodiscard]] Interval false_miss_interval() const noexcept { return wilson(false_misses, hits); }
  [[nodiscard]] double share_wrong() const noexcept { return share(wrong()); }
  [[nodiscard]] double share_proved() const noexcept { return share(proved); }

 private:
  [[nodiscard]] double share(std::uint64_t n) const noexcept {
    return poses > 0 ? static_cast<double>(n) / static_cast<double>(poses) : 0.0;
  }
};

/// How an answer's push (depth times normal) changes while its limit grows: the sum of the lengths of all changes, from
/// nothing over every limit of one kind without a threshold to the deepest contact of the exact set, over the length of
/// that. 1: it grew without a detour. Of the poses of one band that are hits with a depth.
struct PushSweep {
  Trial::Kind kind = Trial::Kind::time;
  std::string band;
  std::uint64_t count = 0;
  double p50 = 0.0, p90 = 0.0;
};

/// For both kinds of limits and each band; bands without a hit are left out.
[[nodiscard]] std::vector<PushSweep> push_sweeps(const Study& study);

/// Rows for each trial: all poses, each group, each band. A set without poses has no row.
[[nodiscard]] std::vector<AccuracyRow> accuracy_rows(const Study& study);

/// How far `given` is from the region of contact, and its direction and depth compared with those of the contact of
/// `found` that is nearest to it. Precondition: `found` is not empty, size > 0.
[[nodiscard]] ContactError contact_error(const query::Contact& given, std::span<const query::Contact> found,
                                         const ContactRegion& region, double size);

/// A pose that was answered badly: its squared errors of probability, added over all trials.
struct WorstPose {
  std::size_t pose = 0;   ///< into study.poses
  double error = 0.0;     ///< > 0
  std::size_t trial = 0;  ///< where its error was greatest; of equals the one that comes last
};

/// The worst first, at most `most`; poses without any error are left out.
[[nodiscard]] std::vector<WorstPose> worst_poses(const Study& study, std::size_t most);

}  // namespace odds::report
