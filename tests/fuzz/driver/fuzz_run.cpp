// One loop for all.
#include "fuzz_run.hpp"

#include <unistd.h>

#include <charconv>
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
  std::signal(SIGALRM, &report_hang);
  for (std::uint64_t n = options.first; n < options.first + options.count; ++n) {
    std::snprintf(current, sizeof current, "%llu of seed %llu", static_cast<unsigned long long>(n),
                  static_cast<unsigned long long>(options.seed));
    if ((n - options.first) % inputs_per_alarm == 0) alarm(hang_s);
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
