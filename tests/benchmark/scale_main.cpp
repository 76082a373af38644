// odds_bench_scale: what a query costs against the number of triangles, in one plot.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "benchmark/peer_times.hpp"
#include "benchmark/pose_class.hpp"
#include "benchmark/scale_plot.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"
#include "odds/query/saved_shape.hpp"
#include "support/value_or_throw.hpp"

namespace odds::benchmark {
namespace {

using testing::value_or_throw;

struct Settings {
  std::string shape = "torus_knot";
  std::vector<std::uint64_t> triangles = {1000, 3000, 10000, 30000, 100000, 300000, 1000000, 3000000, 10000000};
  std::size_t poses = 200;
  std::size_t passes = 5;
  std::uint64_t seed = 1;
  std::string svg;
};

constexpr std::array<PoseClass, 3> classes = {PoseClass::near, PoseClass::touch, PoseClass::shallow};
constexpr std::array<const char*, 3> colors = {"#1b7f5c", "#b8471b", "#3a5fb0"};

/// About so many triangles of the shape; those of a knot's tube stay about equilateral.
std::string argument_for(const std::string& shape, std::uint64_t triangles) {
  if (shape == "car_body") return "made:car_body:triangles=" + std::to_string(triangles);
  const double across = std::max(6.0, std::round(std::sqrt(static_cast<double>(triangles) / 104.0)));
  const double along = std::round(static_cast<double>(triangles) / (2.0 * across));
  return "made:torus_knot:along=" + std::to_string(static_cast<int>(along)) +
         ",across=" + std::to_string(static_cast<int>(across));
}

/// Milliseconds of all processors that it takes to check and map a saved copy, the least of a few.
double load_ms(const query::Shape& shape) {
  const auto path = std::filesystem::temp_directory_path() / ("odds_scale_" + std::to_string(getpid()) + ".odds");
  if (const auto error = query::save_shape(shape, path)) throw std::runtime_error(error->message());
  double least = INFINITY;
  for (int i = 0; i < 7; ++i) {
    const double start = clock_us(CLOCK_PROCESS_CPUTIME_ID);
    static_cast<void>(value_or_throw(query::load_shape(path)));
    least = std::min(least, 1e-3 * (clock_us(CLOCK_PROCESS_CPUTIME_ID) - start));
  }
  std::filesystem::remove(path);
  return least;
}

/// Microseconds of each pose: the median over passes through all of them, so that no pose finds its own way warm.
std::vector<double> time_poses(query::Pair& pair, const std::vector<math::Pose>& poses, std::size_t passes) {
  std::vector<double> empty;
  for (int i = 0; i < 1001; ++i) {
    const double start = clock_us(CLOCK_THREAD_CPUTIME_ID);
    empty.push_back(clock_us(CLOCK_THREAD_CPUTIME_ID) - start);
  }
  const double reading_us = quantile(std::move(empty), 0.5);
  query::Request request;
  request.method = query::Method::exact;
  request.max_contacts = 0;
  std::vector<std::vector<double>> times(poses.size());
  for (std::size_t pass = 0; pass < passes; ++pass) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      pair.reset();
      const double start = clock_us(CLOCK_THREAD_CPUTIME_ID);
      static_cast<void>(pair.run(poses[i], request));
      times[i].push_back(std::max(1e-3, clock_us(CLOCK_THREAD_CPUTIME_ID) - start - reading_us));
    }
  }
  std::vector<double> medians;
  for (auto& of_pose : times) medians.push_back(quantile(std::move(of_pose), 0.5));
  return medians;
}

double mean_work(query::Pair& pair, const std::vector<math::Pose>& poses) {
  double units = 0.0;
  for (const math::Pose& pose : poses) {
    const query::Cost& cost = pair.run(pose, {.method = query::Method::exact, .max_contacts = 0}).cost;
    units += static_cast<double>(cost.node_pairs + cost.triangle_pairs);
  }
  return units / static_cast<double>(poses.size());
}

/// One size: a row of the table, a point of each line.
void measure(const Settings& settings, std::uint64_t triangles, std::vector<ScaleLine>& lines) {
  const std::string argument = argument_for(settings.shape, triangles);
  const auto mesh = std::make_shared<const mesh::TriangleMesh>(value_or_throw(mesh::made::make_shape(argument)));
  const double start = clock_us(CLOCK_PROCESS_CPUTIME_ID);
  const auto shape = value_or_throw(query::Shape::build(mesh));
  const double build_cpu_ms = 1e-3 * (clock_us(CLOCK_PROCESS_CPUTIME_ID) - start);
  const query::ShapeSummary& summary = shape->summary();
  const double count = static_cast<double>(summary.triangles);
  std::printf("%10zu %10.0f %9.1f %8.1f", summary.triangles, build_cpu_ms, load_ms(*shape),
              static_cast<double>(summary.bytes) / count);
  query::Pair pair = value_or_throw(query::Pair::make(shape, shape));
  const auto collides = [&](const math::Pose& pose) {
    return pair.run(pose, {.method = query::Method::exact, .max_contacts = 0}).verdict == query::Verdict::hit;
  };
  for (std::size_t c = 0; c < classes.size(); ++c) {
    const auto poses = make_poses({mesh, mesh}, classes[c], settings.poses, settings.seed, collides);
    const std::vector<double> times = time_poses(pair, poses, settings.passes);
    const double p50 = quantile(times, 0.5);
    const double p99 = quantile(times, 0.99);
    lines[2 * c].points.emplace_back(count, p50);
    lines[2 * c + 1].points.emplace_back(count, p99);
    std::printf("  | %7.2f %8.2f %8.0f", p50, p99, mean_work(pair, poses));
  }
  std::printf("\n");
  std::fflush(stdout);
}

void write_plot(const Settings& settings, std::vector<ScaleLine> lines) {
  const ScalePlot plot{"Exact verdict of two " + settings.shape + " meshes, by distance from first touch",
                       "triangles of each mesh", "microseconds of a query", std::move(lines)};
  std::ofstream file(settings.svg);
  if (!(file << svg_of(plot)).flush()) throw std::runtime_error(settings.svg + ": cannot be written");
}

void run(const Settings& settings) {
  std::vector<ScaleLine> lines;
  for (std::size_t c = 0; c < classes.size(); ++c) {
    const std::string word(name(classes[c]));
    lines.push_back({word + ", median", colors[c], false, {}});
    lines.push_back({word + ", p99", colors[c], true, {}});
  }
  std::printf("%10s %10s %9s %8s", "triangles", "build ms", "load ms", "B/tri");
  for (const PoseClass pose_class : classes) {
    std::printf("  | %7s %8s %8s", std::string(name(pose_class)).c_str(), "p99 us", "units");
  }
  std::printf("\n");
  for (const std::uint64_t triangles : settings.triangles) measure(settings, triangles, lines);
  if (!settings.svg.empty()) write_plot(settings, std::move(lines));
}

}  // namespace
}  // namespace odds::benchmark

int main(int argc, char** argv) {
  odds::benchmark::Settings settings;
  CLI::App app("What a query costs against the number of triangles: processor time, of the wide engine.");
  app.add_option("--shape", settings.shape, "made shape")
      ->check(CLI::IsMember({"torus_knot", "car_body"}))
      ->capture_default_str();
  app.add_option("--triangles", settings.triangles, "sizes of each mesh")->delimiter(',')->capture_default_str();
  app.add_option("--poses", settings.poses, "of each class")->check(CLI::Range(1, 1000000))->capture_default_str();
  app.add_option("--passes", settings.passes, "through all poses; the median of each counts")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--seed", settings.seed, "of the poses")->capture_default_str();
  app.add_option("--svg", settings.svg, "file for the plot");
  CLI11_PARSE(app, argc, argv);
  try {
    odds::benchmark::run(settings);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
  return 0;
}
