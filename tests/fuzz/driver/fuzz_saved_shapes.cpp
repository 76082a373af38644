// odds_fuzz_saved_shapes: alters saved shapes, makes their checksums right again, and asks what can still be loaded.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "check_saved_shape.hpp"
#include "fuzz_run.hpp"
#include "odds/math/random.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "support/saved_bytes.hpp"

namespace odds::fuzz {
namespace {

constexpr unsigned hang_seconds = 60;  // an input needs some milliseconds; a machine may be busy

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
    random_ = math::Random(seed_, n);
    std::string bytes = files_[random_.below(files_.size())];
    for (std::uint64_t i = 1 + random_.below(4); i > 0; --i) mutate(bytes);
    testing::reseal(bytes);
    return bytes;
  }

 private:
  /// A word of a random section, so that small sections are met as often as large ones; sometimes of the header.
  std::size_t place(const std::string& bytes) {
    const tree::SavedHeader header = testing::header_of(bytes);
    // What was altered before may stand in the header itself.
    const std::uint64_t sections = std::min<std::uint64_t>(header.section_count, header.sections.size());
    const std::uint64_t which = random_.below(sections + 1);
    if (which == sections) return 16 + 4 * random_.below((sizeof header - 16) / 4);
    const tree::SectionEntry& entry = header.sections[which];
    const std::size_t words = entry.count * entry.record_bytes / 4;
    const std::size_t at = entry.offset + 4 * random_.below(words == 0 ? 1 : words);
    return at <= bytes.size() - 4 ? at : 16;
  }

  void mutate(std::string& bytes) {
    static constexpr std::array<std::uint32_t, 16> words = {
        0U,          1U,          2U,          7U,          0xFFFFFFFFU, 0x80000000U, 0x7F800000U, 0xFFC00000U,
        0x7F7FFFFFU, 0xFF7FFFFFU, 0x00000001U, 0x3F800000U, 0x70000000U, 0xF0000000U, 0x08000001U, 0x01000000U};
    const std::size_t at = place(bytes);
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + at, sizeof word);
    switch (random_.below(5)) {
      case 0:
        word ^= 1U << random_.below(32);
        break;
      case 1:
        word += static_cast<std::uint32_t>(random_.below(9)) - 4U;
        break;
      case 2:
        word = static_cast<std::uint32_t>(random_.bits());
        break;
      case 3:
        std::memcpy(&word, bytes.data() + place(bytes), sizeof word);
        break;
      default:
        word = words[random_.below(words.size())];
    }
    std::memcpy(bytes.data() + at, &word, sizeof word);
  }

  std::uint64_t seed_;
  std::vector<std::string> files_;
  math::Random random_{0};
};

void write_seeds(const std::string& folder) {
  std::vector<SeedFile> files;
  for (std::string& bytes : seeds()) files.push_back({"", std::to_string(files.size()), std::move(bytes)});
  write_seed_files(folder, files);
}

int run(const RunOptions& options) {
  Mutator mutator(options.seed, seeds());
  std::uint64_t loaded = 0;
  const bool good = run_inputs(options, hang_seconds, "fuzz_failure.odds", [&](std::uint64_t n) {
    std::string bytes = mutator.input(n);
    bool is_loaded = false;
    std::string wrong = complaint_about_shape(testing::bytes_of(bytes), &is_loaded);
    loaded += is_loaded ? 1 : 0;
    return Judged{std::move(bytes), std::move(wrong)};
  });
  if (!good) return 1;
  std::printf("%llu altered files with right checksums: %llu loaded and asked, the others refused\n",
              static_cast<unsigned long long>(options.count), static_cast<unsigned long long>(loaded));
  // Neither alone would test much.
  return loaded * 20 > options.count && loaded < options.count ? 0 : 1;
}

}  // namespace
}  // namespace odds::fuzz

int main(int argc, char** argv) {
  odds::fuzz::RunOptions options;
  if (!odds::fuzz::read_options(argc, argv, true, options)) {
    std::fprintf(stderr,
                 "usage: odds_fuzz_saved_shapes [--count N] [--seed S] [--first N]\n"
                 "       odds_fuzz_saved_shapes --write-seeds FOLDER   (for libFuzzer's target)\n"
                 "Exit status 1 if an input fails, which is then in fuzz_failure.odds.\n");
    return 2;
  }
  if (!options.write_seeds.empty()) {
    odds::fuzz::write_seeds(options.write_seeds);
    return 0;
  }
  return odds::fuzz::run(options);
}
