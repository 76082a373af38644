// Writes the files that a run leaves behind.
#pragma once

#include <filesystem>
#include <span>

#include "odds/haptics/tick_record.hpp"
#include "odds/math/error.hpp"
#include "odds/report/run_info.hpp"
#include "odds/report/run_replay.hpp"
#include "odds/report/run_summary.hpp"

namespace odds::report {

/// Where each file went.
struct RunFiles {
  std::filesystem::path page;          ///< report.html: one file, opens offline
  std::filesystem::path ticks;         ///< ticks.csv: every record, units in the heading
  std::filesystem::path summary;       ///< summary.json: the figures, for programs
  std::filesystem::path tick_latency;  ///< latency.hgrm: from the planned start to the force; microseconds
  std::filesystem::path wake_latency;  ///< wake.hgrm: from the planned start to the wake-up
  std::filesystem::path query_time;    ///< query.hgrm: gross time of a tick's queries
  std::filesystem::path log;           ///< latency.hlog: the three of them, second by second
};

/// Writes all files into `directory`, which is made if need be; files of an earlier run are replaced. `summary` must be
/// summarize(info, ticks). The loop must have ended: this reads files of the system, allocates and takes its time.
/// With `replay` the page shows the run in three dimensions, if a library for that was found when this program was
/// built. Errors name the file that could not be written.
[[nodiscard]] Result<RunFiles> write_run_report(const std::filesystem::path& directory, const RunInfo& info,
                                                const RunSummary& summary, std::span<const haptics::TickRecord> ticks,
                                                const RunReplay* replay = nullptr);

/// Whether report pages have charts, that is whether a chart library was found when this program was built.
[[nodiscard]] bool pages_have_charts() noexcept;
/// The same of the library for the replay.
[[nodiscard]] bool pages_have_replay() noexcept;

}  // namespace odds::report
