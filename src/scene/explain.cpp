// The trial that measures what effects cost.
#include "odds/scene/explain.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "odds/scene/simulation.hpp"

namespace odds::scene {
namespace {

using ode::BodyId;
using ode::BodyState;

constexpr std::uint64_t most_ticks = 60'000;  // a minute at 1 kHz shows what a scene does

enum Kind : std::size_t { virtual_coupling, contact, friction, gravity, damping, kinds };
constexpr std::array<const char*, kinds> kind_names = {"virtual_coupling", "contact", "friction", "gravity", "damping"};

struct Totals {
  std::uint64_t ticks = 0;
  std::uint64_t queries = 0;
  std::uint64_t node_pairs = 0;
  std::uint64_t triangle_pairs = 0;
  std::uint64_t contacts = 0;
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

std::array<std::optional<haptics::Place>, kinds> places(const Effects& e) {
  std::array<std::optional<haptics::Place>, kinds> result;
  if (e.virtual_coupling) result[virtual_coupling] = e.virtual_coupling->place;
  if (e.contact) result[contact] = e.contact->place;
  if (e.friction) result[friction] = e.friction->place;
  if (e.gravity) result[gravity] = e.gravity->place;
  if (e.damping) result[damping] = e.damping->place;
  return result;
}

// The world of a simulation with one effect switched off at a time.
class Trial {
 public:
  explicit Trial(Simulation& simulation) : world_(simulation.world()), asked_(simulation.world().options()) {
    for (std::uint32_t i = 0; i < world_.body_count(); ++i) before_.push_back(world_.state({i}));
  }

  void save() {
    for (std::uint32_t i = 0; i < world_.body_count(); ++i) before_[i] = world_.state({i});
  }
  void restore() {
    for (std::uint32_t i = 0; i < world_.body_count(); ++i) world_.set_state({i}, before_[i]);
  }

  // One step from the saved state, in microseconds; the state is put back.
  double time_step(Kind kind, bool on, const std::optional<BodyId>& tool, const ode::Coupling& pull) {
    if (!on) switch_off(kind, tool);
    if (tool && (on || kind != virtual_coupling)) world_.set_coupling(*tool, pull);
    const ode::StepSummary step = world_.step();
    restore();
    world_.set_contact(asked_.contact);
    world_.set_gravity(asked_.gravity_m_per_s2);
    world_.set_damping(asked_.damping);
    return step.collision_us + step.step_us;
  }

 private:
  void switch_off(Kind kind, const std::optional<BodyId>& tool) {
    ode::ContactModel model = asked_.contact;
    if (kind == contact) model.enabled = false;
    if (kind == friction) model.friction = 0.0;
    world_.set_contact(model);
    if (kind == gravity) world_.set_gravity(Vec3::Zero());
    if (kind == damping) world_.set_damping({});
    if (kind == virtual_coupling && tool) world_.set_coupling(*tool, {});  // no stiffness, no damping: no rows
  }

  ode::World& world_;
  ode::WorldOptions asked_;
  std::vector<BodyState> before_;
};

std::string work_of(Kind kind, const Totals& totals, const ode::ContactModel& model) {
  const double contacts = totals.per_tick(totals.contacts);
  switch (kind) {
    case virtual_coupling:
      return "6 rows in the solver";
    case contact:
      return fmt::format("{:.2f} queries, {:.0f} node pairs, {:.0f} triangle pairs, {:.2f} contacts with a row each",
                         totals.per_tick(totals.queries), totals.per_tick(totals.node_pairs),
                         totals.per_tick(totals.triangle_pairs), contacts);
    case friction:
      return fmt::format("2 more rows a contact: {:.2f}", model.friction > 0.0 ? 2.0 * contacts : 0.0);
    case gravity:
      return "one force a moving body";
    case damping:
      return "two factors a moving body";
    case kinds:
      break;
  }
  return {};
}

}  // namespace

Result<Explanation> explain(const Scene& scene, std::uint64_t samples,
                            const std::function<void(std::string_view, double)>& progress) {
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
  ode::World& world = simulation.world();
  Trial trial(simulation);

  const auto asked = places(scene.effects);
  std::array<std::vector<double>, kinds> differences;
  std::vector<double> whole;
  Totals totals;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (progress && i % 100 == 0) progress("trial", static_cast<double>(i) / static_cast<double>(count));
    const auto now_ns = static_cast<std::int64_t>(i) * scene.loop.period_ns;
    haptics::TickRecord record;
    if (i % measure_every == 0) {
      trial.save();
      const std::optional<BodyId> tool = simulation.tool();
      const ode::Coupling pull = simulation.pull_at(now_ns);
      for (std::size_t k = 0; k < kinds; ++k) {
        if (!asked[k]) continue;
        const bool on_first = (i / measure_every) % 2 == 0;  // whoever comes second finds warm caches
        const double first = trial.time_step(static_cast<Kind>(k), on_first, tool, pull);
        const double second = trial.time_step(static_cast<Kind>(k), !on_first, tool, pull);
        differences[k].push_back(on_first ? first - second : second - first);
      }
    }
    simulation.renderer().tick(now_ns, record);
    whole.push_back(record.collision_us + record.step_us);
    ++totals.ticks;
    totals.queries += record.queries;
    totals.node_pairs += record.node_pairs;
    totals.triangle_pairs += record.triangle_pairs;
    totals.contacts += record.contacts;
  }
  if (progress) progress("trial", 1.0);

  Explanation explanation;
  explanation.ticks = totals.ticks;
  explanation.step_us = percentile(whole, 0.5);
  explanation.warnings = simulation.warnings();
  for (std::size_t k = 0; k < kinds; ++k) {
    EffectLine line;
    line.name = kind_names[k];
    line.on = asked[k].has_value();
    if (line.on) {
      line.place = *asked[k];
      line.work = work_of(static_cast<Kind>(k), totals, world.options().contact);
      line.cost_us = percentile(differences[k], 0.5);
      line.cost_p90_us = percentile(differences[k], 0.9);
      line.samples = differences[k].size();
    }
    explanation.effects.push_back(std::move(line));
  }
  return explanation;
}

}  // namespace odds::scene
