// The short table at the end of `odds query`: what was answered, and in which time.
#pragma once

#include <span>
#include <string>

#include "tool/answers_csv.hpp"

namespace odds::tool {

/// The value that `share` of the sorted values do not exceed (nearest rank); `sorted` ascending and not empty.
double percentile(std::span<const double> sorted, double share);

/// Counts by verdict and basis; percentiles of wall time, with a time budget also of net time and overshoot. A
/// percentile that the sample is too small to show (fewer than one answer beyond it) is given as "-".
std::string answer_table(std::span<const AnswerRecord> records, bool has_time_budget);

}  // namespace odds::tool
