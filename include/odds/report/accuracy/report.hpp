// Writes the files of a study of accuracy, and reads the studies of shards back.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "odds/math/error.hpp"
#include "odds/report/accuracy/study.hpp"

namespace odds::report {

/// Where each file went.
struct AccuracyFiles {
  std::filesystem::path page;                ///< accuracy.html: one file, opens offline
  std::filesystem::path rows;                ///< accuracy.csv: one line for each limit and band
  std::filesystem::path poses;               ///< poses.csv: every pose with its truth; `odds query` reads it
  std::filesystem::path answers;             ///< answers.csv: every answer; what a merge reads
  std::filesystem::path summary;             ///< summary.json
  std::vector<std::filesystem::path> worst;  ///< worst/01.csv ...: the worst poses, one each
};

constexpr std::size_t most_worst_poses = 20;

/// Writes all files into `directory`, which is made if need be; files of an earlier study are replaced. `rows` must be
/// accuracy_rows(study). Errors name the file that could not be written.
[[nodiscard]] Result<AccuracyFiles> write_accuracy_report(const std::filesystem::path& directory, const Study& study,
                                                          const std::vector<AccuracyRow>& rows);

/// The study that a directory holds. Errors name the file and the line.
[[nodiscard]] Result<Study> read_study(const std::filesystem::path& directory);

/// One study from all shards of it, in any order. Refused: settings that differ, a shard that is missing or there
/// twice. `names` stand in the errors, one for each study.
[[nodiscard]] Result<Study> merge_studies(std::vector<Study> studies, const std::vector<std::string>& names);

/// The study in two or three sentences, plain text: the smallest limit under which at most 1 % are wrong (or else the
/// largest), what its unproved probabilities are worth, the exact search for comparison.
[[nodiscard]] std::string headline(const Study& study, const std::vector<AccuracyRow>& rows);

/// The command line that answers the poses of `file` as the trial did.
[[nodiscard]] std::string replay_command(const StudySettings& settings, const Trial& trial, const std::string& file);

}  // namespace odds::report
