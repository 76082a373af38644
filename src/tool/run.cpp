// odds run: the loop on a scene, and the files that it leaves behind.
#include <fmt/core.h>
#include <signal.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "mesh/output_file.hpp"
#include "odds/realtime/fitness.hpp"
#include "odds/realtime/host.hpp"
#include "odds/report/replay_glb.hpp"
#include "odds/report/run_report.hpp"
#include "odds/scene/scene.hpp"
#include "odds/scene/simulation.hpp"
#include "tool/allocation_probe.hpp"
#include "tool/build_progress.hpp"
#include "tool/command.hpp"
#include "tool/one_line.hpp"
#include "tool/output_folder.hpp"
#include "tool/replay_folder.hpp"
#include "tool/replay_view.hpp"
#include "tool/run_table.hpp"
#include "tool/served_ticks.hpp"
#include "tool/shared_options.hpp"

namespace odds::tool {
namespace {

struct RunArguments {
  std::string scene;
  std::optional<double> seconds;
  std::string out = "odds_run";
  bool fast = false;
  std::string ticks_of;
};

// While it lives, Ctrl-C ends the loop, which still gets its reports, and a second one the program; before and after,
// one is enough. Shows the time that has passed. To be made before the loop's threads, so that they leave SIGINT to it.
class Watcher {
 public:
  Watcher(double seconds, std::stop_source& stop) {
    sigemptyset(&interrupt_);
    sigaddset(&interrupt_, SIGINT);
    pthread_sigmask(SIG_BLOCK, &interrupt_, nullptr);
    thread_ = std::jthread([this, seconds, &stop](const std::stop_token& ended) { watch(seconds, stop, ended); });
  }
  ~Watcher() {
    thread_.request_stop();
    thread_.join();
    constexpr timespec at_once{0, 0};
    (void)sigtimedwait(&interrupt_, nullptr, &at_once);  // one that nobody saw was meant for the loop
    pthread_sigmask(SIG_UNBLOCK, &interrupt_, nullptr);
  }
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;

 private:
  void watch(double seconds, std::stop_source& stop, const std::stop_token& ended) const {
    const auto start = std::chrono::steady_clock::now();
    ProgressLine line("loop");
    while (!ended.stop_requested()) {
      constexpr timespec look_every{0, 200'000'000};
      if (sigtimedwait(&interrupt_, nullptr, &look_every) == SIGINT && !stop.request_stop()) {
        pthread_sigmask(SIG_UNBLOCK, &interrupt_, nullptr);
        (void)raise(SIGINT);
      }
      const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
      line.show(std::min(1.0, passed.count() / seconds));
    }
  }

  sigset_t interrupt_{};
  std::jthread thread_;
};

report::RunInfo describe(const scene::Simulation& simulation, const RunArguments& arguments, double started_epoch_s) {
  const scene::Scene& scene = simulation.scene();
  report::RunInfo info;
  info.scene = scene.file;
  info.version = ODDS_VERSION;
  info.started_epoch_s = started_epoch_s;
  for (const scene::LoadedMesh& mesh : simulation.meshes())
    info.meshes.push_back({mesh.name, mesh.file, mesh.triangles});
  info.bounding_volume = volume::name(scene.volume);
  info.device = scene.device ? scene.device->name + " (" + scene.device->type + ")" : "none";
  for (const scene::AskedEffect& effect : scene.effects) info.effects.push_back(effect.name);
  info.period_ns = scene.loop.period_ns;
  info.budget_us = simulation.budget().microseconds;
  info.work_units = simulation.budget().work_units;
  info.frame_us = scene.frame.microseconds;
  info.frame_work_units = scene.frame.work_units;
  info.max_contacts = scene.query.max_contacts;
  info.max_contacts_per_step = scene.max_contacts;
  info.carry_motion = scene.query.carry_motion;
  info.simulated_time = arguments.fast;
  info.host = realtime::describe_host();
  return info;
}

/// An error if the run's own recordings would replace those that it repeats.
std::optional<Error> refuse_replacing(const scene::Scene& scene, const RunArguments& arguments) {
  const std::filesystem::path out = arguments.out;
  const haptics::Setting* file = scene.device ? scene.device->settings.find("file") : nullptr;
  const auto* track = file != nullptr ? std::get_if<std::string>(&file->value.data) : nullptr;
  auto error = mesh::refuse_overwriting((out / "ticks.csv").string(), {arguments.ticks_of});
  if (!error && track != nullptr) {
    error = mesh::refuse_overwriting((out / "replay" / "device.csv").string(), {scene.base_directory / *track});
  }
  if (error) error->remedy = "give another --out";
  return error;
}

int run(const RunArguments& arguments) {
  Result<scene::Scene> scene = scene::read_scene(arguments.scene);
  if (!scene) return fail(scene.error());
  if (const auto error = refuse_replacing(scene.value(), arguments)) return fail(*error);
  if (const auto error = prepare_folder(arguments.out, {"replay"})) return fail(*error);
  scene::SimulationOptions options;
  options.simulated_time = arguments.fast;
  options.seconds = arguments.seconds;
  if (!arguments.ticks_of.empty()) {
    auto served = read_served_ticks(arguments.ticks_of);
    if (!served) return fail(served.error());
    options.served = std::move(served).value();
  }
  if (allocations_are_counted()) options.allocations = &allocations_of_this_thread;
  BuildProgress progress;
  options.progress = [&](std::string_view what, double share) { progress.show(what, share); };
  auto made = scene::Simulation::make(std::move(scene).value(), options);
  progress.done();
  if (!made) return fail(made.error());
  scene::Simulation& simulation = *made.value();
  const auto warn = [](const std::string& warning) { fmt::print(stderr, "warning: {}\n", on_one_line(warning)); };
  for (const std::string& warning : simulation.warnings()) warn(warning);

  const std::chrono::duration<double> epoch = std::chrono::system_clock::now().time_since_epoch();
  report::RunInfo info = describe(simulation, arguments, epoch.count());
  if (!arguments.fast) info.fitness = realtime::probe_fitness();
  std::stop_source stop;
  scene::RunOutcome outcome;
  {
    const Watcher watcher(arguments.seconds.value_or(simulation.scene().loop.seconds), stop);
    outcome = simulation.run(stop.get_token());
  }
  info.warnings = simulation.warnings();
  for (const std::string& warning : simulation.run_warnings()) {
    warn(warning);
    info.warnings.push_back(warning);
  }
  info.loop = outcome.loop;
  info.thread = outcome.thread;
  info.pairs_left_out = outcome.pairs_left_out;
  info.frame_overshoot_us = outcome.frame_overshoot_us;
  for (const haptics::EffectCost& cost : outcome.effects) {
    info.effect_costs.push_back(
        {cost.name, cost.place.line, cost.ticks, cost.evaluations, cost.total_ns, cost.longest_ns});
  }
  const report::RunSummary summary = report::summarize(info, outcome.ticks);
  const report::RunReplay replay = replay_view(simulation, outcome);
  const auto files = report::write_run_report(arguments.out, info, summary, outcome.ticks, &replay);
  if (!files) return fail(files.error());
  const Result<std::string> glb = report::replay_glb(info, replay, outcome.ticks);
  if (auto error =
          write_replay_folder(std::filesystem::path(arguments.out) / "replay", simulation, info, outcome, glb)) {
    return fail(*error);
  }
  print_run_table(info, summary, outcome);
  fmt::print("report: {}\n", files.value().page.string());
  return exit_good;
}

}  // namespace

void add_run(CLI::App& app, Action& action) {
  auto arguments = std::make_shared<RunArguments>();
  CLI::App* command = app.add_subcommand("run", "Run the haptic loop on a scene and report its latencies and forces");
  command->add_option("scene", arguments->scene, "the scene, a TOML file")->required();
  command->add_option("--seconds", arguments->seconds, "how long to run (default: as the scene says)")
      ->check(positive_and_finite());
  command->add_option("--out", arguments->out, "directory for the report and the replay")->capture_default_str();
  CLI::Option* const fast = command->add_flag(
      "--fast,--simulated", arguments->fast,
      "simulated time: as fast as possible, budgets in work units, the same forces bit for bit every time");
  command
      ->add_option(
          "--ticks-of", arguments->ticks_of,
          "ticks.csv of an earlier run: serve only the ticks that it served, so that the replay of a timed run "
          "whose queries had work units gives the same bits")
      ->needs(fast);
  command->callback([&action, arguments] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace odds::tool
