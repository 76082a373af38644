// The sections of the report page, as HTML. Whatever came from outside is escaped here.
#pragma once

#include <string>

#include "odds/report/run_info.hpp"
#include "odds/report/run_replay.hpp"
#include "odds/report/run_summary.hpp"

namespace odds::report {

[[nodiscard]] std::string page_head_line(const RunInfo& info,
                                         const RunSummary& summary);  ///< title, verdict, promises, cards
[[nodiscard]] std::string page_latency(const RunInfo& info, const RunSummary& summary, bool charts);
[[nodiscard]] std::string page_answers(const RunSummary& summary, bool charts);
[[nodiscard]] std::string page_forces(const RunInfo& info, const RunSummary& summary, bool charts);
[[nodiscard]] std::string page_replay(const RunReplay& replay);
[[nodiscard]] std::string page_effects(const RunInfo& info, const RunSummary& summary);
[[nodiscard]] std::string page_machine(const RunInfo& info);
[[nodiscard]] std::string page_run(const RunInfo& info);

}  // namespace odds::report
