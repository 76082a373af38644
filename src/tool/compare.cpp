// odds compare: one scene under several budgets, and what each does to the force.
#include <fmt/core.h>

#include <memory>
#include <string>
#include <vector>

#include "odds/report/force_comparison.hpp"
#include "odds/scene/same_poses.hpp"
#include "odds/scene/scene.hpp"
#include "odds/scene/simulation.hpp"
#include "tool/build_progress.hpp"
#include "tool/command.hpp"
#include "tool/output_folder.hpp"
#include "tool/shared_options.hpp"

namespace odds::tool {
namespace {

struct CompareArguments {
  std::string scene;
  std::vector<double> budgets_us = {5.0, 20.0, 50.0, 100.0};
  std::optional<double> seconds;
  double touching_n = 0.05;
  std::string out = "odds_compare";
};

constexpr double nudge_m = 1e-9;  // far more than rounding, far less than anybody feels

scene::SimulationOptions options_of(const CompareArguments& arguments, BuildProgress& progress) {
  scene::SimulationOptions options;
  options.simulated_time = true;
  options.seconds = arguments.seconds;
  options.progress = [&](std::string_view what, double share) { progress.show(what, share); };
  return options;
}

/// The whole scene but the tool a little aside: what no budget has to do with.
scene::Scene nudged(scene::Scene scene) {
  for (scene::Body& body : scene.bodies) {
    if (!body.follows_device) body.pose.translation += Vec3::Constant(nudge_m);
  }
  return scene;
}

Result<report::ComparedRun> run_with(std::string name, scene::Scene scene, const query::Budget& budget,
                                     const CompareArguments& arguments) {
  report::ComparedRun run;
  run.name = std::move(name);
  scene.query.budget = budget;
  BuildProgress progress;
  auto made = scene::Simulation::make(std::move(scene), options_of(arguments, progress));
  progress.done();
  if (!made) return made.error();
  const scene::RunOutcome outcome = made.value()->run();
  std::uint64_t asked = 0;
  std::uint64_t proved = 0;
  double queries = 0.0;
  double units = 0.0;
  for (const haptics::TickRecord& tick : outcome.ticks) {
    if (tick.queries == 0) continue;
    ++asked;
    if (tick.basis == query::Basis::proved) ++proved;
    queries += tick.queries;
    units += static_cast<double>(tick.node_pairs + tick.triangle_pairs);
  }
  if (asked > 0) run.proved_share = static_cast<double>(proved) / static_cast<double>(asked);
  run.units_per_query = queries > 0.0 ? units / queries : 0.0;
  run.samples = report::force_samples(outcome.ticks, made.value()->scene().loop.period_ns);
  return run;
}

/// One difference for each budget: contact forces at the poses of the run without a limit.
Result<std::vector<report::ForceDifference>> at_same_poses(const scene::Scene& scene, std::size_t ticks,
                                                           const CompareArguments& arguments) {
  std::vector<query::Budget> budgets;
  for (const double us : arguments.budgets_us) budgets.push_back(query::Budget::time(us));
  BuildProgress progress;
  auto made = scene::SamePoses::make(scene, budgets, options_of(arguments, progress));
  progress.done();
  if (!made) return made.error();
  scene::SamePoses& runs = *made.value();
  std::vector<report::ForceSample> exact;
  std::vector<std::vector<report::ForceSample>> limited(budgets.size());
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    const std::int64_t now_ns = static_cast<std::int64_t>(tick) * scene.loop.period_ns;
    haptics::TickRecord record;
    runs.tick(now_ns, record);
    const double t_s = 1e-9 * static_cast<double>(now_ns);
    exact.push_back({t_s, runs.exact().force_n, runs.exact().contacts});
    for (std::size_t i = 0; i < budgets.size(); ++i) {
      limited[i].push_back({t_s, runs.limited(i).force_n, runs.limited(i).contacts});
    }
  }
  std::vector<report::ForceDifference> differences;
  for (const auto& samples : limited) {
    differences.push_back(report::compare_forces(exact, samples, arguments.touching_n, 1.0 / scene.loop.period_s()));
  }
  return differences;
}

std::string onset(const report::ForceDifference& d) {
  return fmt::format("onset p99 {} ({} of {} missed), where nothing touches at most {:.3g} N",
                     d.onset_p99_ticks ? fmt::format("{:.0f} ticks", *d.onset_p99_ticks) : "-", d.onsets_missed,
                     d.onsets, d.largest_false_n);
}

std::string errors(const report::ForceDifference& d) {
  if (d.ticks == 0) return "no force to compare";
  return fmt::format("force off by {:.2f} % (p95 {:.2f} %), {:.2f} degrees (p95 {:.2f})", 100.0 * d.error_p50,
                     100.0 * d.error_p95, d.angle_p50_deg, d.angle_p95_deg);
}

void print(const report::Comparison& comparison) {
  fmt::print("{}: force of contacts on the tool, in each tick at the pose of the run without a limit\n",
             comparison.scene);
  if (const std::string sentence = report::kept_frame(comparison); !sentence.empty()) fmt::print("{}\n", sentence);
  for (const report::ComparedRun& run : comparison.runs) {
    if (!run.at_same_poses) continue;
    const report::ForceDifference& d = *run.at_same_poses;
    fmt::print("  {:>20}: {}, {}, {} ticks missed in a row\n", run.name, errors(d), onset(d), d.missed_in_row);
  }
  const report::ForceDifference& exact = comparison.runs.front().difference;
  fmt::print(
      "force on the hand, each run on its own: {} ticks with at least {:.3g} N, mean {:.3g} N, own noise {:.3f} % "
      "({})\n",
      exact.ticks, comparison.touching_n, exact.mean_force_n, 100.0 * exact.noise_share,
      report::noise_band(comparison.rate_hz));
  for (const report::ComparedRun& run : comparison.runs) {
    const report::ForceDifference& d = run.difference;
    const std::string proved =
        run.proved_share ? fmt::format("{:5.1f} % of ticks proved", 100.0 * *run.proved_share) : "no query in any tick";
    fmt::print("  {:>20}: {}, {}, {:.3f} % added noise, {}\n", run.name, proved, errors(d), 100.0 * d.added_noise_share,
               onset(d));
  }
}

/// All runs of a comparison, without their differences.
std::optional<Error> run_all(const scene::Scene& scene, const CompareArguments& arguments,
                             report::Comparison& comparison) {
  const auto add = [&](std::string name, scene::Scene varied, const query::Budget& budget) -> std::optional<Error> {
    Result<report::ComparedRun> run = run_with(std::move(name), std::move(varied), budget, arguments);
    if (!run) return run.error();
    comparison.runs.push_back(std::move(run).value());
    return std::nullopt;
  };
  scene::Scene exact = scene;
  exact.query.carry_motion = 0.0;
  exact.frame = query::Budget::unlimited();
  if (auto error = add("no limit", exact, query::Budget::unlimited())) return error;
  if (auto error = add("1 nm aside", nudged(exact), query::Budget::unlimited())) return error;
  const std::size_t ticks = comparison.runs.front().samples.size();
  const Result<std::vector<report::ForceDifference>> differences = at_same_poses(scene, ticks, arguments);
  if (!differences) return differences.error();
  for (std::size_t i = 0; i < arguments.budgets_us.size(); ++i) {
    const double us = arguments.budgets_us[i];
    if (auto error = add(fmt::format("{} us", us), scene, query::Budget::time(us))) return error;
    comparison.runs.back().at_same_poses = differences.value()[i];
  }
  return std::nullopt;
}

int compare(const CompareArguments& arguments) {
  const Result<scene::Scene> scene = scene::read_scene(arguments.scene);
  if (!scene) return fail(scene.error());
  if (!scene.value().device) {
    return fail({arguments.scene, "", "the scene has no device, so there is no force on a hand to compare",
                 "add a [device.NAME] that a body follows"});
  }
  if (const auto error = prepare_folder(arguments.out, {})) return fail(*error);
  report::Comparison comparison;
  comparison.scene = arguments.scene;
  comparison.version = ODDS_VERSION;
  comparison.rate_hz = 1.0 / scene.value().loop.period_s();
  comparison.touching_n = arguments.touching_n;
  comparison.frame_work_units = scene::in_work_units(scene.value().frame).work_units;
  if (const auto error = run_all(scene.value(), arguments, comparison)) return fail(*error);
  for (report::ComparedRun& run : comparison.runs) {
    run.difference =
        report::compare_forces(comparison.runs.front().samples, run.samples, comparison.touching_n, comparison.rate_hz);
  }
  if (const auto error = report::write_comparison(arguments.out, comparison)) return fail(*error);
  print(comparison);
  fmt::print("report: {}/comparison.html\n", arguments.out);
  return exit_good;
}

}  // namespace

void add_compare(CLI::App& app, Action& action) {
  auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command = app.add_subcommand(
      "compare", "Compare one scene under several budgets in simulated time: force error, noise and onset of contact");
  command->add_option("scene", arguments->scene, "the scene, a TOML file with a device")->required();
  command
      ->add_option("--budgets-us", arguments->budgets_us,
                   "of a query, microseconds, as 20 work units each; a list like 5,20")
      ->delimiter(',')
      ->allow_extra_args(false)  // else the scene after it would be taken for another
      ->check(positive_and_finite())
      ->capture_default_str();
  command->add_option("--seconds", arguments->seconds, "how long to run (default: as the scene says)")
      ->check(positive_and_finite());
  command->add_option("--touching-n", arguments->touching_n, "forces are compared where the exact one is at least this")
      ->check(positive_and_finite())
      ->capture_default_str();
  command->add_option("--out", arguments->out, "directory for comparison.html and comparison.csv")
      ->capture_default_str();
  command->callback([&action, arguments] { action = [arguments] { return compare(*arguments); }; });
}

}  // namespace odds::tool
