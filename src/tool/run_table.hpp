// The figures of a run as a table on the terminal.
#pragma once

#include "odds/report/run_summary.hpp"
#include "odds/scene/simulation.hpp"

namespace odds::tool {

void print_run_table(const report::RunInfo& info, const report::RunSummary& summary, const scene::RunOutcome& outcome);

}  // namespace odds::tool
