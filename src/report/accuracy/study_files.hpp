// The contents of a study's files, as text.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "odds/math/error.hpp"
#include "odds/report/accuracy/study.hpp"

namespace odds::report {

[[nodiscard]] std::string rows_csv(const Study& study, const std::vector<AccuracyRow>& rows);
[[nodiscard]] std::string poses_csv(const Study& study);
[[nodiscard]] std::string answers_csv(const Study& study);
/// Heading and row of one pose, as in poses.csv.
[[nodiscard]] std::string one_pose_csv(const Study& study, std::size_t pose);

/// Reads what poses_csv and answers_csv wrote into a study whose settings are known.
[[nodiscard]] std::optional<Error> read_poses_csv(const std::string& file, const std::string& text, Study& study);
[[nodiscard]] std::optional<Error> read_answers_csv(const std::string& file, const std::string& text, Study& study);

[[nodiscard]] std::string study_json(const Study& study, const std::vector<AccuracyRow>& rows);
/// Settings, shard and machine from what study_json wrote; poses and samples are left empty.
[[nodiscard]] Result<Study> read_study_json(const std::string& file, const std::string& text);

/// Where the pose of a place stands, 1 for the worst: DIRECTORY/worst/01.csv.
[[nodiscard]] std::filesystem::path worst_file(const std::filesystem::path& directory, std::size_t place);

/// The page for people. `directory`: as it was given, for the commands on the page.
[[nodiscard]] std::string accuracy_page(const Study& study, const std::vector<AccuracyRow>& rows,
                                        const std::filesystem::path& directory);
/// The numbers behind its charts, as JSON that is safe inside a script element.
[[nodiscard]] std::string accuracy_page_data(const Study& study, const std::vector<AccuracyRow>& rows);

}  // namespace odds::report
