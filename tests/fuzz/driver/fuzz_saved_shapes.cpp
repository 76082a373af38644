// odds_fuzz_saved_shapes: alters saved shapes, makes their checksums right again, and asks what can still be loaded.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "check_saved_shape.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "support/saved_bytes.hpp"

namespace odds::fuzz {
namespace {

constexpr unsigned hang_seconds = 60;  // an input needs some milliseconds; a machine may be busy
char current[64] = "";

extern "C" void report_hang(int) {
  const char text[] = "\nhang at input ";
  (void)!write(STDERR_FILENO, text, sizeof text - 1);
  (void)!write(STDERR_FILENO, current, std::strlen(current));
  (void)!write(STDERR_FILENO, "\n", 1);
  _exit(1);
}

/// Every bounding volume, with polygons and without, of a closed and of a flat mesh.
std::vector<std::string> seeds() {
  std::vector<std::string> files;
  for (const char* name : {"made:bumpy_sphere:frequency=3", "made:plates:count=2,cells=3"}) {
    auto made = mesh::made::make_shape(name);
    const auto mesh = std::make_shared<const mesh::TriangleMesh>(std::move(made).value());
    for (std::size_t kind = 0; kind < volume::kind_names.size(); ++kind) {
      const auto shape = query::Shape::build(mesh, {.volume = static_cast<volume::Kind>(kind)}).value();
      files.push_back(testing::saved_bytes(*shape));
      files.push_back(testing::saved_bytes(*shape->without_polygons()));
    }
  }
  return files;
}

/// The n-th input of a seed does not depend on the others.
class Mutator {
 public:
  Mutator(std::uint64_t seed, std::vector<std::string> files) : seed_(seed), files_(std::move(files)) {}

  std::string input(std::uint64_t n) {
    state_ = seed_ * 0x9E3779B97F4A7C15ULL + n * 0xD1B54A32D192ED03ULL + 1;
    std::string bytes = files_[below(files_.size())];
    for (std::uint64_t i = 1 + below(4); i > 0; --i) mutate(bytes);
    testing::reseal(bytes);
    return bytes;
  }

 private:
  std::uint64_t random() {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t x = state_;
    x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
    return x ^ (x >> 31U);
  }
  std::uint64_t below(std::uint64_t bound) { return random() % bound; }

  /// A word of a random section, so that small sections are met as often as large ones; sometimes of the header.
  std::size_t place(const std::string& bytes) {
    const tree::SavedHeader header = testing::header_of(bytes);
    // What was altered before may stand in the header itself.
    const std::uint64_t sections = std::min<std::uint64_t>(header.section_count, header.sections.size());
    const std::uint64_t which = below(sections + 1);
    if (which == sections) return 16 + 4 * below((sizeof header - 16) / 4);
    const tree::SectionEntry& entry = header.sections[which];
    const std::size_t words = entry.count * entry.record_bytes / 4;
    const std::size_t at = entry.offset + 4 * below(words == 0 ? 1 : words);
    return at <= bytes.size() - 4 ? at : 16;
  }

  void mutate(std::string& bytes) {
    static constexpr std::array<std::uint32_t, 16> words = {
        0U,          1U,          2U,          7U,          0xFFFFFFFFU, 0x80000000U, 0x7F800000U, 0xFFC00000U,
        0x7F7FFFFFU, 0xFF7FFFFFU, 0x00000001U, 0x3F800000U, 0x70000000U, 0xF0000000U, 0x08000001U, 0x01000000U};
    const std::size_t at = place(bytes);
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + at, sizeof word);
    switch (below(5)) {
      case 0:
        word ^= 1U << below(32);
        break;
      case 1:
        word += static_cast<std::uint32_t>(below(9)) - 4U;
        break;
      case 2:
        word = static_cast<std::uint32_t>(random());
        break;
      case 3:
        std::memcpy(&word, bytes.data() + place(bytes), sizeof word);
        break;
      default:
        word = words[below(words.size())];
    }
    std::memcpy(bytes.data() + at, &word, sizeof word);
  }

  std::uint64_t seed_;
  std::vector<std::string> files_;
  std::uint64_t state_ = 0;
};

struct Options {
  std::uint64_t count = 5000;
  std::uint64_t seed = 1;
  std::uint64_t first = 0;
  std::string write_seeds;
};

bool read_options(int argc, char** argv, Options& options) {
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string_view name = argv[i];
    const std::string_view value = argv[i + 1];
    if (name == "--write-seeds") {
      options.write_seeds = value;
      continue;
    }
    std::uint64_t* number = nullptr;
    if (name == "--count") number = &options.count;
    if (name == "--seed") number = &options.seed;
    if (name == "--first") number = &options.first;
    if (number == nullptr || std::from_chars(value.data(), value.data() + value.size(), *number).ec != std::errc{}) {
      return false;
    }
  }
  return argc % 2 == 1;
}

void write_seeds(const std::string& folder) {
  std::filesystem::create_directories(folder);
  std::size_t number = 0;
  for (const std::string& bytes : seeds()) {
    std::ofstream(folder + "/" + std::to_string(number++), std::ios::binary) << bytes;
  }
}

int run(const Options& options) {
  Mutator mutator(options.seed, seeds());
  std::uint64_t loaded = 0;
  for (std::uint64_t n = options.first; n < options.first + options.count; ++n) {
    std::snprintf(current, sizeof current, "%llu", static_cast<unsigned long long>(n));
    alarm(hang_seconds);
    const std::string bytes = mutator.input(n);
    bool is_loaded = false;
    const std::string found = complaint_about_shape(testing::bytes_of(bytes), &is_loaded);
    if (!found.empty()) {
      std::fprintf(stderr, "input %s of seed %llu: %s\n", current, static_cast<unsigned long long>(options.seed),
                   found.c_str());
      return 1;
    }
    loaded += is_loaded ? 1 : 0;
  }
  alarm(0);
  std::printf("%llu altered files with right checksums: %llu loaded and asked, the others refused\n",
              static_cast<unsigned long long>(options.count), static_cast<unsigned long long>(loaded));
  // Neither alone would test much.
  return loaded * 20 > options.count && loaded < options.count ? 0 : 1;
}

}  // namespace
}  // namespace odds::fuzz

int main(int argc, char** argv) {
  odds::fuzz::Options options;
  if (!odds::fuzz::read_options(argc, argv, options)) {
    std::fprintf(stderr, "usage: odds_fuzz_saved_shapes [--count N] [--seed S] [--first N] [--write-seeds FOLDER]\n");
    return 2;
  }
  if (!options.write_seeds.empty()) {
    odds::fuzz::write_seeds(options.write_seeds);
    return 0;
  }
  std::signal(SIGALRM, odds::fuzz::report_hang);
  return odds::fuzz::run(options);
}
