// Puts the files of a run into their directory.
#include "odds/report/run_report.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>

#include "odds/report/hgrm.hpp"
#include "report/page_assets.hpp"
#include "report/run_files.hpp"

namespace odds::report {
namespace {

std::optional<Error> write_file(const std::filesystem::path& path, const std::string& text) {
  // Written beside its place and then put there: a full disk leaves no half file, and of two runs into one directory
  // the later wins whole.
  const std::filesystem::path part = path.string() + ".part" + std::to_string(getpid());
  errno = 0;
  std::ofstream file(part, std::ios::binary | std::ios::trunc);
  file << text;
  file.close();
  if (file && std::rename(part.c_str(), path.c_str()) == 0) return std::nullopt;
  const int reason = errno;
  std::remove(part.c_str());
  return Error{path.string(), "", std::string("cannot be written: ") + std::strerror(reason != 0 ? reason : EIO),
               "check the directory's permissions and the space left"};
}

std::string hgrm_text(const Histogram& histogram) {
  std::ostringstream text;
  write_hgrm(text, histogram);
  return text.str();
}

std::string hlog_text(const Hlog& log) {
  std::ostringstream text;
  write_hlog(text, log);
  return text.str();
}

}  // namespace

bool pages_have_charts() noexcept { return !chart_library_version().empty(); }

Result<RunFiles> write_run_report(const std::filesystem::path& directory, const RunInfo& info,
                                  const RunSummary& summary, std::span<const haptics::TickRecord> ticks) {
  std::error_code code;
  std::filesystem::create_directories(directory, code);
  if (code) return Error{directory.string(), "", "cannot be made: " + code.message(), "choose another directory"};
  const RunFiles files{directory / "report.html",  directory / "ticks.csv", directory / "summary.json",
                       directory / "latency.hgrm", directory / "wake.hgrm", directory / "query.hgrm",
                       directory / "latency.hlog"};
  if (auto error = write_file(files.ticks, ticks_csv(ticks))) return *error;
  if (auto error = write_file(files.summary, summary_json(info, summary))) return *error;
  if (auto error = write_file(files.tick_latency, hgrm_text(summary.tick))) return *error;
  if (auto error = write_file(files.wake_latency, hgrm_text(summary.wake))) return *error;
  if (auto error = write_file(files.query_time, hgrm_text(summary.query_gross))) return *error;
  if (auto error = write_file(files.log, hlog_text(latency_log(info, ticks)))) return *error;
  if (auto error = write_file(files.page, page(info, summary, ticks))) return *error;
  return files;
}

}  // namespace odds::report
