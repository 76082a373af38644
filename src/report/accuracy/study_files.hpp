// The contents of a study's files, as text.
#pragma once

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

/// The page for people.
[[nodiscard]] std::string accuracy_page(const Study& study, const std::vector<AccuracyRow>& rows);
/// The numbers behind its charts, as JSON that is safe inside a script element.
[[nodiscard]] std::string accuracy_page_data(const Study& study, const std::vector<AccuracyRow>& rows);

}  // namespace odds::report
