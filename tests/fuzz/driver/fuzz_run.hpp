// What the fuzzers without libFuzzer share: their options, the numbers of their inputs, the watch for hangs.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace odds::fuzz {

struct RunOptions {
  std::uint64_t count = 20000;
  std::uint64_t seed = 1;
  std::uint64_t first = 0;
  std::string write_seeds;  ///< folder; empty: inputs are to be run
};

/// Reads --count, --seed, --first and, if `has_seeds`, --write-seeds. False if anything else is there.
[[nodiscard]] bool read_options(int argc, char** argv, bool has_seeds, RunOptions& options);

/// What one input came to: its bytes, and what is wrong; empty if nothing.
struct Judged {
  std::string content;
  std::string wrong;
};

/// Judges the inputs one after the other. An input on which more than `hang_s` seconds pass ends the program; one with
/// something wrong is written to `failure_file` and ends the run. Both are named on stderr; so is, every ten seconds,
/// how far the run is. True if all are good.
[[nodiscard]] bool run_inputs(const RunOptions& options, unsigned hang_s, const std::string& failure_file,
                              const std::function<Judged(std::uint64_t n)>& judge);

/// A file of libFuzzer's corpus.
struct SeedFile {
  std::string folder;  ///< below the one that was asked for; may be empty
  std::string name;
  std::string content;
};
void write_seed_files(const std::string& folder, const std::vector<SeedFile>& seeds);

}  // namespace odds::fuzz
