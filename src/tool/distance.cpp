// `odds distance A B --poses POSES.csv --out DISTANCES.csv`: how far apart in each pose, and where nearest.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "odds/realtime/clock.hpp"
#include "tool/answer_table.hpp"
#include "tool/command.hpp"
#include "tool/pose_run.hpp"
#include "tool/progress_line.hpp"
#include "tool/shared_options.hpp"

namespace odds::tool {
namespace {

struct DistanceOptions {
  PoseRunArguments run;
  query::DistanceRequest request;
};

constexpr std::string_view header =
    "row,lower,upper,proved,ax,ay,az,bx,by,bz,triangle_a,triangle_b,node_pairs,triangle_pairs,wall_us\n";

std::string line_of(std::size_t row, const query::DistanceAnswer& answer, double wall_us) {
  std::string line = fmt::format("{},{},", row, answer.lower);
  if (answer.triangle_a == query::no_feature) {
    line += fmt::format(",{},,,,,,,,", answer.proved ? 1 : 0);
  } else {
    line += fmt::format("{},{},{},{},{},{},{},{},{},{}", answer.upper, answer.proved ? 1 : 0, answer.on_a.x(),
                        answer.on_a.y(), answer.on_a.z(), answer.on_b.x(), answer.on_b.y(), answer.on_b.z(),
                        answer.triangle_a, answer.triangle_b);
  }
  return line + fmt::format(",{},{},{:.3f}\n", answer.cost.node_pairs, answer.cost.triangle_pairs, wall_us);
}

void print_summary(std::vector<double> times, std::size_t proved, std::size_t found) {
  std::sort(times.begin(), times.end());
  fmt::print(stderr, "{} poses: {} proved, {} with nearest points; p50 {:.2f}, p99 {:.2f}, max {:.2f} us\n",
             times.size(), proved, found, percentile(times, 0.5), percentile(times, 0.99), times.back());
}

int run(const DistanceOptions& options) {
  Result<PoseRun> opened = PoseRun::open(options.run);
  if (!opened.ok()) return fail(opened.error());
  auto& [poses, out, pair] = opened.value();
  if (const auto error = refuse_polygon_free(pair.a(), options.run.pair.mesh_a)) return fail(*error);
  if (const auto error = refuse_polygon_free(pair.b(), options.run.pair.mesh_b)) return fail(*error);

  query::DistanceRequest request = options.request;
  request.budget = options.run.limited(request.budget);
  const realtime::Clock clock = realtime::fastest_clock();
  static_cast<void>(pair.distance(poses.front(), request));  // touches code and memory once
  std::vector<double> times;
  std::size_t proved = 0;
  std::size_t found = 0;
  out.write(header);
  ProgressLine progress("measuring");
  for (std::size_t row = 0; row < poses.size(); ++row) {
    const std::int64_t begin = clock();
    const query::DistanceAnswer answer = pair.distance(poses[row], request);
    times.push_back(1e-3 * static_cast<double>(clock() - begin));
    proved += answer.proved ? 1U : 0U;
    found += answer.triangle_a != query::no_feature ? 1U : 0U;
    out.write(line_of(row, answer, times.back()));
    if (row % 64 == 0) progress.show(static_cast<double>(row) / static_cast<double>(poses.size()));
  }
  if (const auto error = out.commit()) return fail(*error);
  print_summary(std::move(times), proved, found);
  return exit_good;
}

}  // namespace

void add_distance(CLI::App& app, Action& action) {
  const auto options = std::make_shared<DistanceOptions>();
  CLI::App* command =
      app.add_subcommand("distance", "Measure how far A and B are apart, for each pose of B in A's frame");
  add_pose_run_options(*command, options->run, "CSV of distances in metres; - for standard output");
  command->add_option("--within", options->request.within, "search no farther than this margin, metres, > 0")
      ->check(positive_and_finite());
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace odds::tool
