// The loop by hand: with ticks left out, clocks that jump, and an exact query beside every tick.
#include "hard_cases/run_case.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <span>

#include "hard_cases/compare.hpp"
#include "hard_cases/judgement.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/mesh/read.hpp"
#include "odds/query/pair.hpp"
#include "odds/scene/same_poses.hpp"
#include "odds/scene/simulation.hpp"
#include "support/picture.hpp"

namespace odds::hard_cases {
namespace {

using scene::Scene;
using scene::Simulation;

struct Budget {
  std::string name;
  std::uint64_t work_units;  // 0: no limit
};
using Budgets = std::array<Budget, 4>;

Budgets budgets_for(std::uint64_t starved_units) {
  std::string starved = starved_units == RunOptions{}.starved_units ? "1 us" : fmt::format("{} units", starved_units);
  return {{{"none", 0}, {"50 us", 1000}, {"5 us", 100}, {std::move(starved), starved_units}}};
}

/// The same meshes without a budget: whether the tool overlaps something, and how deeply.
class Oracle {
 public:
  static Result<Oracle> make(const Scene& scene, const std::string& folder) {
    Oracle oracle;
    std::vector<std::shared_ptr<const query::Shape>> shapes;
    for (const scene::Mesh& mesh : scene.meshes) {
      auto read = mesh.file.starts_with(mesh::made::prefix) ? mesh::made::make_shape(mesh.file)
                                                            : mesh::read(folder + "/" + mesh.file);
      if (!read) return read.error();
      auto shape = query::Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(read).value()));
      if (!shape) return shape.error();
      shapes.push_back(std::move(shape).value());
    }
    for (std::uint32_t i = 0; i < scene.bodies.size(); ++i) {
      if (scene.bodies[i].follows_device) oracle.tool_ = i;
    }
    if (!oracle.tool_) return oracle;
    for (std::uint32_t i = 0; i < scene.bodies.size(); ++i) {
      if (i == *oracle.tool_) continue;
      auto pair = query::Pair::make(shapes[scene.bodies[i].mesh], shapes[scene.bodies[*oracle.tool_].mesh]);
      if (!pair) return pair.error();
      oracle.pairs_.push_back({i, std::move(pair).value()});
    }
    return oracle;
  }
  double depth_m(const ode::World& world) {
    double deepest = 0.0;
    for (auto& [body, pair] : pairs_) {
      const math::Pose pose = world.state({body}).pose.inverse() * world.state({*tool_}).pose;
      pair.reset();
      for (const query::Contact& contact : pair.run(pose, {.max_contacts = 8, .solids = true}).contacts) {
        deepest = std::max(deepest, contact.depth);
      }
    }
    return deepest;
  }

 private:
  std::optional<std::uint32_t> tool_;
  std::vector<std::pair<std::uint32_t, query::Pair>> pairs_;
};

Result<Scene> scene_of(const HardCase& hard_case, const Budget& budget, double seconds, const std::string& folder) {
  const std::string query = budget.work_units == 0 ? std::string("[query]\ncarry_motion = 0\n")
                                                   : fmt::format("[query]\nwork_units = {}\n", budget.work_units);
  return scene::parse_scene(
      fmt::format("format = \"odds.scene/1\"\n[loop]\nseconds = {}\n{}{}", seconds, query, hard_case.scene),
      hard_case.name + ".toml", folder);
}

/// The next tick's time by the loop's clock, and how it came there.
std::int64_t next_ns(Trouble trouble, std::uint64_t tick, std::int64_t now_ns, std::int64_t period_ns) {
  switch (trouble) {
    case Trouble::none:
      break;
    case Trouble::missed_ticks:
      if (tick == 450 || tick == 600) return now_ns + 41 * period_ns;
      if ((tick * 0x9E3779B97F4A7C15ULL >> 32U) % 10 == 0) return now_ns + 2 * period_ns;
      break;
    case Trouble::clock_jumps:
      if (tick == 300 || tick == 450) return now_ns + 300'000'000;
      if (tick >= 500 && tick < 550) return now_ns;
      break;
  }
  return now_ns + period_ns;
}

bool finite(const haptics::TickRecord& t) {
  double sum = t.observed_energy_j + t.max_depth_m + t.probability;
  for (const double x : t.force_n) sum += x;
  for (const double x : t.torque_nm) sum += x;
  for (const double x : t.tool_position_m) sum += x;
  for (const double x : t.tool_orientation_wxyz) sum += x;
  return std::isfinite(sum);
}

void note(Figures& figures, const haptics::TickRecord& record, double exact_depth_m, double deep_m, std::int64_t now_ns,
          int& missed_in_row) {
  Sample sample;
  sample.t_s = 1e-9 * static_cast<double>(now_ns);
  std::copy(record.force_n.begin(), record.force_n.end(), sample.force_n);
  sample.energy_j = record.observed_energy_j;
  sample.depth_m = record.max_depth_m;
  sample.contacts = record.contacts;
  sample.overlaps_deeply = exact_depth_m > deep_m;
  ++figures.ticks;
  if (!finite(record)) ++figures.not_finite;
  figures.largest_force_n =
      std::fmax(figures.largest_force_n, std::hypot(sample.force_n[0], sample.force_n[1], sample.force_n[2]));
  figures.given_j = std::fmax(figures.given_j, -record.observed_energy_j);
  figures.most_contacts = std::max(figures.most_contacts, record.contacts);
  figures.deepest_m = std::fmax(figures.deepest_m, record.max_depth_m);
  if ((record.safety & ~std::uint32_t{haptics::safety_force_rise}) != 0) ++figures.safety_ticks;
  if (sample.overlaps_deeply) ++figures.deep;
  missed_in_row = sample.overlaps_deeply && record.contacts == 0 ? missed_in_row + 1 : 0;
  if (missed_in_row >= 2) ++figures.missed_deep;
  figures.samples.push_back(sample);
}

/// Where the bodies were when a contact was deepest.
class Still {
 public:
  void note(const ode::World& world, double depth_m) {
    if (!poses_.empty() && !(depth_m > deepest_m_)) return;
    deepest_m_ = depth_m;
    poses_.resize(world.body_count());
    for (std::uint32_t i = 0; i < world.body_count(); ++i) poses_[i] = world.state({i}).pose;
  }
  /// What moves in the middle, and about as much again around it.
  [[nodiscard]] std::string drawn(const ode::World& world) const {
    std::vector<testing::Drawn> bodies;
    Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 upper = -lower;
    for (std::uint32_t i = 0; i < poses_.size(); ++i) {
      const mesh::TriangleMesh& mesh = world.shape({i})->mesh();
      bodies.push_back({&mesh, poses_[i], !world.is_dynamic({i})});
      if (bodies.back().fixed) continue;
      for (const Vec3& vertex : mesh.vertices()) {
        lower = lower.cwiseMin(poses_[i] * vertex);
        upper = upper.cwiseMax(poses_[i] * vertex);
      }
    }
    testing::View view;
    view.centre = 0.5 * (lower + upper);
    view.from = Vec3(1.0, -2.2, 0.7);
    view.width_m = 2.0 * (upper - lower).norm();
    view.columns = 300;
    view.rows = 200;
    return testing::picture_of(bodies, view);
  }

 private:
  double deepest_m_ = 0.0;
  std::vector<math::Pose> poses_;
};

Result<Figures> run_once(const HardCase& hard_case, const Budget& budget, const std::string& folder, double share) {
  const double seconds = hard_case.seconds * share;
  Result<Scene> parsed = scene_of(hard_case, budget, seconds, folder);
  if (!parsed) return parsed.error();
  auto oracle = Oracle::make(parsed.value(), folder);
  if (!oracle) return oracle.error();
  scene::SimulationOptions options;
  options.simulated_time = true;
  auto made = Simulation::make(std::move(parsed).value(), options);
  if (!made) return made.error();
  Simulation& simulation = *made.value();
  if (simulation.device() != nullptr) simulation.device()->enable_forces(true);
  Figures figures;
  figures.budget = budget.name;
  Still still;
  const auto began = std::chrono::steady_clock::now();
  const std::int64_t period_ns = simulation.scene().loop.period_ns;
  const auto end_ns = static_cast<std::int64_t>(seconds * 1e9);
  std::int64_t now_ns = 0;
  int missed_in_row = 0;
  for (std::uint64_t tick = 0; now_ns < end_ns; ++tick) {
    const double exact_depth_m = oracle.value().depth_m(simulation.world());
    haptics::TickRecord record;
    simulation.renderer().tick(now_ns, record);
    note(figures, record, exact_depth_m, hard_case.deep_m, now_ns, missed_in_row);
    still.note(simulation.world(), record.max_depth_m);
    now_ns = next_ns(hard_case.trouble, tick, now_ns, period_ns);
  }
  figures.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  figures.has_hand = simulation.device() != nullptr;
  if (budget.work_units == 0) figures.picture = still.drawn(simulation.world());
  figures.failed_reads = simulation.renderer().failed_reads();
  figures.rescued = simulation.renderer().rescued_steps();
  figures.left_out = simulation.renderer().contacts_left_out();
  for (std::uint32_t i = 0; i < simulation.scene().bodies.size(); ++i) {
    if (simulation.scene().bodies[i].name == hard_case.ends)
      figures.end_height_m = simulation.world().state({i}).pose.translation.z();
  }
  return figures;
}

/// For every budget but the first, which has none.
Result<std::vector<report::ForceDifference>> at_same_poses(const HardCase& hard_case, const Budgets& budgets,
                                                           const std::string& folder, double seconds) {
  Result<Scene> parsed = scene_of(hard_case, budgets[0], seconds, folder);
  if (!parsed) return parsed.error();
  std::vector<report::ForceDifference> differences;
  if (!parsed.value().device) return differences;
  std::vector<query::Budget> limits;
  for (const Budget& budget : std::span(budgets).subspan(1)) limits.push_back(query::Budget::work(budget.work_units));
  auto made = scene::SamePoses::make(parsed.value(), limits, {});
  if (!made) return made.error();
  scene::SamePoses& runs = *made.value();
  std::vector<report::ForceSample> exact;
  std::vector<std::vector<report::ForceSample>> limited(limits.size());
  const auto end_ns = static_cast<std::int64_t>(seconds * 1e9);
  std::int64_t now_ns = 0;
  for (std::uint64_t tick = 0; now_ns < end_ns; ++tick) {
    haptics::TickRecord record;
    runs.tick(now_ns, record);
    const double t_s = 1e-9 * static_cast<double>(now_ns);
    exact.push_back({t_s, runs.exact().force_n, runs.exact().contacts});
    for (std::size_t i = 0; i < limits.size(); ++i) {
      limited[i].push_back({t_s, runs.limited(i).force_n, runs.limited(i).contacts});
    }
    now_ns = next_ns(hard_case.trouble, tick, now_ns, runs.leader().scene().loop.period_ns);
  }
  for (const auto& samples : limited) {
    differences.push_back(report::compare_forces(exact, samples, hard_case.touching_n, rate_hz));
  }
  return differences;
}

}  // namespace

Result<Outcome> run_case(const HardCase& hard_case, const std::string& folder, const RunOptions& options) {
  const Budgets budgets = budgets_for(options.starved_units);
  Outcome outcome;
  outcome.hard_case = &hard_case;
  for (const Budget& budget : budgets) {
    Result<Figures> figures = run_once(hard_case, budget, folder, options.share_of_seconds);
    if (!figures) return figures.error();
    outcome.runs.push_back(std::move(figures).value());
  }
  Result<std::vector<report::ForceDifference>> differences =
      at_same_poses(hard_case, budgets, folder, hard_case.seconds * options.share_of_seconds);
  if (!differences) return differences.error();
  for (std::size_t i = 0; i < differences.value().size(); ++i) {
    outcome.runs[i + 1].at_same_poses = differences.value()[i];
  }
  for (Figures& figures : outcome.runs) {
    compare(outcome.runs.front(), hard_case.touching_n, figures);
    judge(hard_case, figures);
  }
  return outcome;
}

}  // namespace odds::hard_cases
