// The laws of contact: a compliant row, a penalty force, a constraint.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "haptics/on_floor.hpp"

namespace odds::scene {
namespace {

constexpr double g = 9.81;

// Kinetic, and potential above z = 0 where there is gravity, of all bodies that move, J.
double energy_of(Simulation& simulation) {
  const double down = -simulation.world().options().gravity_m_per_s2.z();
  double sum = 0.0;
  for (std::uint32_t i = 0; i < simulation.world().body_count(); ++i) {
    if (!simulation.world().is_dynamic({i})) continue;
    const ode::BodyState s = simulation.world().state({i});
    const ode::MassProperties& m = simulation.world().mass({i});
    const Vec3 spin = s.pose.rotation.transpose() * s.angular_velocity_rad_per_s;
    sum += 0.5 * m.mass_kg * s.velocity_m_per_s.squaredNorm() + 0.5 * spin.dot(m.inertia_kg_m2 * spin) +
           m.mass_kg * down * (s.pose * m.center_m).z();
  }
  return sum;
}

// Floors side by side, one, two or four, with tops at z = 0, that meet at the origin: what lies there has a pair with
// each.
std::string on_tiles(int count, const std::string& rest) {
  std::string text =
      "format = \"odds.scene/1\"\n[loop]\nseconds = 2\n[query]\nwork_units = 20000\n"
      "[[mesh]]\nname = \"tile\"\nfile = \"made:box:x=0.2,y=0.2,z=0.1\"\n"
      "[[mesh]]\nname = \"ball\"\nfile = \"made:icosphere:radius=0.02\"\n"
      "[[mesh]]\nname = \"cube\"\nfile = \"made:box:x=0.04,y=0.04,z=0.04\"\n";
  for (int i = 0; i < count; ++i) {
    const std::string x = count == 1 ? "0" : i % 2 == 0 ? "0.1" : "-0.1";
    const std::string y = count <= 2 ? "0" : i < 2 ? "0.1" : "-0.1";
    text += "[[body]]\nname = \"tile" + std::to_string(i) + "\"\nmesh = \"tile\"\nposition_m = [" + x + ", " + y +
            ", -0.05]\n";
  }
  return text + rest;
}

class ContactLaw : public testing::TestWithParam<const char*> {
 protected:
  static std::string law(const std::string& more = "") {
    return "[effects.contact]\nlaw = \"" + std::string(GetParam()) + "\"\n" + more;
  }
  static bool yields() { return GetParam() != std::string("constraint"); }
  // The most energy within so many ticks, in terms of that at their beginning.
  static double gain(Simulation& simulation, int ticks) {
    const double begun = energy_of(simulation);
    double most = 0.0;
    run_ticks(simulation, ticks,
              [&](int, const haptics::TickRecord&) { most = std::max(most, energy_of(simulation)); });
    return most / begun;
  }
};

TEST_P(ContactLaw, ABodyRestsAsDeepAsItSays) {
  const auto simulation = simulate(
      on_floor(moving("cube", "cube", 0, 0.0199, 0.5) + law(yields() ? "damping_ns_per_m = 60\n" : "") + gravity, 2.0));
  run_ticks(*simulation, 2000);
  const ode::BodyState cube = simulation->world().state({1});
  const double depth = 0.02 - cube.pose.translation.z();
  if (yields()) {
    EXPECT_NEAR(depth, 0.5 * g / 20000, 0.02 * 0.5 * g / 20000);
  } else {
    EXPECT_LT(depth, 1e-6);
  }
  EXPECT_LT(cube.velocity_m_per_s.norm(), 1e-6);
}

TEST_P(ContactLaw, FrictionHoldsBelowItsAngleAndSlidesAbove) {
  for (const double along : {2.5, 4.0}) {
    const auto simulation =
        simulate(on_floor(moving("cube", "cube", 0, 0.0199) + law() + "[effects.gravity]\ng_m_per_s2 = [" +
                          std::to_string(along) + ", 0, -9]\n[effects.friction]\nmu = 0.3\n"));
    run_ticks(*simulation, 500);
    const ode::BodyState before = simulation->world().state({1});
    run_ticks(*simulation, 500);
    const ode::BodyState after = simulation->world().state({1});
    if (along < 0.3 * 9) {
      EXPECT_LT(std::abs(after.pose.translation.x() - before.pose.translation.x()), 1e-5)
          << "it sticks, and does not creep";
    } else {
      EXPECT_NEAR((after.velocity_m_per_s - before.velocity_m_per_s).x() / 0.5, along - 0.3 * 9, 0.02);
    }
  }
}

TEST_P(ContactLaw, RollingStopsAfterTheWayThatEnergySays) {
  const auto simulation =
      simulate(on_floor(moving("ball", "ball", 0, 0.02) + law() + gravity +
                            "[effects.friction]\nmu = 0.8\n[effects.rolling_friction]\nrolling_m = 0.002\n",
                        4.0));
  run_ticks(*simulation, 100);
  throw_body(*simulation, 1, Vec3(0.3, 0, 0), Vec3(0, 15.0, 0));
  const double from = simulation->world().state({1}).pose.translation.x();
  run_ticks(*simulation, 2500);
  EXPECT_LT(simulation->world().state({1}).velocity_m_per_s.norm(), 0.01);
  EXPECT_NEAR(simulation->world().state({1}).pose.translation.x() - from, 0.5 * 0.3 * 0.3 * 1.4 / (0.1 * g), 0.012);
}

TEST_P(ContactLaw, SpinningStopsByItsTorque) {
  const auto simulation = simulate(
      on_floor(moving("ball", "ball", 0, 0.02) + law() + gravity + "[effects.rolling_friction]\nspinning_m = 0.001\n"));
  run_ticks(*simulation, 100);
  throw_body(*simulation, 1, Vec3::Zero(), Vec3(0, 0, 20.0));
  run_ticks(*simulation, 100);
  const double rate = 0.001 * g / (0.4 * 0.02 * 0.02);  // rad/s2
  EXPECT_NEAR(simulation->world().state({1}).angular_velocity_rad_per_s.z(), 20.0 - 0.1 * rate, 1.0);
}

TEST_P(ContactLaw, ABounceGivesNoMoreThanTheFall) {
  for (const char* mesh : {"ball", "cube", "bar"}) {
    const auto simulation =
        simulate(on_floor(moving("thing", mesh, 0, 0.25) + law(yields() ? "damping_ns_per_m = 0\n" : "") + gravity +
                          "[effects.friction]\nmu = 0.4\n"));
    throw_body(*simulation, 1, Vec3(0.5, 0, -0.5), Vec3(1, 3, 2));
    EXPECT_LT(gain(*simulation, 1500), 1.02) << mesh;
  }
}

TEST_P(ContactLaw, ABodyInSeveralPairsGainsNoMoreThanInOne) {
  for (const char* tank : {"", "[effects.energy_tank]\n"}) {
    for (const int tiles : {2, 4}) {
      for (const double mass_kg : {0.01, 0.05}) {
        for (const char* pair : {"stiffness_n_per_m = 1000\ndamping_ns_per_m = 20\n",
                                 "stiffness_n_per_m = 100\ndamping_ns_per_m = 100\n"}) {
          const auto simulation = simulate(
              on_tiles(tiles, moving("ball", "ball", 0, 0.07, mass_kg) + law(yields() ? pair : "") + gravity + tank));
          EXPECT_LT(gain(*simulation, 2000), 1.02) << tiles << " tiles, " << mass_kg << " kg, " << pair << tank;
        }
      }
    }
  }
}

// The stiffest that goes without a warning, thrown without gravity at so many tiles that share it, at different phases
// of the step: the most that any throw gives back of its energy.
double most_given_back(const char* law, const char* mesh, int tiles, const std::string& damping) {
  double most = 0.0;
  for (int phase = 0; phase < 10; ++phase) {
    for (const double speed_m_per_s : {0.2, 0.5}) {
      const double height_m = 0.08 + phase * speed_m_per_s * 1e-3 / 10;
      const double stiffness_n_per_m = 0.25 * 0.1 / 1e-6 / tiles;
      const auto simulation =
          simulate(on_tiles(tiles, moving("thing", mesh, 0, height_m) + "[effects.contact]\nlaw = \"" + law +
                                       "\"\nstiffness_n_per_m = " + std::to_string(stiffness_n_per_m) +
                                       "\nmax_correcting_velocity_m_per_s = 100\n" + damping));
      throw_body(*simulation, static_cast<std::uint32_t>(tiles), Vec3(0, 0, -speed_m_per_s),
                 Vec3(0.5 * (phase % 7), phase % 3, 0));
      const double begun = energy_of(*simulation);
      run_ticks(*simulation, 500,
                [&](int, const haptics::TickRecord&) { most = std::max(most, energy_of(*simulation) / begun); });
    }
  }
  return most;
}

// One impact of a linear spring gives back up to a third more where a point feels a quarter of the mass; a cube lands
// on an edge and then on the other, and a ball's points of contact change while they push.
TEST(ContactLaws, APenaltyAtTheLimitOfItsWarningGivesBackABoundedPart) {
  for (const int tiles : {1, 2, 4}) {
    for (const char* mesh : {"ball", "cube"}) {
      EXPECT_LT(most_given_back("compliant", mesh, tiles, "damping_ns_per_m = 0\n"), 1.0001) << tiles << mesh;
      EXPECT_LT(most_given_back("penalty", mesh, tiles, "damping_ns_per_m = 0\n"), 16.0 / 9) << tiles << mesh;
      EXPECT_LT(most_given_back("penalty", mesh, tiles, ""), 1.02) << tiles << mesh << ", with the default damper";
    }
  }
}

// The iterative solver ends before friction is as large as a constraint needs it; of what yields it knows the force.
TEST_P(ContactLaw, WhatTheIterativeSolverHoldsCreepsOnlyByAConstraintAndSlowly) {
  for (const char* iterations : {"", "iterations = 50\n"}) {
    const auto simulation = simulate(on_floor(moving("cube", "cube", 0, 0.0199) + law() +
                                                  "[effects.gravity]\ng_m_per_s2 = [2.5, 0, -9]\n"
                                                  "[effects.friction]\nmu = 0.3\n"
                                                  "[physics]\nsolver = \"iterative\"\n" +
                                                  iterations,
                                              2.0));
    run_ticks(*simulation, 500);
    const Vec3 before = simulation->world().state({1}).pose.translation;
    run_ticks(*simulation, 1000);
    const double creep_m_per_s = (simulation->world().state({1}).pose.translation - before).norm();
    const bool few = std::string(iterations).empty();
    EXPECT_LT(creep_m_per_s, !few ? 1e-7 : yields() ? 1e-9 : 1e-4) << iterations;
  }
}

TEST_P(ContactLaw, ALightBodyUnderAHeavyOneGainsNothing) {
  for (const char* tank : {"", "[effects.energy_tank]\n"}) {
    const auto simulation = simulate(on_floor(
        moving("light", "cube", 0, 0.0199, 0.01) + moving("heavy", "bar", 0, 0.0898, 2.0) +
        law(yields() ? "stiffness_n_per_m = 2400\n" : "") + gravity + "[effects.friction]\nmu = 0.8\n" + tank));
    EXPECT_LT(gain(*simulation, 2000), 1.02) << tank;
    const double weight_n = 2.01 * g;
    const double deepest_m = yields() ? 2 * weight_n / 2400 : 1e-4;
    EXPECT_GT(simulation->world().state({1}).pose.translation.z(), 0.02 - deepest_m) << "it is not pressed through";
  }
}

TEST_P(ContactLaw, WhatBeginsDeepLeavesNoFasterThanItMayBeCorrected) {
  const auto simulation =
      simulate(on_floor(moving("ball", "ball", 0, 0.005) + law("max_correcting_velocity_m_per_s = 0.2\n")));
  double fastest = 0.0;
  run_ticks(*simulation, 500, [&](int, const haptics::TickRecord&) {
    fastest = std::max(fastest, simulation->world().state({1}).velocity_m_per_s.norm());
  });
  EXPECT_LT(fastest, 0.2 * 1.1);
  EXPECT_GT(simulation->world().state({1}).pose.translation.z(), 0.0195) << "it is out";
}

// The correcting velocity bounds the force, and a soft row without a damper has little force for a velocity.
TEST_P(ContactLaw, ASoftBodyIsCarriedByItsSpringHoweverSoft) {
  constexpr double softness = 1.0 / 2000;
  for (const int rate_hz : {500, 1000, 4000}) {
    const auto simulation =
        simulate(on_floor(moving("cube", "cube", 0, 0.0195, 0.5) + law() +
                              "[effects.compliance]\nbody = \"cube\"\nstiffness_n_per_m = 2000\n[effects.damping]\n"
                              "linear_per_s = 20\nangular_per_s = 20\n" +
                              gravity,
                          2.0, rate_hz));
    run_ticks(*simulation, 2 * rate_hz);
    const double sunk = 0.02 - simulation->world().state({1}).pose.translation.z();
    const double springs = softness + (yields() ? 1.0 / 20000 : 0.0);
    EXPECT_NEAR(sunk, 0.5 * g * springs, 0.1 * 0.5 * g * springs) << rate_hz;
  }
}

TEST_P(ContactLaw, ASoftBodyThatBeginsDeepLeavesNoFasterThanItMayBeCorrected) {
  const auto simulation =
      simulate(on_floor(moving("ball", "ball", 0, 0.005) + law("max_correcting_velocity_m_per_s = 0.2\n") +
                        "[effects.compliance]\nbody = \"ball\"\nstiffness_n_per_m = 500\n"));
  double fastest = 0.0;
  run_ticks(*simulation, 500, [&](int, const haptics::TickRecord&) {
    fastest = std::max(fastest, simulation->world().state({1}).velocity_m_per_s.norm());
  });
  constexpr double push_of_a_tick_m_per_s = 0.001 * 500 * 0.015 / 0.1;  // of the spring, from below the bound
  EXPECT_LT(fastest, 0.2 + push_of_a_tick_m_per_s);
  EXPECT_GT(simulation->world().state({1}).pose.translation.z(), 0.0195) << "it is out";
}

TEST_P(ContactLaw, TheImpulseOfContactsCarriesTheWeight) {
  Result<Scene> parsed =
      parse_scene(trimmed(on_floor(moving("cube", "cube", 0, 0.0199, 0.5) + law() + gravity, 2.0)), "test.toml", ".");
  ASSERT_TRUE(parsed.ok());
  SimulationOptions options;
  options.simulated_time = true;
  options.contact_impulse = true;
  const auto simulation = std::move(Simulation::make(std::move(parsed).value(), options)).value();
  run_ticks(*simulation, 1000);
  const Vec3 before = simulation->world().contact_impulse({1});
  run_ticks(*simulation, 500);
  const Vec3 force = (simulation->world().contact_impulse({1}) - before) / 0.5;
  EXPECT_NEAR(force.z(), 0.5 * g, 0.01 * 0.5 * g);
}

TEST_P(ContactLaw, AnEmptyTankOnlyStopsAnApproach) {
  constexpr double thrown_m_per_s = 0.5;
  const auto simulation =
      simulate(on_floor(moving("ball", "ball", 0, 0.005) + law() + "[effects.energy_tank]\ninitial_j = 0\n"));
  run_ticks(*simulation, 500);
  EXPECT_NEAR(simulation->world().state({1}).pose.translation.z(), 0.005, 1e-6) << "it may not push";
  throw_body(*simulation, 1, Vec3(0, 0, -thrown_m_per_s));
  run_ticks(*simulation, 1);
  const double left = yields() ? 1.0 / (1.0 + 0.001 * (20 + 0.001 * 20000) / 0.1) : 0.0;
  EXPECT_NEAR(simulation->world().state({1}).velocity_m_per_s.z(), -left * thrown_m_per_s, 0.01 * thrown_m_per_s)
      << "it is slowed, and not turned round";
  // What it took from the ball it may give back, and no more but for the step that empties it.
  double sum_j = 0.0;
  double most_j = 0.0;
  double largest_j = 0.0;
  run_ticks(*simulation, 500, [&](int, const haptics::TickRecord& record) {
    sum_j += record.contact_work_j;
    most_j = std::max(most_j, sum_j);
    largest_j = std::max(largest_j, record.contact_work_j);
  });
  const double taken_j = 0.5 * 0.1 * thrown_m_per_s * thrown_m_per_s * (1.0 - left * left);
  EXPECT_LE(most_j, taken_j + largest_j);
  EXPECT_GT(simulation->world().state({1}).pose.translation.z(), 0.0) << "it has not gone through";
}

INSTANTIATE_TEST_SUITE_P(Laws, ContactLaw, testing::Values("compliant", "penalty", "constraint"),
                         [](const auto& law) { return std::string(law.param); });

TEST(ContactLaws, RefuseWhatDoesNothing) {
  const std::string ball = moving("ball", "ball", 0, 0.1);
  const auto says = [&](const std::string& keys, const char* part) {
    const std::string message = refusal(on_floor(ball + "[effects.contact]\n" + keys));
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  says("law = \"hard\"\n", "compliant");
  says("law = \"constraint\"\nstiffness_n_per_m = 100\n", "does not yield");
  says("law = \"constraint\"\ndamping_ns_per_m = 100\n", "does not yield");
  says("error_reduction = 0.3\n", "only a constraint");
  says("law = \"constraint\"\nerror_reduction = 1.3\n", "out of range");
}

TEST(ContactLaws, RefuseEffectsThatTheyCannotCarry) {
  const auto bounce = [](const char* header) { return std::string(header) + "\ncoefficient = 0.5\n"; };
  const auto thick = [](const char* header) { return std::string(header) + "\nmu = 0.1\nviscous_ns_per_m = 1\n"; };
  const auto law = [](const std::string& name, const char* header = "[effects.contact]") {
    return header + ("\nlaw = \"" + name + "\"\n");
  };
  const std::string ball = moving("ball", "ball", 0, 0.1);
  const auto scene = [&](const std::string& effects) { return on_floor(ball + effects); };
  // What reading the scene says, and the place of the line that it has to name.
  const auto says = [&](const std::string& effects, const char* line, const char* what, const char* remedy) {
    const std::string text = trimmed(scene(effects));
    const auto number = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find(line)), '\n');
    const std::string message = refusal(scene(effects));
    EXPECT_EQ(message.find("test.toml:" + std::to_string(number) + ":"), 0U) << message;
    EXPECT_NE(message.find(what), std::string::npos) << message;
    EXPECT_NE(message.find(remedy), std::string::npos) << message;
  };
  for (const char* contact_header : {"[effects.contact]", "[[effects.contact]]"}) {
    for (const char* header : {"[effects.restitution]", "[[effects.restitution]]"}) {
      says(law("penalty", contact_header) + bounce(header), header, "knows no impact", "take law = \"compliant\" or");
    }
    for (const char* header : {"[effects.friction]", "[[effects.friction]]"}) {
      says(thick(header) + law("constraint", contact_header), "viscous_ns_per_m", "viscous friction",
           "remove 'viscous_ns_per_m'");
    }
  }
  for (const std::string& effects :
       {law("constraint") + bounce("[effects.restitution]"), law("penalty") + thick("[effects.friction]"),
        bounce("[effects.restitution]") + "[effects.contact]\n"}) {
    EXPECT_EQ(refusal(scene(effects)), "taken");
    EXPECT_NE(simulate(scene(effects)), nullptr);
  }
}

std::string contact_warning(const std::string& scene) {
  const auto simulation = simulate(scene);
  for (const std::string& warning : simulation->warnings()) {
    if (warning.starts_with("contact:")) return warning;
  }
  return "";
}

TEST(ContactLaws, APenaltyTooStiffForItsBodyIsSaidWithAndWithoutAHand) {
  const std::string hand = "[device.hand]\ntype = \"null\"\n[effects.virtual_coupling]\n";
  const std::string tool =
      "[[body]]\nname = \"tool\"\nmesh = \"ball\"\nmotion = \"dynamic\"\nmass_kg = 0.05\ndevice = \"hand\"\n";
  for (const std::string& body : {tool + hand, moving("tool", "ball", 0, 0.1, 0.05)}) {
    const auto says = [&](const std::string& keys) {
      return contact_warning(on_floor(body + "[effects.contact]\n" + keys));
    };
    const std::string warning = says("law = \"penalty\"\nstiffness_n_per_m = 20000\n");
    for (const char* part : {"20000 N/m", "'floor' and 'tool'", "0.05 kg", "below 12500 N/m"}) {
      EXPECT_NE(warning.find(part), std::string::npos) << warning;
    }
    EXPECT_EQ(says("law = \"penalty\"\nstiffness_n_per_m = 10000\n"), "");
    EXPECT_EQ(says("stiffness_n_per_m = 20000\n"), "");
  }
}

TEST(ContactLaws, APenaltyIsJudgedByTheStiffnessOfEachPairAfterWhatSoftensIt) {
  const auto says = [](double light_n_per_m, double floor_n_per_m) {
    const auto softened = [](const std::string& body, double n_per_m) {
      return n_per_m == 0 ? ""
                          : "[[effects.compliance]]\nbody = \"" + body +
                                "\"\nstiffness_n_per_m = " + std::to_string(n_per_m) + "\n";
    };
    return contact_warning(on_floor(moving("light", "ball", 0, 0.1, 0.01) + moving("heavy", "ball", 0, 0.3, 1.0) +
                                    "[effects.contact]\nlaw = \"penalty\"\nstiffness_n_per_m = 20000\n" +
                                    softened("light", light_n_per_m) + softened("floor", floor_n_per_m)));
  };
  EXPECT_NE(says(0, 0).find("20000 N/m"), std::string::npos);
  EXPECT_EQ(says(2500, 0), "") << "in series 2222 N/m, below 2500; the heavy one may have 20,000";
  EXPECT_NE(says(5000, 0).find("4000 N/m"), std::string::npos);
  const std::string warning = says(0, 2500);
  EXPECT_NE(warning.find("between 'light' and 'heavy'"), std::string::npos)
      << "of which neither is softer: " << warning;
  EXPECT_NE(says(4000, 4000).find("3333.33 N/m between 'light' and 'heavy'"), std::string::npos) << says(4000, 4000);
}

TEST(ContactLaws, TellWhenTheSolverGivesUp) {
  // Next to nothing between heavy things; see also the test of `odds run`.
  const auto ran = [](double mass_kg, const std::string& law) {
    auto simulation = simulate(on_floor(moving("a", "cube", 0.03, 0.0249, mass_kg) + moving("b", "bar", 0, 0.1098, 50) +
                                        moving("c", "cube", 0, 0.1995, 500) + contact + law +
                                        "[effects.gravity]\ng_m_per_s2 = [3, 0, -9.81]\n[effects.friction]\nmu = 1\n"));
    run_ticks(*simulation, 300);
    return simulation;
  };
  const auto good = ran(5, "");
  EXPECT_EQ(good->renderer().solver_messages(), 0U);
  EXPECT_EQ(good->solver_warning(), "");
  const auto bad = ran(1e-5, "stiffness_n_per_m = 1e12\ndamping_ns_per_m = 1e12\n");
  const std::uint64_t count = bad->renderer().solver_messages();
  EXPECT_GT(count, 0U);
  EXPECT_NE(bad->solver_warning().find("complained " + std::to_string(count) + " times"), std::string::npos);
  EXPECT_TRUE(bad->renderer().begin());
  EXPECT_EQ(bad->renderer().solver_messages(), 0U);
}

}  // namespace
}  // namespace odds::scene
