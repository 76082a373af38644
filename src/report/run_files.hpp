// The contents of a run's files.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "mesh/output_file.hpp"
#include "odds/haptics/tick_record.hpp"
#include "odds/report/hlog.hpp"
#include "odds/report/run_info.hpp"
#include "odds/report/run_replay.hpp"
#include "odds/report/run_summary.hpp"

namespace odds::report {

[[nodiscard]] std::string summary_json(const RunInfo& info, const RunSummary& summary);
/// Hands on tick, wake-up and query latencies of each second, one histogram after the other: all of a long run's would
/// take more memory than its records.
void for_each_second(const RunInfo& info, std::span<const haptics::TickRecord> ticks,
                     const std::function<void(const HlogInterval&)>& take);
/// Writes a line for each record, without holding them all as text.
void write_ticks_csv(mesh::OutputFile& file, std::span<const haptics::TickRecord> ticks);
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
