// odds compare: one scene under several budgets, and what each does to the force.
#include <fmt/core.h>

#include <memory>
#include <string>
#include <vector>

#include "odds/report/force_comparison.hpp"
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

Result<report::ComparedRun> run_with(scene::Scene scene, std::optional<double> budget_us,
                                     const CompareArguments& arguments) {
  report::ComparedRun run;
  run.name = budget_us ? fmt::format("{} us", *budget_us) : "no limit";
  scene.query.budget = budget_us ? query::Budget::time(*budget_us) : query::Budget::unlimited();
  scene::SimulationOptions options;
  options.simulated_time = true;
  options.seconds = arguments.seconds;
  BuildProgress progress;
  options.progress = [&](std::string_view what, double share) { progress.show(what, share); };
  auto made = scene::Simulation::make(std::move(scene), options);
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
  run.proved_share = asked > 0 ? static_cast<double>(proved) / static_cast<double>(asked) : 1.0;
  run.units_per_query = queries > 0.0 ? units / queries : 0.0;
  run.samples = report::force_samples(outcome.ticks, made.value()->scene().loop.period_ns);
  return run;
}

void print(const report::Comparison& comparison) {
  const report::ForceDifference& exact = comparison.runs.front().difference;
  fmt::print("{}: {} ticks in contact, mean force {:.3g} N, own noise {:.3f} % (50-500 Hz)\n", comparison.scene,
             exact.ticks, exact.mean_force_n, 100.0 * exact.noise_share);
  for (const report::ComparedRun& run : comparison.runs) {
    const report::ForceDifference& d = run.difference;
    fmt::print(
        "  {:>9}: {:5.1f} % of ticks proved, force off by {:.2f} % (p95 {:.2f} %), {:.2f} degrees (p95 {:.2f}), "
        "{:.3f} % added noise, onset p99 {} ({} of {} missed)\n",
        run.name, 100.0 * run.proved_share, 100.0 * d.error_p50, 100.0 * d.error_p95, d.angle_p50_deg, d.angle_p95_deg,
        100.0 * d.added_noise_share, d.onset_p99_ticks ? fmt::format("{:.0f} ticks", *d.onset_p99_ticks) : "-",
        d.onsets_missed, d.onsets);
  }
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
  std::vector<std::optional<double>> budgets = {std::nullopt};
  budgets.insert(budgets.end(), arguments.budgets_us.begin(), arguments.budgets_us.end());
  for (const std::optional<double>& budget_us : budgets) {
    Result<report::ComparedRun> run = run_with(scene.value(), budget_us, arguments);
    if (!run) return fail(run.error());
    comparison.runs.push_back(std::move(run).value());
  }
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
      "compare", "one scene under several budgets in simulated time: force error, noise and onset of contact");
  command->add_option("scene", arguments->scene, "the scene, a TOML file with a device")->required();
  command->add_option("--budgets-us", arguments->budgets_us, "of a query, microseconds, as 20 work units each")
      ->delimiter(',')
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
