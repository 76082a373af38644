// odds_bench_pages: the same queries of a shape that was built, whose tree stands in large pages, and of its saved
// copy, which is copied in small ones. Passes through all poses take turns, so that no pose finds its own way warm, and
// both have the same of what else the machine does.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <stdexcept>

#include "benchmark/mesh_argument.hpp"
#include "benchmark/peer_times.hpp"
#include "benchmark/pose_class.hpp"
#include "odds/query/pair.hpp"
#include "odds/query/saved_shape.hpp"
#include "support/cache_emptier.hpp"
#include "support/value_or_throw.hpp"

namespace odds::benchmark {
namespace {

using testing::value_or_throw;

struct Settings {
  std::vector<std::string> meshes{"made:car_body:triangles=60000", "made:car_body:triangles=1000000"};
  std::size_t poses = 150;
  std::size_t passes = 40;
  std::uint64_t seed = 1;
};

std::shared_ptr<const query::Shape> saved_copy(const query::Shape& shape) {
  const auto path = std::filesystem::temp_directory_path() / ("odds_pages_" + std::to_string(getpid()) + ".odds");
  if (const auto error = query::save_shape(shape, path)) throw std::runtime_error(error->message());
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> bytes(std::istreambuf_iterator<char>(file), {});
  std::filesystem::remove(path);
  return value_or_throw(query::load_shape(std::as_bytes(std::span(bytes)), path.string()));
}

/// A row: the mean over the poses of the medians over the passes, of both.
void compare(const char* name, std::array<query::Pair*, 2> pairs, const std::vector<math::Pose>& poses, bool cold,
             std::size_t passes) {
  std::array<std::vector<std::vector<double>>, 2> us;
  for (auto& of_pair : us) of_pair.resize(poses.size());
  testing::CacheEmptier emptier;
  for (std::size_t pass = 0; pass < passes; ++pass) {
    for (std::size_t turn = 0; turn < 2; ++turn) {
      const std::size_t which = (pass + turn) % 2;
      for (std::size_t i = 0; i < poses.size(); ++i) {
        pairs[which]->reset();
        if (cold) emptier.run();
        const double start = clock_us(CLOCK_MONOTONIC);
        static_cast<void>(pairs[which]->run(poses[i], {}));
        us[which][i].push_back(clock_us(CLOCK_MONOTONIC) - start);
      }
    }
  }
  std::array<double, 2> mean = {};
  for (std::size_t which = 0; which < 2; ++which) {
    for (auto& of_pose : us[which]) mean[which] += quantile(of_pose, 0.5) / static_cast<double>(poses.size());
  }
  std::printf("  %-8s %-14s %9.2f %9.2f %7.3f\n", name, cold ? "emptied caches" : "", mean[0], mean[1],
              mean[0] / mean[1]);
  std::fflush(stdout);
}

void measure(const std::string& name, const Settings& settings) {
  const auto mesh = value_or_throw(mesh_of(name));
  const auto built = value_or_throw(query::Shape::build(mesh));
  const auto copied = saved_copy(*built);
  query::Pair large = value_or_throw(query::Pair::make(built, built));
  query::Pair small = value_or_throw(query::Pair::make(copied, copied));
  const auto collides = [&](const math::Pose& pose) {
    return large.run(pose, {.method = query::Method::exact, .max_contacts = 0}).verdict == query::Verdict::hit;
  };
  std::printf("%s, %zu triangles, with its own copy; microseconds of a verdict and a contact\n", name.c_str(),
              mesh->triangles().size());
  std::printf("  %-23s %9s %9s %7s\n", "", "built", "copied", "ratio");
  for (const PoseClass pose_class : {PoseClass::near, PoseClass::touch, PoseClass::shallow}) {
    const auto poses = make_poses({mesh, mesh}, pose_class, settings.poses, settings.seed, collides);
    for (const bool cold : {false, true}) {
      compare(benchmark::name(pose_class).data(), {&large, &small}, poses, cold, settings.passes);
    }
  }
}

}  // namespace
}  // namespace odds::benchmark

int main(int argc, char** argv) {
  CLI::App app{"Queries of shapes whose trees stand in large and in small pages of memory"};
  odds::benchmark::Settings settings;
  app.add_option("meshes", settings.meshes, "files, or made ones")->capture_default_str();
  app.add_option("--poses", settings.poses, "of each class")->check(CLI::Range(1, 100000))->capture_default_str();
  app.add_option("--passes", settings.passes, "through all poses")->check(CLI::Range(1, 10000))->capture_default_str();
  app.add_option("--seed", settings.seed, "of the poses")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    for (const std::string& mesh : settings.meshes) odds::benchmark::measure(mesh, settings);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
