// odds_fuzz_readers: feeds random and mutated files to the mesh readers and checks memory, results and errors.
#include <algorithm>
#include <cstdio>
#include <map>
#include <string>

#include "check_reading.hpp"
#include "counted_memory.hpp"
#include "fuzz_run.hpp"
#include "mutator.hpp"

namespace odds::fuzz {
namespace {

constexpr unsigned hang_seconds = 60;  // no input of a few hundred bytes needs a millisecond; a machine may be busy
constexpr std::size_t bound_constant = std::size_t{64} << 20;

struct Totals {
  std::uint64_t meshes = 0, errors = 0, padded = 0;
  std::size_t largest_input = 0, largest_peak = 0;
  std::map<std::string, std::uint64_t> errors_by_kind;
};

std::optional<mesh::Format> format_named(const std::string& name) {
  if (name == "obj") return mesh::Format::obj;
  if (name == "stl") return mesh::Format::stl;
  if (name == "ply") return mesh::Format::ply;
  if (name == "off") return mesh::Format::off;
  return std::nullopt;
}

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

/// The same file made longer than the readers' window by a comment or a long name, so that the window slides over what
/// follows; empty where the format has none or the content is not text.
std::string padded(const Input& input, std::uint64_t n) {
  const std::string& text = input.content;
  const std::string filling((std::size_t{1} << 18) - n % 700, 'c');
  const bool control =
      std::any_of(text.begin(), text.end(), [](char c) { return c >= 0 && c < ' ' && c != '\n' && c != '\t'; });
  if (input.format == "obj" && !text.starts_with("\x1f\x8b")) return "# " + filling + "\n" + text;
  if (input.format == "off" && !text.starts_with("\x1f\x8b")) return "# " + filling + "\n" + text;
  if (input.format == "ply" && text.starts_with("ply\n")) return "ply\ncomment " + filling + text.substr(3);
  if (input.format == "stl" && text.starts_with("solid ") && !control) {
    return "solid " + filling + text.substr(6);
  }
  return "";
}

bool same(const Result<mesh::TriangleMesh>& a, const Result<mesh::TriangleMesh>& b) {
  if (a.ok() != b.ok()) return false;
  if (!a.ok()) return true;
  const auto equal = [](auto x, auto y) { return std::equal(x.begin(), x.end(), y.begin(), y.end()); };
  return equal(a.value().vertices(), b.value().vertices()) && equal(a.value().triangles(), b.value().triangles());
}

/// An error's words without what they quote and count.
std::string kind_of(const std::string& what) {
  std::string kind;
  bool quoted = false;
  for (const char c : what) {
    if (c == '\'') quoted = !quoted;
    if (!quoted && (c < '0' || c > '9')) kind += c;
  }
  return kind.substr(0, 60);
}

/// What is wrong with the readers on this input; empty if nothing.
std::string judge(const Input& input, std::uint64_t n, Totals& totals) {
  const std::string name = n % 3 == 0 || input.format.empty() ? "input" : "input." + input.format;
  const std::span<const std::byte> bytes = bytes_of(input.content);
  restart_peak();
  const auto result = mesh::read_from_memory(bytes, std::nullopt, name);
  const std::size_t peak = peak_bytes();
  totals.largest_input = std::max(totals.largest_input, bytes.size());
  totals.largest_peak = std::max(totals.largest_peak, peak);
  ++(result.ok() ? totals.meshes : totals.errors);
  if (!result.ok()) {
    ++totals.errors_by_kind[kind_of(result.error().what)];
  }
  if (peak > 10 * bytes.size() + bound_constant) return "memory: " + std::to_string(peak) + " bytes";
  if (std::string found = complaint(result, bytes, name); !found.empty()) return found;
  // Every reader must stand every content, whatever it looks like.
  const auto forced_format = static_cast<mesh::Format>(n % 4);
  const auto forced = mesh::read_from_memory(bytes, forced_format, name);
  if (std::string found = complaint(forced, bytes, name); !found.empty()) return "forced: " + found;
  if (n % 200 != 0) return "";
  const std::string longer = padded(input, n / 200);
  if (longer.empty()) return "";
  ++totals.padded;
  const auto format = format_named(input.format);
  if (!same(mesh::read_from_memory(bytes, format, name), mesh::read_from_memory(bytes_of(longer), format, name))) {
    return "a long comment in front changes the result";
  }
  return "";
}

void write_seeds(const std::string& folder) {
  std::vector<SeedFile> files;
  for (const Seed& seed : seeds()) {
    for (const std::string& target : {"read_" + seed.format, std::string("read_any")}) {
      files.push_back({target, seed.format + "_" + seed.title, seed.content});
    }
  }
  write_seed_files(folder, files);
}

int run(const RunOptions& options) {
  Mutator mutator(options.seed);
  Totals totals;
  const bool good = run_inputs(options, hang_seconds, "fuzz_failure.bin", [&](std::uint64_t n) {
    Input input = mutator.input(n);
    std::string wrong = judge(input, n, totals);
    if (!wrong.empty()) wrong = input.format + ": " + wrong;
    return Judged{std::move(input.content), std::move(wrong)};
  });
  if (!good) return 1;
  std::printf("%llu inputs (seed %llu): %llu meshes, %llu errors of %zu kinds, %llu also read with a sliding window\n",
              static_cast<unsigned long long>(options.count), static_cast<unsigned long long>(options.seed),
              static_cast<unsigned long long>(totals.meshes), static_cast<unsigned long long>(totals.errors),
              totals.errors_by_kind.size(), static_cast<unsigned long long>(totals.padded));
  std::printf("largest input %zu bytes, greatest memory %zu bytes (bound: 10 x input + 64 MiB)\n", totals.largest_input,
              totals.largest_peak);
  for (const auto& [kind, count] : totals.errors_by_kind) {
    std::printf("%9llu  %s\n", static_cast<unsigned long long>(count), kind.c_str());
  }
  return 0;
}

}  // namespace
}  // namespace odds::fuzz

int main(int argc, char** argv) {
  odds::fuzz::RunOptions options;
  if (!odds::fuzz::read_options(argc, argv, true, options)) {
    std::fprintf(
        stderr,
        "usage: odds_fuzz_readers [--count N] [--seed S] [--first N]\n"
        "       odds_fuzz_readers --write-seeds FOLDER   (for libFuzzer's targets)\n"
        "Feeds N inputs, from the first on, to the mesh readers. Exit status 1 and fuzz_failure.bin if one fails.\n");
    return 2;
  }
  if (!options.write_seeds.empty()) {
    odds::fuzz::write_seeds(options.write_seeds);
    return 0;
  }
  return odds::fuzz::run(options);
}
