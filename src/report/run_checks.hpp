// Judges the figures of a run by the promises of the loop.
#pragma once

#include <vector>

#include "odds/report/run_summary.hpp"

namespace odds::report {

/// One line per promise, in the order in which a reader cares. Times are judged only on a machine that was quiet
/// enough; counts are judged always.
[[nodiscard]] std::vector<Check> run_checks(const RunInfo& info, const RunSummary& summary);

}  // namespace odds::report
