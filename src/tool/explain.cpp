// odds explain: which effects a scene has on, which line asked, what each costs.
#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <string>

#include "odds/scene/explain.hpp"
#include "tool/build_progress.hpp"
#include "tool/command.hpp"
#include "tool/one_line.hpp"
#include "tool/shared_options.hpp"

namespace odds::tool {
namespace {

struct ExplainArguments {
  std::string scene;
  std::uint64_t samples = 500;
};

void print(const scene::Scene& scene, const scene::Explanation& explanation) {
  fmt::print("{}: {} of {} effects are on\n", scene.file, scene.effects.size(), explanation.effects.size());
  for (const scene::EffectLine& effect : explanation.effects) {
    if (!effect.on) {
      fmt::print("  off  {:<18} no [effects.{}]: not computed\n", effect.name, effect.name);
      continue;
    }
    fmt::print("  on   {:<18} line {:<4} {:8.2f} us a tick (p90 {:.2f})  {}; needs {}\n", effect.name,
               effect.place.line, effect.cost_us, effect.cost_p90_us, effect.work, effect.needs);
  }
  if (!explanation.device.empty()) fmt::print("device {}\n", on_one_line(explanation.device));
  std::uint64_t samples = 0;
  for (const scene::EffectLine& effect : explanation.effects) samples = std::max(samples, effect.samples);
  fmt::print(
      "measured on this machine: median of {} pairs of steps with and without the effect, from the same states of a\n"
      "trial of {} ticks in simulated time; a whole step took {:.2f} us (median)\n",
      samples, explanation.ticks, explanation.step_us);
  for (const std::string& warning : explanation.warnings) fmt::print("warning: {}\n", on_one_line(warning));
}

int explain(const ExplainArguments& arguments) {
  const Result<scene::Scene> scene = scene::read_scene(arguments.scene);
  if (!scene) return fail(scene.error());
  BuildProgress progress;
  const auto explanation = scene::explain(scene.value(), arguments.samples,
                                          [&](std::string_view what, double share) { progress.show(what, share); });
  progress.done();
  if (!explanation) return fail(explanation.error());
  print(scene.value(), explanation.value());
  return exit_good;
}

}  // namespace

void add_explain(CLI::App& app, Action& action) {
  auto arguments = std::make_shared<ExplainArguments>();
  CLI::App* command =
      app.add_subcommand("explain", "Show which effects a scene has on, which line asked, what each costs per tick");
  command->add_option("scene", arguments->scene, "the scene, a TOML file")->required();
  command->add_option("--samples", arguments->samples, "ticks at which the costs are measured")
      ->check(whole_number(1, 1'000'000))
      ->capture_default_str();
  command->callback([&action, arguments] { action = [arguments] { return explain(*arguments); }; });
}

}  // namespace odds::tool
