// The contents of a run's files, as text.
#pragma once

#include <span>
#include <string>

#include "odds/haptics/tick_record.hpp"
#include "odds/report/hlog.hpp"
#include "odds/report/run_info.hpp"
#include "odds/report/run_replay.hpp"
#include "odds/report/run_summary.hpp"

namespace odds::report {

[[nodiscard]] std::string ticks_csv(std::span<const haptics::TickRecord> ticks);
[[nodiscard]] std::string summary_json(const RunInfo& info, const RunSummary& summary);
/// Wake-up, query and tick latencies of each second.
[[nodiscard]] Hlog latency_log(const RunInfo& info, std::span<const haptics::TickRecord> ticks);
/// The numbers behind the page's charts, as JSON that is safe inside a script element.
[[nodiscard]] std::string page_data(const RunInfo& info, const RunSummary& summary,
                                    std::span<const haptics::TickRecord> ticks);
/// What the replay shows, as JSON that is safe inside a script element.
[[nodiscard]] std::string replay_data(const RunInfo& info, const RunReplay& replay,
                                      std::span<const haptics::TickRecord> ticks);
/// The whole page. `replay` may be null.
[[nodiscard]] std::string page(const RunInfo& info, const RunSummary& summary,
                               std::span<const haptics::TickRecord> ticks, const RunReplay* replay);

}  // namespace odds::report
