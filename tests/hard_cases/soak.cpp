// The loop without a report.
#include "hard_cases/soak.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <vector>

#include "odds/scene/simulation.hpp"
#include "support/allocation_counter.hpp"

namespace odds::hard_cases {
namespace {

/// Whether all that is known of every body is a number.
bool all_finite(Soak& soak, const ode::World& world) {
  double sum = 0.0;
  for (std::uint32_t i = 0; i < world.body_count(); ++i) {
    const ode::BodyState state = world.state({i});
    const double speed = state.velocity_m_per_s.norm();
    soak.fastest_m_per_s = std::fmax(soak.fastest_m_per_s, speed);
    sum += state.pose.translation.sum() + state.pose.rotation.sum() + speed + state.angular_velocity_rad_per_s.sum();
  }
  return std::isfinite(sum);
}

/// Height of the lowest point of what never moves, metres.
double lowest_fixed(const ode::World& world) {
  double lowest = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < world.body_count(); ++i) {
    if (world.is_dynamic({i})) continue;
    const math::Pose pose = world.state({i}).pose;
    for (const Vec3& vertex : world.shape({i})->mesh().vertices()) lowest = std::min(lowest, (pose * vertex).z());
  }
  return lowest;
}

std::uint64_t below(const ode::World& world, double height) {
  std::uint64_t count = 0;
  for (std::uint32_t i = 0; i < world.body_count(); ++i) {
    if (world.is_dynamic({i}) && world.state({i}).pose.translation.z() < height) ++count;
  }
  return count;
}

void note(Soak& soak, const haptics::TickRecord& record, bool bodies_finite, double most_n) {
  ++soak.ticks;
  const Vec3 force(record.force_n[0], record.force_n[1], record.force_n[2]);
  const double sum = force.sum() + record.torque_nm[0] + record.torque_nm[1] + record.torque_nm[2] +
                     record.tool_position_m[0] + record.tool_position_m[1] + record.tool_position_m[2] +
                     record.observed_energy_j + record.max_depth_m;
  if (!bodies_finite || !std::isfinite(sum)) ++soak.not_finite;
  if (force.norm() > most_n * (1.0 + 1e-9)) ++soak.beyond_limit;
  if ((record.safety & haptics::safety_faulted) != 0) ++soak.faulted;
  soak.largest_force_n = std::fmax(soak.largest_force_n, force.norm());
  soak.least_energy_j = std::fmin(soak.least_energy_j, record.observed_energy_j);
}

// The effects' counts begin anew with each round.
void note(std::vector<std::uint64_t>& evaluations, const haptics::EffectSet& effects) {
  evaluations.resize(effects.size());
  for (std::size_t i = 0; i < effects.size(); ++i) evaluations[i] += effects.cost(i).evaluations;
}

}  // namespace

Result<Soak> soak(const std::string& scene_file, double seconds) {
  Result<scene::Scene> parsed = scene::read_scene(scene_file);
  if (!parsed) return parsed.error();
  scene::SimulationOptions options;
  options.simulated_time = true;
  auto made = scene::Simulation::make(std::move(parsed).value(), options);
  if (!made) return made.error();
  scene::Simulation& simulation = *made.value();
  ode::World& world = simulation.world();
  std::vector<ode::BodyState> start;
  for (std::uint32_t i = 0; i < world.body_count(); ++i) start.push_back(world.state({i}));
  const double most_n = simulation.scene().device ? simulation.scene().device->limits.max_force_n : 0.0;
  const std::int64_t period_ns = simulation.scene().loop.period_ns;
  const auto round = static_cast<std::int64_t>(simulation.scene().loop.seconds * 1e9) / period_ns;
  const auto all = static_cast<std::int64_t>(seconds * 1e9) / period_ns;
  const double lowest = lowest_fixed(world);
  Soak result;
  std::vector<std::uint64_t> evaluations;
  const auto began = std::chrono::steady_clock::now();
  for (std::int64_t tick = 0; tick < all; ++tick) {
    if (tick % round == 0) {
      result.fallen += below(world, lowest);
      ++result.rounds;
      for (std::uint32_t i = 0; i < world.body_count(); ++i) world.set_state({i}, start[i]);
      if (simulation.device() != nullptr) simulation.device()->enable_forces(true);
      result.rescued += simulation.renderer().rescued_steps();
      note(evaluations, simulation.effects());
      if (!simulation.renderer().begin())
        return Error{scene_file, "", "the device gives no position", "check the device"};
    }
    haptics::TickRecord record;
    {
      const support::AllocationCounter counter;
      simulation.renderer().tick(tick % round * period_ns, record);
      result.allocations += counter.allocations();
    }
    note(result, record, all_finite(result, world), most_n);
  }
  result.fallen += below(world, lowest);
  result.rescued += simulation.renderer().rescued_steps();
  note(evaluations, simulation.effects());
  result.effects = simulation.effects().size();
  for (std::size_t i = 0; i < result.effects; ++i) {
    if (evaluations[i] == 0) result.idle += " " + simulation.effects().cost(i).name;
  }
  result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return result;
}

}  // namespace odds::hard_cases
