// A whole scene in simulated time: the same forces bit for bit, no memory taken, only the effects that were asked for.
#include "odds/scene/simulation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>

#include "odds/scene/explain.hpp"
#include "support/allocation_counter.hpp"
#include "support/ball_on_terrain.hpp"
#include "support/sanitizer.hpp"
#include "support/temporary_folder.hpp"

namespace odds::scene {
namespace {

const std::string world = R"(
[loop]
seconds = 0.6
[query]
budget_us = 60
)" + testing::ball_on_terrain;
const std::string scripted = testing::hand_onto_terrain() + R"(
[[device.hand.motion]]
kind = "slide"
duration_s = 0.4
by_m = [0.06, 0.01, 0]
turn_rad = 0.4
)";
const std::string effects = "[effects.contact]\n[effects.friction]\nmu = 0.3\n[effects.virtual_coupling]\n";

std::uint64_t thread_allocations() noexcept;
thread_local const support::AllocationCounter* counter_of_thread = nullptr;
std::uint64_t thread_allocations() noexcept {
  return counter_of_thread != nullptr ? counter_of_thread->allocations() : 0;
}

Scene scene(const std::string& text, const std::filesystem::path& base = ".") {
  Result<Scene> parsed = parse_scene("format = \"odds.scene/1\"\n" + text, "test.toml", base);
  EXPECT_TRUE(parsed.ok()) << parsed.error().message();
  return std::move(parsed).value();
}

std::unique_ptr<Simulation> simulated(const std::string& text, const std::filesystem::path& base = ".") {
  SimulationOptions options;
  options.simulated_time = true;
  auto made = Simulation::make(scene(text, base), options);
  EXPECT_TRUE(made.ok()) << made.error().message();
  return std::move(made).value();
}

bool same_forces(const std::vector<haptics::TickRecord>& a, const std::vector<haptics::TickRecord>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::memcmp(a[i].force_n.data(), b[i].force_n.data(), 24) != 0) return false;
    if (std::memcmp(a[i].torque_nm.data(), b[i].torque_nm.data(), 24) != 0) return false;
    if (std::memcmp(a[i].tool_position_m.data(), b[i].tool_position_m.data(), 24) != 0) return false;
    if (a[i].node_pairs != b[i].node_pairs || a[i].contacts != b[i].contacts) return false;
  }
  return true;
}

double largest_force(const RunOutcome& outcome) {
  double largest = 0.0;
  for (const haptics::TickRecord& tick : outcome.ticks) {
    largest = std::max(largest, Vec3(tick.force_n[0], tick.force_n[1], tick.force_n[2]).norm());
  }
  return largest;
}

TEST(Simulation, GivesTheSameForcesBitForBitOnEveryRun) {
  const RunOutcome first = simulated(world + scripted + effects)->run();
  const RunOutcome second = simulated(world + scripted + effects)->run();
  ASSERT_EQ(first.ticks.size(), 600U);
  EXPECT_GT(largest_force(first), 0.2) << "the scene must touch, or it shows nothing";
  EXPECT_TRUE(same_forces(first.ticks, second.ticks));
}

TEST(Simulation, ARecordedDeviceReplaysToTheSameForces) {
  const testing::TemporaryFolder folder;
  const RunOutcome original = simulated(world + scripted + effects)->run();
  ASSERT_FALSE(haptics::write_track(folder / "device.csv", original.device_track).has_value());
  const std::string replayed = "[device.hand]\ntype = \"replay\"\nfile = \"device.csv\"\n";
  const RunOutcome again = simulated(world + replayed + effects, folder.path())->run();
  EXPECT_TRUE(same_forces(original.ticks, again.ticks));
}

TEST(Simulation, TakesNoMemoryInATick) {
  if (!support::counts_allocations) GTEST_SKIP() << "a sanitizer owns the allocator";
  const auto simulation = simulated(world + scripted + effects);
  ASSERT_TRUE(simulation->renderer().warm_up(8));
  const support::AllocationCounter counter;
  std::uint32_t contacts = 0;
  for (std::int64_t i = 0; i < 600; ++i) {
    haptics::TickRecord record;
    simulation->renderer().tick(i * 1'000'000, record);
    contacts += record.contacts;
  }
  EXPECT_EQ(counter.allocations(), 0U);
  EXPECT_GT(contacts, 100U);
}

TEST(Simulation, CountsWhatATickTakesIfThereIsACounter) {
  if (!support::counts_allocations) GTEST_SKIP() << "a sanitizer owns the allocator";
  const support::AllocationCounter counter;
  counter_of_thread = &counter;
  SimulationOptions options;
  options.simulated_time = true;
  options.allocations = &thread_allocations;
  auto counted = Simulation::make(scene(world + scripted + effects), options);
  ASSERT_TRUE(counted.ok());
  haptics::TickRecord record;
  counted.value()->renderer().tick(0, record);
  EXPECT_EQ(record.allocations, 0U);
  haptics::TickRecord uncounted;
  simulated(world + scripted + effects)->renderer().tick(0, uncounted);
  EXPECT_EQ(uncounted.allocations, haptics::not_measured);
  counter_of_thread = nullptr;
}

TEST(Simulation, WithoutTheContactTableNothingIsCollided) {
  const RunOutcome outcome = simulated(world + scripted + "[effects.virtual_coupling]\n")->run();
  for (const haptics::TickRecord& tick : outcome.ticks) {
    ASSERT_EQ(tick.queries, 0U);
    ASSERT_EQ(tick.contacts, 0U);
    ASSERT_EQ(tick.node_pairs, 0U);
  }
  EXPECT_LT(outcome.ticks.back().tool_position_m[2], 0.001) << "the tool must pass through";
}

TEST(Simulation, ForcesStayWithinTheLimitsOfTheScene) {
  const std::string limited = scripted.substr(0, scripted.find("[[")) +
                              "max_force_n = 0.1\nmax_force_slew_n_per_s = 20\n" + scripted.substr(scripted.find("[["));
  const RunOutcome outcome = simulated(world + limited + effects)->run();
  EXPECT_LE(largest_force(outcome), 0.1 * (1 + 1e-12));
  EXPECT_GT(outcome.safety.force_clamped, 10U);
  for (std::size_t i = 1; i < outcome.ticks.size(); ++i) {
    const auto& a = outcome.ticks[i - 1].force_n;
    const auto& b = outcome.ticks[i].force_n;
    EXPECT_LE((Vec3(a[0], a[1], a[2]) - Vec3(b[0], b[1], b[2])).norm(), 0.02 * (1 + 1e-9)) << i;
  }
}

TEST(Simulation, FadesTheForceWhenTheTrackEnds) {
  const testing::TemporaryFolder folder;
  RunOutcome original = simulated(world + scripted + effects)->run();
  original.device_track.states.resize(400);
  ASSERT_FALSE(haptics::write_track(folder / "device.csv", original.device_track).has_value());
  const RunOutcome cut =
      simulated(world + "[device.hand]\ntype = \"replay\"\nfile = \"device.csv\"\n" + effects, folder.path())->run();
  EXPECT_GT(cut.safety.stale, 100U);
  const auto& last = cut.ticks.back().force_n;
  EXPECT_EQ(Vec3(last[0], last[1], last[2]).norm(), 0.0);
}

TEST(Simulation, NamesTheMissingMeshThePlacesTriedAndThePackage) {
  SimulationOptions options;
  options.simulated_time = true;
  const std::string text =
      "search = [\"${ODDS_NO_SUCH_VARIABLE}/x\", \"meshes\"]\n[[mesh]]\nname = \"m\"\nfile = \"bike.obj\"\n"
      "package = \"bikes\"\n[[body]]\nname = \"b\"\nmesh = \"m\"\n[effects.contact]\n";
  const auto made = Simulation::make(scene(text, "dir"), options);
  ASSERT_FALSE(made.ok());
  EXPECT_EQ(made.error().place, "3:1");
  for (const char* part : {"dir/bike.obj", "dir/meshes/bike.obj", "install the package 'bikes'"}) {
    EXPECT_NE(made.error().message().find(part), std::string::npos) << made.error().message();
  }
}

TEST(Simulation, KeepsThePosesOfMovingBodies) {
  const RunOutcome outcome = simulated(world + scripted + effects)->run();
  const auto rows = outcome.poses.rows();
  ASSERT_EQ(rows.size(), 60U);  // 100 Hz
  EXPECT_EQ(outcome.poses.names(), std::vector<std::string>{"ball"});
  const auto& tick = outcome.ticks[rows[30].tick];
  EXPECT_EQ(rows[30].position_m.x(), tick.tool_position_m[0]);
}

// The replay's files tell where bodies begin, and tell everything from the place of the first.
TEST(Simulation, TheBodyOfTheHandBeginsWhereTheDeviceIs) {
  const auto simulation = simulated(world + scripted + effects);
  int held = 0;
  for (const Body& body : simulation->scene().bodies) {
    if (!body.follows_device) continue;
    EXPECT_EQ(body.pose.translation, Vec3(-0.03, 0, 0.03));
    ++held;
  }
  EXPECT_EQ(held, 1);
}

TEST(Simulation, ThePegOfTheDemoFindsItsHole) {
  Result<Scene> peg = read_scene(std::string(ODDS_SOURCE_DIR) + "/demos/scenes/peg_in_hole.toml");
  ASSERT_TRUE(peg.ok()) << peg.error().message();
  SimulationOptions options;
  options.simulated_time = true;
  options.seconds = 1.9;
  auto made = Simulation::make(std::move(peg).value(), options);
  ASSERT_TRUE(made.ok()) << made.error().message();
  const RunOutcome outcome = made.value()->run();
  EXPECT_LT(outcome.ticks.back().tool_position_m[2], -0.0115);  // the hand is at -0.012
  EXPECT_LT(std::abs(outcome.ticks.back().tool_position_m[0]), 0.00015);
  EXPECT_LT(largest_force(outcome), 6.0);  // the chamfer pushes it aside with 5 N at most
}

TEST(Simulation, SubStepsStopATooFastToolAtAThinPlate) {
  // A ball of 4 mm is thrown at a plate of 1 mm at 8 m/s: 8 mm in a tick.
  const auto depth_reached = [](const std::string& physics) {
    const auto simulation = simulated("[physics]\nmax_speed_m_per_s = 20\n" + physics +
                                      "[[mesh]]\nname = \"plate\"\nfile = \"made:box:x=0.2,y=0.2,z=0.001\"\n"
                                      "[[mesh]]\nname = \"ball\"\nfile = \"made:icosphere:radius=0.002\"\n"
                                      "[[body]]\nname = \"plate\"\nmesh = \"plate\"\n[[body]]\nname = \"ball\"\nmesh = "
                                      "\"ball\"\nmotion = \"dynamic\"\n"
                                      "mass_kg = 0.001\nposition_m = [0, 0, "
                                      "0.0345]\n[effects.contact]\nstiffness_n_per_m = 1e6\ndamping_ns_per_m = 10\n"
                                      "max_correcting_velocity_m_per_s = 0.1\n");
    simulation->world().set_state({1}, {{Mat3::Identity(), Vec3(0, 0, 0.0345)}, Vec3(0, 0, -8.0), Vec3::Zero()});
    double lowest = 1.0;
    std::uint32_t most_steps = 0;
    for (std::int64_t i = 0; i < 20; ++i) {
      haptics::TickRecord record;
      simulation->renderer().tick(i * 1'000'000, record);
      lowest = std::min(lowest, simulation->world().state({1}).pose.translation.z());
      most_steps = std::max(most_steps, simulation->renderer().last_step().solver_calls);
    }
    return std::pair{lowest, most_steps};
  };
  const auto [through, one] = depth_reached("");
  EXPECT_LT(through, -0.01);
  EXPECT_EQ(one, 1U);
  const auto [stopped, steps] = depth_reached("substep_way_m = 0.0005\nmost_substeps = 32\n");
  EXPECT_GT(stopped, 0.0);
  EXPECT_EQ(steps, 16U);
}

TEST(Simulation, SubStepsStopATooFastTipAtAThinPlate) {
  // A bar of 0.4 m spins about its middle: its tip makes 8 mm in a tick, and meets a plate of 1 mm on its way.
  const auto way_reached = [](const std::string& physics) {
    const auto simulation = simulated(physics +
                                      "[[mesh]]\nname = \"plate\"\nfile = \"made:box:x=0.05,y=0.001,z=0.05\"\n"
                                      "[[mesh]]\nname = \"bar\"\nfile = \"made:box:x=0.4,y=0.004,z=0.004\"\n"
                                      "[[body]]\nname = \"plate\"\nmesh = \"plate\"\nposition_m = [0.19, 0.028, 0]\n"
                                      "[[body]]\nname = \"bar\"\nmesh = \"bar\"\nmotion = \"dynamic\"\nmass_kg = 0.01\n"
                                      "[effects.contact]\nstiffness_n_per_m = 1e6\ndamping_ns_per_m = 10\n");
    simulation->world().set_state({1}, {math::Pose{}, Vec3::Zero(), Vec3(0, 0, 40.0)});
    double farthest_m = 0.0;  // of the bar's middle line, where the plate is
    for (std::int64_t i = 0; i < 20; ++i) {
      haptics::TickRecord record;
      simulation->renderer().tick(i * 1'000'000, record);
      const math::Pose bar = simulation->world().state({1}).pose;
      const Vec3 along = bar.rotation.col(0);
      const double beside_m = 0.19 - bar.translation.x();
      farthest_m = std::max(farthest_m, bar.translation.y() + beside_m / along.x() * along.y());
    }
    return farthest_m;
  };
  EXPECT_GT(way_reached(""), 0.05);
  EXPECT_LT(way_reached("[physics]\nsubstep_way_m = 0.0005\nmost_substeps = 32\n"), 0.0275);
}

TEST(Simulation, SubStepsCountHowTheHandTurns) {
  const std::string turning =
      "[device.hand]\ntype = \"scripted\"\nposition_m = [0, 0, 0.1]\n[[device.hand.motion]]\nkind = \"hold\"\n"
      "duration_s = 0.02\nturn_rad = 0.5\nturn_axis = [1, 0, 0]\n";
  const auto simulation =
      simulated("[physics]\nsubstep_way_m = 1e-4\nmost_substeps = 64\n" + world + turning + effects);
  std::uint32_t most_steps = 0;
  for (std::int64_t i = 0; i < 20; ++i) {
    haptics::TickRecord record;
    simulation->renderer().tick(i * 1'000'000, record);
    most_steps = std::max(most_steps, simulation->renderer().last_step().solver_calls);
  }
  // At 47 rad/s a corner of the box about the ball, of 1 cm, makes 0.8 mm in a tick.
  EXPECT_GE(most_steps, 8U);
  EXPECT_LE(most_steps, 12U);
}

TEST(Simulation, ASlowToolTakesOneStepATick) {
  const auto simulation =
      simulated("[physics]\nsubstep_way_m = 0.001\nmost_substeps = 8\n" + world + scripted + effects);
  for (std::int64_t i = 0; i < 300; ++i) {
    haptics::TickRecord record;
    simulation->renderer().tick(i * 1'000'000, record);
    ASSERT_EQ(simulation->renderer().last_step().solver_calls, 1U) << i;
  }
}

TEST(Simulation, OfMicrosecondsAndWorkUnitsTheSmallerLimitsARepeatableRun) {
  const auto with = [](const std::string& limits) {
    std::string text = world + scripted + effects;
    return simulated(text.replace(text.find("budget_us = 60"), 14, limits));
  };
  EXPECT_EQ(with("budget_us = 1\nwork_units = 100000")->budget().work_units, 20U);
  EXPECT_EQ(with("budget_us = 1000\nwork_units = 50")->budget().work_units, 50U);
  EXPECT_EQ(with("budget_us = 1e-9")->budget().work_units, 1U);
  EXPECT_EQ(with("frame_us = 2\nframe_work_units = 100000")->scene().frame.work_units, 40U);
  for (const double beyond : {1e18, 1e300}) {
    EXPECT_FALSE(in_work_units(query::Budget::time(beyond)).is_limited()) << "more than can be counted";
  }
  EXPECT_EQ(in_work_units(query::Budget::time(1e15)).work_units, 20'000'000'000'000'000U);
}

TEST(Simulation, AFrameOfFewMicrosecondsIsRepeatableAndDropsNobody) {
  std::string text = R"(
[loop]
seconds = 0.5
[query]
frame_us = 60
max_contacts = 4
[physics]
max_contacts = 128
[[mesh]]
name = "slab"
file = "made:box:x=0.5,y=0.5,z=0.1,cells=8"
[[mesh]]
name = "cube"
file = "made:box:x=0.04,y=0.04,z=0.04,cells=2"
[[body]]
name = "floor"
mesh = "slab"
position_m = [0, 0, -0.05]
[effects.contact]
[effects.gravity]
)";
  for (int i = 0; i < 16; ++i) {
    text += "[[body]]\nname = \"cube" + std::to_string(i) +
            "\"\nmesh = \"cube\"\nmotion = \"dynamic\"\nmass_kg = 0.05\n" + "position_m = [" +
            std::to_string(0.08 * (i % 4) - 0.12) + ", " + std::to_string(0.08 * (i / 4) - 0.12) + ", 0.021]\n";
  }
  const RunOutcome first = simulated(text)->run();
  const RunOutcome second = simulated(text)->run();
  EXPECT_EQ(first.pairs_left_out, second.pairs_left_out);
  ASSERT_EQ(first.poses.rows().size(), second.poses.rows().size());
  for (std::size_t i = 0; i < first.poses.rows().size(); ++i) {
    EXPECT_EQ(first.poses.rows()[i].position_m, second.poses.rows()[i].position_m);
    EXPECT_GT(first.poses.rows()[i].position_m.z(), 0.015);
  }
}

// Three cubes that fall on a slab, at a rate, with so many ticks to a step.
std::string three_cubes(const std::string& rate, const std::string& physics, const std::string& query) {
  std::string text = "[loop]\nrate_hz = " + rate + "\nseconds = 0.4\n[query]\n" + query + "\n[physics]\n" + physics +
                     "\n[[mesh]]\nname = \"slab\"\nfile = \"made:box:x=0.5,y=0.5,z=0.1\"\n[[mesh]]\nname = \"cube\"\n"
                     "file = \"made:box:x=0.04,y=0.04,z=0.04\"\n[[body]]\nname = \"floor\"\nmesh = \"slab\"\n"
                     "position_m = [0, 0, -0.05]\n[effects.contact]\n[effects.gravity]\n[effects.friction]\nmu = 0.5\n"
                     "[[effects.viscosity]]\ndrag_ns_per_m = 0.1\n";
  for (int i = 0; i < 3; ++i) {
    text += "[[body]]\nname = \"cube" + std::to_string(i) +
            "\"\nmesh = \"cube\"\nmotion = \"dynamic\"\nmass_kg = 0.05\n" + "position_m = [" +
            std::to_string(0.03 * i) + ", 0, " + std::to_string(0.03 + 0.05 * i) + "]\n";
  }
  return text;
}

TEST(Simulation, AStepThatTakesFourTicksMovesBodiesAsOneOfTheSameLength) {
  const std::string plenty = "frame_work_units = 10000000";
  const auto whole = simulated(three_cubes("250", "", plenty));
  const auto parts = simulated(three_cubes("1000", "ticks_per_step = 4", plenty));
  std::uint32_t contacts = 0;
  for (std::int64_t i = 0; i < 100; ++i) {
    haptics::TickRecord record;
    whole->renderer().tick(i * 4'000'000, record);
    contacts += record.contacts;
    for (std::int64_t part = 0; part < 4; ++part) {
      parts->renderer().tick((4 * i + part) * 1'000'000, record);
      ASSERT_EQ(parts->renderer().last_step().solver_calls, part == 3 ? 1U : 0U);
    }
    for (std::uint32_t body = 1; body < 4; ++body) {
      ASSERT_EQ(whole->world().state({body}).pose.translation, parts->world().state({body}).pose.translation) << i;
    }
  }
  EXPECT_GT(contacts, 200U);
}

TEST(Simulation, EffectsSeeThePairsOfEveryPartOfAStep) {
  const std::string plenty = "frame_work_units = 10000000";
  std::string crates =  // beside the three, so that a part of a step serves only some
      "[[effects.surface_velocity]]\nbody = \"floor\"\nvelocity_m_per_s = [0.2, 0, 0]\n[effects.events]\n";
  for (int i = 0; i < 6; ++i) {
    crates += "[[body]]\nname = \"crate" + std::to_string(i) +
              "\"\nmesh = \"cube\"\nmotion = \"dynamic\"\nmass_kg = 0.05\nposition_m = [-0.1, " +
              std::to_string(0.08 * i - 0.2) + ", 0.021]\n";
  }
  const auto whole = simulated(three_cubes("250", "", plenty) + crates);
  const auto parts = simulated(three_cubes("1000", "ticks_per_step = 4", plenty) + crates);
  const RunOutcome of_whole = whole->run();
  const RunOutcome of_parts = parts->run();
  for (std::uint32_t body = 1; body < 10; ++body) {
    EXPECT_GT(whole->world().state({body}).velocity_m_per_s.x(), 0.1) << body;
    const Vec3 off = whole->world().state({body}).pose.translation - parts->world().state({body}).pose.translation;
    EXPECT_LT(off.norm(), 1e-6) << body;  // pairs come to the solver in another order
  }
  ASSERT_EQ(of_whole.events.size(), of_parts.events.size());
}

TEST(Simulation, AStepInPartsBeginsAnewWithTheRun) {
  const auto simulation = simulated(three_cubes("1000", "ticks_per_step = 4", "frame_work_units = 300"));
  const RunOutcome first = simulation->run();
  EXPECT_EQ(first.ticks.size(), 400U);
  for (std::uint32_t body = 1; body < 4; ++body) {
    EXPECT_GT(simulation->world().state({body}).pose.translation.z(), 0.015);
  }
  haptics::TickRecord record;
  simulation->renderer().tick(0, record);  // leaves a step under way
  ASSERT_TRUE(simulation->renderer().begin());
  for (int part = 0; part < 4; ++part) {
    simulation->renderer().tick(part * 1'000'000, record);
    EXPECT_EQ(simulation->renderer().last_step().solver_calls, part == 3 ? 1U : 0U);
  }
}

TEST(Simulation, AStepInPartsIsRefusedWhereItCannotBe) {
  const auto refusal = [](const std::string& text) {
    const auto read = parse_scene("format = \"odds.scene/1\"\n" + text, "parts.toml", ".");
    return read.ok() ? std::string("taken") : read.error().message();
  };
  const std::string limit = "frame_us = 100";
  EXPECT_EQ(refusal(three_cubes("1000", "ticks_per_step = 4", limit)), "taken");
  EXPECT_NE(refusal(three_cubes("1000", "ticks_per_step = 4", "")).find("parts.toml:8:1: nothing says how much"),
            std::string::npos)
      << refusal(three_cubes("1000", "ticks_per_step = 4", ""));
  EXPECT_NE(refusal(three_cubes("1000", "ticks_per_step = 1", limit)).find("out of range"), std::string::npos);
  EXPECT_NE(refusal(three_cubes("1000", "ticks_per_step = 4\nsubstep_way_m = 1\nmost_substeps = 2", limit))
                .find("either a part of a step or several steps"),
            std::string::npos);
  std::string held = "[physics]\nticks_per_step = 4\n" + world + scripted + effects;
  held.replace(held.find("budget_us = 60"), std::string("budget_us = 60").size(), limit);
  EXPECT_NE(refusal(held).find("a hand feels every tick"), std::string::npos) << refusal(held);
}

TEST(Explain, OfAStepInPartsCountsWholeSteps) {
  const auto explanation = explain(scene(three_cubes("1000", "ticks_per_step = 4", "frame_work_units = 300")), 5);
  ASSERT_TRUE(explanation.ok()) << explanation.error().message();
  EXPECT_EQ(explanation.value().ticks, 100U);
}

TEST(Explain, SaysWhichEffectsAreOnAndWhichLineAsked) {
  const auto explanation = explain(scene(world + scripted + effects), 20);
  ASSERT_TRUE(explanation.ok()) << explanation.error().message();
  EXPECT_EQ(explanation.value().ticks, 600U);
  std::size_t on = 0;
  for (const EffectLine& effect : explanation.value().effects) {
    on += effect.on ? 1 : 0;
    EXPECT_EQ(effect.place.line > 0, effect.on) << effect.name;
    EXPECT_EQ(effect.samples > 0, effect.on) << effect.name;
    EXPECT_EQ(effect.work.empty(), !effect.on) << effect.name;
  }
  EXPECT_EQ(on, 3U);
}

}  // namespace
}  // namespace odds::scene
