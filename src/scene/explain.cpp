// The trial that measures what effects cost.
#include "odds/scene/explain.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "odds/haptics/effect_registry.hpp"
#include "odds/scene/simulation.hpp"

namespace odds::scene {
namespace {

using ode::BodyState;

constexpr std::uint64_t most_ticks = 60'000;  // a minute at 1 kHz shows what a scene does

struct Totals {
  std::uint64_t ticks = 0;
  std::uint64_t queries = 0;
  std::uint64_t node_pairs = 0;
  std::uint64_t triangle_pairs = 0;
  [[nodiscard]] double per_tick(std::uint64_t total) const {
    return ticks == 0 ? 0.0 : static_cast<double>(total) / static_cast<double>(ticks);
  }
};

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

// The world of a simulation with one effect switched off at a time.
class Trial {
 public:
  explicit Trial(Simulation& simulation)
      : simulation_(simulation), world_(simulation.world()), asked_(simulation.world().options()) {
    before_.resize(world_.body_count());
  }

  void save() {
    for (std::uint32_t i = 0; i < world_.body_count(); ++i) before_[i] = world_.state({i});
    simulation_.effects().keep();
  }

  // One step from the saved state, in microseconds; the state is put back.
  double time_step(std::size_t effect, bool on, std::int64_t now_ns) {
    simulation_.effects().set_on(effect, on);
    if (!on) apply(simulation_.scene().world_options(simulation_.effects()));
    const std::int64_t took_ns = simulation_.renderer().trial(now_ns);
    for (std::uint32_t i = 0; i < world_.body_count(); ++i) world_.set_state({i}, before_[i]);
    simulation_.effects().set_on(effect, true);
    simulation_.effects().put_back();
    if (!on) apply(asked_);
    return 1e-3 * static_cast<double>(took_ns);
  }

 private:
  void apply(const ode::WorldOptions& options) {
    world_.set_contact(options.contact);
    world_.set_gravity(options.gravity_m_per_s2);
    world_.set_damping(options.damping);
  }

  Simulation& simulation_;
  ode::World& world_;
  ode::WorldOptions asked_;
  std::vector<BodyState> before_;
};

std::string work_of(std::string_view name, const haptics::Effect& effect, std::uint64_t evaluations,
                    const Totals& totals) {
  std::string text = fmt::format("{:.2f} {}", totals.per_tick(evaluations), effect.evaluates());
  if (name != "contact") return text;
  return text + fmt::format(" from {:.2f} queries, {:.0f} node pairs, {:.0f} triangle pairs",
                            totals.per_tick(totals.queries), totals.per_tick(totals.node_pairs),
                            totals.per_tick(totals.triangle_pairs));
}

std::string device_line(const Scene& scene) {
  if (!scene.device) return {};
  const haptics::DeviceScale& s = scene.device->scale;
  return fmt::format(
      "{} ({}), line {}: force_scale {:.4g}, workspace_scale {:.4g} about [{:.4g}, {:.4g}, {:.4g}] m; a stiffness of "
      "the "
      "scene is {:.4g} times as much at the device",
      scene.device->name, scene.device->type, scene.device->place.line, s.force, s.workspace, s.origin_m.x(),
      s.origin_m.y(), s.origin_m.z(), s.stiffness());
}

std::vector<EffectLine> lines_of(Simulation& simulation, const std::vector<std::vector<double>>& differences,
                                 const std::vector<std::uint64_t>& evaluations, const Totals& totals) {
  std::vector<EffectLine> lines;
  haptics::EffectSet& effects = simulation.effects();
  for (const haptics::EffectType& type : haptics::effect_types()) {
    bool on = false;
    for (std::size_t i = 0; i < effects.size(); ++i) {
      if (effects.cost(i).name != type.name) continue;
      on = true;
      EffectLine line{effects.cost(i).name, true, effects.cost(i).place, "", "", 0.0, 0.0, differences[i].size()};
      line.needs = haptics::needs_text(effects.effect(i).needs());
      line.work = work_of(type.name, effects.effect(i), evaluations[i], totals);
      line.cost_us = percentile(differences[i], 0.5);
      line.cost_p90_us = percentile(differences[i], 0.9);
      lines.push_back(std::move(line));
    }
    if (!on) lines.push_back({std::string(type.name), false, {}, "", "", 0.0, 0.0, 0});
  }
  return lines;
}

}  // namespace

Result<Explanation> explain(const Scene& asked, std::uint64_t samples,
                            const std::function<void(std::string_view, double)>& progress) {
  // What an effect costs is seen in whole steps: where a step takes several ticks, a tick of the trial is all of them.
  Scene scene = asked;
  scene.loop.period_ns *= scene.ticks_per_step;
  for (std::uint32_t part = 2; part < scene.ticks_per_step; ++part) {
    scene.frame.microseconds += asked.frame.microseconds;
    if (asked.frame.work_units != query::Budget{}.work_units) scene.frame.work_units += asked.frame.work_units;
  }
  scene.ticks_per_step = 1;
  SimulationOptions options;
  options.simulated_time = true;
  options.progress = progress;
  const double period_s = scene.loop.period_s();
  const auto planned = static_cast<std::uint64_t>(std::max(1.0, std::ceil(scene.loop.seconds / period_s)));
  const std::uint64_t count = std::min(planned, most_ticks);
  const std::uint64_t measure_every = std::max<std::uint64_t>(1, count / samples);
  options.seconds = static_cast<double>(count) * period_s;
  auto made = Simulation::make(scene, options);
  if (!made) return made.error();
  Simulation& simulation = *made.value();
  Trial trial(simulation);

  haptics::EffectSet& effects = simulation.effects();
  std::vector<std::vector<double>> differences(effects.size());
  std::vector<std::uint64_t> evaluations(effects.size());
  std::vector<double> whole;
  Totals totals;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (progress && i % 100 == 0) progress("trial", static_cast<double>(i) / static_cast<double>(count));
    const auto now_ns = static_cast<std::int64_t>(i) * scene.loop.period_ns;
    haptics::TickRecord record;
    if (i % measure_every == 0) {
      trial.save();
      for (std::size_t k = 0; k < effects.size(); ++k) {
        const bool on_first = (i / measure_every) % 2 == 0;  // whoever comes second finds warm caches
        const double first = trial.time_step(k, on_first, now_ns);
        const double second = trial.time_step(k, !on_first, now_ns);
        differences[k].push_back(on_first ? first - second : second - first);
      }
    }
    for (std::size_t k = 0; k < effects.size(); ++k) evaluations[k] -= effects.cost(k).evaluations;
    simulation.renderer().tick(now_ns, record);
    for (std::size_t k = 0; k < effects.size(); ++k) evaluations[k] += effects.cost(k).evaluations;
    whole.push_back(record.collision_us + record.step_us);
    ++totals.ticks;
    totals.queries += record.queries;
    totals.node_pairs += record.node_pairs;
    totals.triangle_pairs += record.triangle_pairs;
  }
  if (progress) progress("trial", 1.0);

  Explanation explanation;
  explanation.ticks = totals.ticks;
  explanation.step_us = percentile(whole, 0.5);
  explanation.warnings = simulation.warnings();
  for (std::string& warning : simulation.run_warnings()) explanation.warnings.push_back(std::move(warning));
  explanation.device = device_line(scene);
  explanation.effects = lines_of(simulation, differences, evaluations, totals);
  return explanation;
}

}  // namespace odds::scene
