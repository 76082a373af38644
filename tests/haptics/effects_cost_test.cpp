// An effect that nobody asked for costs nothing: no object, no call, no row, no query.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>

#include "odds/haptics/effect_registry.hpp"
#include "odds/scene/explain.hpp"
#include "odds/scene/simulation.hpp"
#include "support/allocation_counter.hpp"
#include "support/sanitizer.hpp"

namespace odds::scene {
namespace {

const std::string bodies = R"(
[loop]
seconds = 0.3
[query]
work_units = 5000
[[mesh]]
name = "slab"
file = "made:box:x=1,y=1,z=0.1,cells=2"
[[mesh]]
name = "ball"
file = "made:icosphere:radius=0.02"
[[body]]
name = "floor"
mesh = "slab"
position_m = [0, 0, -0.05]
[[body]]
name = "tip"
mesh = "ball"
motion = "dynamic"
mass_kg = 0.05
device = "hand"
[[body]]
name = "loose"
mesh = "ball"
motion = "dynamic"
mass_kg = 0.05
position_m = [0.1, 0, 0.0198]
[device.hand]
type = "scripted"
position_m = [0, 0, 0.025]
[[device.hand.motion]]
kind = "press"
duration_s = 0.3
depth_m = 0.01
)";

// Every effect, with keys that make it work in this scene.
const std::map<std::string, std::string, std::less<>>& tables() {
  static const std::map<std::string, std::string, std::less<>> all = {
      {"virtual_coupling", ""},
      {"gravity", ""},
      {"damping", "linear_per_s = 1\n"},
      {"viscosity", "drag_ns_per_m = 0.1\n"},
      {"attraction", "body = \"loose\"\nto = \"floor\"\nmax_force_n = 0.1\nrange_m = 0.1\n"},
      {"snap",
       "body = \"loose\"\nanchor = \"floor\"\nsocket_m = [0.1, 0, 0.0698]\ncapture_m = 0.01\n"
       "stiffness_n_per_m = 100\nbreak_force_n = 10\n"},
      {"gyroscopic", ""},
      {"contact", ""},
      {"deep_contact", ""},
      {"compliance", "body = \"loose\"\nstiffness_n_per_m = 5000\n"},
      {"texture", "body = \"floor\"\namplitude_m = 0.0001\nwavelength_m = 0.002\n"},
      {"surface_velocity", "body = \"floor\"\nvelocity_m_per_s = [0.1, 0, 0]\n"},
      {"friction", "mu = 0.3\nstatic_mu = 0.4\nviscous_ns_per_m = 0.1\n"},
      {"rolling_friction", "rolling_m = 0.0001\nspinning_m = 0.0001\n"},
      {"restitution", "coefficient = 0.5\n"},
      {"energy_tank", ""},
      {"events", ""},
      {"vibration", ""},
      {"passivity_control", ""},
  };
  return all;
}

std::string table(std::string_view name) {
  const auto found = tables().find(name);
  EXPECT_NE(found, tables().end()) << name << " has no table in this test";
  return found == tables().end() ? "" : "[effects." + std::string(name) + "]\n" + found->second;
}

std::unique_ptr<Simulation> simulate(const std::string& effects, const realtime::Clock& clock = {}) {
  Result<Scene> parsed = parse_scene("format = \"odds.scene/1\"\n" + bodies + effects, "test.toml", ".");
  EXPECT_TRUE(parsed.ok()) << (parsed.ok() ? "" : parsed.error().message());
  SimulationOptions options;
  options.simulated_time = true;
  options.clock = clock;
  auto made = Simulation::make(std::move(parsed).value(), options);
  EXPECT_TRUE(made.ok()) << (made.ok() ? "" : made.error().message());
  return std::move(made).value();
}

const EffectLine* line_of(const Explanation& explanation, std::string_view name) {
  for (const EffectLine& line : explanation.effects) {
    if (line.name == name) return &line;
  }
  return nullptr;
}

class EveryEffect : public testing::TestWithParam<std::string> {};

TEST_P(EveryEffect, IsNeverMadeNorEvaluatedWhereNobodyAsksForIt) {
  const std::string& left_out = GetParam();
  if (left_out == "virtual_coupling") GTEST_SKIP() << "a device needs it";
  std::string others;
  for (const haptics::EffectType& type : haptics::effect_types()) {
    const bool rests = (left_out == "contact" && tables().contains(type.name)) ||
                       (left_out == "friction" && type.name == "surface_velocity");
    const bool needs_contact = type.name == "deep_contact" || type.name == "compliance" || type.name == "texture" ||
                               type.name == "surface_velocity" || type.name == "friction" ||
                               type.name == "rolling_friction" || type.name == "restitution" ||
                               type.name == "energy_tank";
    if (type.name == left_out || (rests && (needs_contact || left_out == "friction"))) continue;
    others += table(type.name);
  }
  const std::uint64_t made_before = haptics::effects_made(left_out);
  const auto simulation = simulate(others);
  const RunOutcome outcome = simulation->run();
  EXPECT_EQ(haptics::effects_made(left_out), made_before) << "an object was made";
  for (const haptics::EffectCost& cost : outcome.effects) EXPECT_NE(cost.name, left_out);
}

TEST_P(EveryEffect, IsMadeAndEvaluatedWhereItIsAskedFor) {
  const std::string& name = GetParam();
  std::string all;
  for (const haptics::EffectType& type : haptics::effect_types()) all += table(type.name);
  const std::uint64_t made_before = haptics::effects_made(name);
  const auto simulation = simulate(all);
  const RunOutcome outcome = simulation->run();
  EXPECT_GT(haptics::effects_made(name), made_before);
  const auto found =
      std::find_if(outcome.effects.begin(), outcome.effects.end(), [&](const auto& c) { return c.name == name; });
  ASSERT_NE(found, outcome.effects.end());
  EXPECT_EQ(found->ticks, 300U);
  EXPECT_GE(found->longest_ns, 0);
  // These two act on a fault only, which this scene may or may not have.
  if (name != "energy_tank" && name != "passivity_control") {
    EXPECT_GT(found->evaluations, 0U);
  }
}

INSTANTIATE_TEST_SUITE_P(Names, EveryEffect, testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const haptics::EffectType& type : haptics::effect_types())
                             names.emplace_back(type.name);
                           return names;
                         }()),
                         [](const auto& tested) { return tested.param; });

TEST(EffectCost, TimesOfPhasesAndEffectsAreByTheClockThatIsGiven) {
  realtime::ManualClock clock(1000);  // a microsecond from reading to reading
  const auto simulation = simulate("[effects.virtual_coupling]\n[effects.contact]\n[effects.gravity]\n", clock.clock());
  const RunOutcome outcome = simulation->run();
  for (const haptics::EffectCost& cost : outcome.effects) {
    EXPECT_EQ(cost.total_ns % 1000, 0) << cost.name;
    EXPECT_GT(cost.total_ns, 0) << cost.name;
  }
  for (const haptics::TickRecord& tick : outcome.ticks) {
    EXPECT_NEAR(tick.collision_us, std::round(tick.collision_us), 1e-9);
    EXPECT_EQ(tick.step_us, 1.0) << "one reading before the solver, one after it";
  }
}

TEST(EffectCost, TheSolverHasNoRowsThatNobodyAskedFor) {
  const auto rows = [](const std::string& effects) {
    const auto simulation = simulate(effects);
    ode::StepSummary sum;
    for (int i = 0; i < 200; ++i) {
      haptics::TickRecord record;
      simulation->renderer().tick(i * 1'000'000, record);
      const ode::StepSummary& step = simulation->renderer().last_step();
      sum.queries += step.queries;
      sum.contacts += step.contacts;
      sum.friction_rows += step.friction_rows;
      sum.angular_rows += step.angular_rows;
    }
    return sum;
  };
  const std::string pull = "[effects.virtual_coupling]\n";
  const ode::StepSummary nothing = rows(pull);
  EXPECT_EQ(nothing.queries + nothing.contacts + nothing.friction_rows + nothing.angular_rows, 0U);
  const ode::StepSummary contact = rows(pull + "[effects.contact]\n");
  EXPECT_GT(contact.contacts, 0U);
  EXPECT_EQ(contact.friction_rows + contact.angular_rows, 0U);
  const ode::StepSummary friction = rows(pull + "[effects.contact]\n[effects.friction]\nmu = 0.3\n");
  EXPECT_EQ(friction.friction_rows, 2 * friction.contacts);
  EXPECT_EQ(friction.angular_rows, 0U);
  const ode::StepSummary spinning = rows(pull + "[effects.contact]\n[effects.rolling_friction]\nspinning_m = 0.001\n");
  EXPECT_EQ(spinning.friction_rows, 0U);
  EXPECT_EQ(spinning.angular_rows, spinning.contacts);
}

TEST(EffectCost, ASceneWithoutDynamicsNeverCallsTheSolver) {
  Result<Scene> parsed = parse_scene(
      "format = \"odds.scene/1\"\n[[mesh]]\nname = \"m\"\nfile = \"made:box\"\n[[body]]\nname = \"a\"\nmesh = \"m\"\n"
      "[[body]]\nname = \"b\"\nmesh = \"m\"\n[effects.contact]\n[effects.events]\n",
      "test.toml", ".");
  ASSERT_TRUE(parsed.ok()) << parsed.error().message();
  SimulationOptions options;
  options.simulated_time = true;
  options.seconds = 0.05;
  auto made = Simulation::make(std::move(parsed).value(), options);
  ASSERT_TRUE(made.ok());
  for (int i = 0; i < 20; ++i) {
    const ode::StepSummary step = made.value()->world().step();
    EXPECT_EQ(step.solver_calls, 0U);
    EXPECT_EQ(step.bodies_stepped, 0U);
    EXPECT_EQ(step.queries, 0U) << "bodies that never move do not meet";
  }
}

TEST(EffectCost, FixedBodiesAreNeverStepped) {
  const auto simulation = simulate(table("virtual_coupling") + table("contact"));
  const ode::StepSummary step = simulation->world().step();
  EXPECT_EQ(step.solver_calls, 1U);
  EXPECT_EQ(step.bodies_stepped, 2U) << "of three bodies, one is fixed";
}

TEST(EffectCost, WithEveryEffectOnATickTakesNoMemory) {
  if (!support::counts_allocations) GTEST_SKIP() << "a sanitizer owns the allocator";
  std::string all;
  for (const haptics::EffectType& type : haptics::effect_types()) all += table(type.name);
  const auto simulation = simulate(all);
  ASSERT_TRUE(simulation->renderer().warm_up(8));
  const support::AllocationCounter counter;
  for (std::int64_t i = 0; i < 300; ++i) {
    haptics::TickRecord record;
    simulation->renderer().tick(i * 1'000'000, record);
  }
  EXPECT_EQ(counter.allocations(), 0U);
}

TEST(EffectCost, ExplainNamesWhatEachEffectNeeds) {
  Result<Scene> parsed = parse_scene(
      "format = \"odds.scene/1\"\n" + bodies + table("virtual_coupling") + table("contact") + table("events"),
      "test.toml", ".");
  ASSERT_TRUE(parsed.ok());
  const auto explanation = explain(parsed.value(), 30);
  ASSERT_TRUE(explanation.ok());
  const EffectLine* contact = line_of(explanation.value(), "contact");
  const EffectLine* events = line_of(explanation.value(), "events");
  ASSERT_TRUE(contact != nullptr && events != nullptr);
  EXPECT_NE(contact->needs.find("contact patch"), std::string::npos);
  EXPECT_NE(events->needs.find("verdict"), std::string::npos);
  EXPECT_EQ(line_of(explanation.value(), "friction")->on, false);
  EXPECT_TRUE(line_of(explanation.value(), "friction")->needs.empty());
}

TEST(EffectCost, ATrialLeavesNoTrace) {
  // Explaining runs effects many more times than their ticks; what they remember must not show it.
  Result<Scene> parsed = parse_scene("format = \"odds.scene/1\"\n" + bodies + table("virtual_coupling") +
                                         table("contact") + table("events") + table("vibration"),
                                     "test.toml", ".");
  ASSERT_TRUE(parsed.ok());
  const auto explanation = explain(parsed.value(), 300);
  ASSERT_TRUE(explanation.ok());
  const auto simulation = simulate(table("virtual_coupling") + table("contact") + table("events") + table("vibration"));
  const RunOutcome outcome = simulation->run();
  const EffectLine* vibration = line_of(explanation.value(), "vibration");
  ASSERT_NE(vibration, nullptr);
  char expected[32];
  std::snprintf(expected, sizeof(expected), "%.2f ringing",
                static_cast<double>(outcome.effects.back().evaluations) / 300.0);
  EXPECT_EQ(vibration->work.substr(0, std::strlen(expected)), expected);
}

}  // namespace
}  // namespace odds::scene
