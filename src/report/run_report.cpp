// Puts the files of a run into their directory.
#include "odds/report/run_report.hpp"

#include <sstream>

#include "odds/report/hgrm.hpp"
#include "report/page_assets.hpp"
#include "report/run_files.hpp"
#include "report/write_file.hpp"

namespace odds::report {
namespace {

std::string hgrm_text(const Histogram& histogram) {
  std::ostringstream text;
  write_hgrm(text, histogram);
  return text.str();
}

/// As write_file, of what is written piece by piece.
template <class Write>
std::optional<Error> write_pieces(const std::filesystem::path& path, const Write& write) {
  Result<mesh::OutputFile> file = mesh::OutputFile::open(path);
  if (!file.ok()) return file.error();
  write(file.value());
  return file.value().commit();
}

std::optional<Error> write_log(const std::filesystem::path& path, const RunInfo& info,
                               std::span<const haptics::TickRecord> ticks) {
  return write_pieces(path, [&](mesh::OutputFile& file) {
    mesh::OutputStream out(file);
    write_hlog_head(out, info.started_epoch_s);
    for_each_second(info, ticks, [&](const HlogInterval& interval) { write_hlog_interval(out, interval); });
  });
}

}  // namespace

bool pages_have_charts() noexcept { return !chart_library_version().empty(); }
bool pages_have_replay() noexcept { return !replay_library_version().empty(); }

Result<RunFiles> write_run_report(const std::filesystem::path& directory, const RunInfo& info,
                                  const RunSummary& summary, std::span<const haptics::TickRecord> ticks,
                                  const RunReplay* replay) {
  std::error_code code;
  std::filesystem::create_directories(directory, code);
  if (code) return Error{directory.string(), "", "cannot be made: " + code.message(), "choose another directory"};
  const RunFiles files{directory / "report.html",  directory / "ticks.csv", directory / "summary.json",
                       directory / "latency.hgrm", directory / "wake.hgrm", directory / "query.hgrm",
                       directory / "latency.hlog"};
  const auto all_ticks = [&](mesh::OutputFile& file) { write_ticks_csv(file, ticks); };
  if (auto error = write_pieces(files.ticks, all_ticks)) return *error;
  if (auto error = write_file(files.summary, summary_json(info, summary))) return *error;
  if (auto error = write_file(files.tick_latency, hgrm_text(summary.tick))) return *error;
  if (auto error = write_file(files.wake_latency, hgrm_text(summary.wake))) return *error;
  if (auto error = write_file(files.query_time, hgrm_text(summary.query_gross))) return *error;
  if (auto error = write_log(files.log, info, ticks)) return *error;
  if (auto error = write_file(files.page, page(info, summary, ticks, replay))) return *error;
  return files;
}

}  // namespace odds::report
