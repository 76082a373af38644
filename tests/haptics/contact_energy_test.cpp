// Contacts that come and go add no energy; where they would, the tank holds them back.
#include <gtest/gtest.h>

#include <algorithm>

#include "odds/scene/simulation.hpp"

namespace odds::scene {
namespace {

struct Balance {
  double most_j = -1e9;       // highest sum of what contacts gave to the bodies, at any tick
  double least_j = 1e9;       // lowest
  double largest_j = 0.0;     // of one tick
  std::uint64_t changes = 0;  // of the number of contacts
};

// `tank`: keys of the energy tank; one that never runs dry only measures.
Balance balance(const std::string& mesh, std::uint64_t work_units, const std::string& tank, const std::string& bodies,
                const std::string& effects, double seconds) {
  const std::string text =
      "format = \"odds.scene/1\"\n[loop]\nseconds = " + std::to_string(seconds) +
      "\n[query]\nwork_units = " + std::to_string(work_units) +
      "\n[[mesh]]\nname = \"ground\"\nfile = \"made:terrain:side=0.6,height=0.05,depth=0.05,cells=48\"\n"
      "[[mesh]]\nname = \"thing\"\nfile = \"" +
      mesh + "\"\n[[body]]\nname = \"ground\"\nmesh = \"ground\"\n" + bodies + "[effects.contact]\n" + effects +
      "[effects.energy_tank]\n" + tank;
  auto parsed = parse_scene(text, "test.toml", ".");
  EXPECT_TRUE(parsed.ok()) << (parsed.ok() ? "" : parsed.error().message());
  SimulationOptions options;
  options.simulated_time = true;
  auto made = Simulation::make(std::move(parsed).value(), options);
  EXPECT_TRUE(made.ok());
  const RunOutcome outcome = made.value()->run();
  Balance found;
  double sum = 0.0;
  for (std::size_t i = 0; i < outcome.ticks.size(); ++i) {
    sum += outcome.ticks[i].contact_work_j;
    found.most_j = std::max(found.most_j, sum);
    found.least_j = std::min(found.least_j, sum);
    found.largest_j = std::max(found.largest_j, outcome.ticks[i].contact_work_j);
    if (i > 0 && outcome.ticks[i].contacts != outcome.ticks[i - 1].contacts) ++found.changes;
  }
  return found;
}

const std::string measures_only = "initial_j = 1e6\ncapacity_j = 1e6\n";
std::string thing_at(double z) {
  return "[[body]]\nname = \"thing\"\nmesh = \"thing\"\nmotion = \"dynamic\"\nmass_kg = 0.1\nposition_m = [0.02, "
         "0.01, " +
         std::to_string(z) + "]\n";
}

class Tumble : public testing::TestWithParam<std::pair<const char*, std::uint64_t>> {};

// Down a rough ground without friction or damping of its own, with budgets so small that contacts come and go.
TEST_P(Tumble, GainsNothingFromContactsThatComeAndGo) {
  const auto [mesh, work] = GetParam();
  const Balance found = balance(mesh, work, measures_only, thing_at(0.1), "[effects.gravity]\n", 1.5);
  std::printf(
      "  %s, %llu work units: %llu changes of the set; contacts gave at most %.2g J in all, %.2g J in one tick, and "
      "took %.3g J\n",
      mesh, static_cast<unsigned long long>(work), static_cast<unsigned long long>(found.changes), found.most_j,
      found.largest_j, -found.least_j);
  EXPECT_LE(found.most_j, 1e-9);
  EXPECT_LT(found.least_j, -0.01) << "it must have hit the ground";
  EXPECT_GT(found.changes, 5U);
}
INSTANTIATE_TEST_SUITE_P(BodiesAndBudgets, Tumble,
                         testing::Values(std::pair{"made:box:x=0.06,y=0.05,z=0.04", std::uint64_t{20000}},
                                         std::pair{"made:box:x=0.06,y=0.05,z=0.04", std::uint64_t{200}},
                                         std::pair{"made:gear", std::uint64_t{200}},
                                         std::pair{"made:icosphere:radius=0.03", std::uint64_t{200}}));

TEST(EnergyTank, ABodyThatStartsInsideIsNotShotOut) {
  // Sunk 20 mm into the ground, weightless: the springs have energy that nobody put in.
  const std::string cube = "made:box:x=0.06,y=0.05,z=0.04";
  const Balance without = balance(cube, 20000, measures_only, thing_at(0.0), "", 0.5);
  const Balance with = balance(cube, 20000, "initial_j = 0.0001\n", thing_at(0.0), "", 0.5);
  std::printf("  contacts gave %.3g J without the tank, %.3g J with 0.0001 J in it\n", without.most_j, with.most_j);
  EXPECT_GT(without.most_j, 0.005);
  EXPECT_LE(with.most_j, 0.0001 + with.largest_j) << "what was in it, and the tick that emptied it";
  EXPECT_LT(with.most_j, 0.2 * without.most_j);
}

}  // namespace
}  // namespace odds::scene
