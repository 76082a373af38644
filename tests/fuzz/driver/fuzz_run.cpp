// One loop for all.
#include "fuzz_run.hpp"

#include <unistd.h>

#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

namespace odds::fuzz {
namespace {

char current[96] = "";  // read by the signal's handler

extern "C" void report_hang(int) {
  const char text[] = "\nhang at input ";
  (void)!write(STDERR_FILENO, text, sizeof text - 1);
  (void)!write(STDERR_FILENO, current, std::strlen(current));
  (void)!write(STDERR_FILENO, "\n", 1);
  _exit(1);
}

/// A line on stderr from time to time: short runs say nothing, long ones how long they will take.
class Progress {
 public:
  explicit Progress(std::uint64_t count) : count_(count) {}

  void show(std::uint64_t done) {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::seconds(10)) return;
    last_ = now;
    const double passed_s = std::chrono::duration<double>(now - start_).count();
    const double left_s = passed_s / static_cast<double>(done) * static_cast<double>(count_ - done);
    std::fprintf(stderr, "%llu of %llu inputs (%.1f %%) after %.0f s, %.0f s to go\n",
                 static_cast<unsigned long long>(done), static_cast<unsigned long long>(count_),
                 100.0 * static_cast<double>(done) / static_cast<double>(count_), passed_s, left_s);
  }

 private:
  std::uint64_t count_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_ = start_;
};

}  // namespace

bool read_options(int argc, char** argv, bool has_seeds, RunOptions& options) {
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string_view name = argv[i];
    const std::string_view value = argv[i + 1];
    if (has_seeds && name == "--write-seeds") {
      options.write_seeds = value;
      continue;
    }
    std::uint64_t* const number = name == "--count"   ? &options.count
                                  : name == "--seed"  ? &options.seed
                                  : name == "--first" ? &options.first
                                                      : nullptr;
    if (number == nullptr) return false;
    const auto [end, status] = std::from_chars(value.data(), value.data() + value.size(), *number);
    if (status != std::errc{} || end != value.data() + value.size()) return false;
  }
  return argc % 2 == 1;
}

bool run_inputs(const RunOptions& options, unsigned hang_s, const std::string& failure_file,
                const std::function<Judged(std::uint64_t n)>& judge) {
  constexpr std::uint64_t inputs_per_alarm = 64;  // a system call for each would be felt
  Progress progress(options.count);
  std::signal(SIGALRM, &report_hang);
  for (std::uint64_t n = options.first; n < options.first + options.count; ++n) {
    std::snprintf(current, sizeof current, "%llu of seed %llu", static_cast<unsigned long long>(n),
                  static_cast<unsigned long long>(options.seed));
    const std::uint64_t done = n - options.first;
    if (done % inputs_per_alarm == 0) {
      alarm(hang_s);
      if (done > 0) progress.show(done);
    }
    const Judged judged = judge(n);
    if (judged.wrong.empty()) continue;
    std::ofstream(failure_file, std::ios::binary) << judged.content;
    std::fprintf(stderr, "input %s (written to %s): %s\n", current, failure_file.c_str(), judged.wrong.c_str());
    return false;
  }
  alarm(0);
  return true;
}

void write_seed_files(const std::string& folder, const std::vector<SeedFile>& seeds) {
  for (const SeedFile& seed : seeds) {
    const std::filesystem::path place = std::filesystem::path(folder) / seed.folder;
    std::filesystem::create_directories(place);
    std::ofstream(place / seed.name, std::ios::binary) << seed.content;
  }
}

}  // namespace odds::fuzz
