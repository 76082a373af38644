// What each effect does, by a law that can be checked by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "haptics/on_floor.hpp"
#include "odds/haptics/effect_registry.hpp"

namespace odds::scene {
namespace {

constexpr double g = 9.81;

class Restitution : public testing::TestWithParam<double> {};

TEST_P(Restitution, ABallRisesToTheSquareOfTheCoefficient) {
  const double e = GetParam();
  const auto simulation =
      simulate(on_floor(moving("ball", "ball", 0, 0.22)  // falls 0.2 m
                        + contact + gravity + "[effects.restitution]\ncoefficient = " + std::to_string(e)));
  double highest = 0.0;
  bool touched = false;
  run_ticks(*simulation, 600, [&](int, const haptics::TickRecord& tick) {
    touched = touched || tick.contacts > 0;
    if (!touched) return;
    const ode::BodyState ball = simulation->world().state({1});
    if (ball.velocity_m_per_s.z() > 0.0) highest = std::max(highest, ball.pose.translation.z() - 0.02);
  });
  EXPECT_NEAR(highest, e * e * 0.2, 0.07 * e * e * 0.2 + 0.001);
}
INSTANTIATE_TEST_SUITE_P(Coefficients, Restitution, testing::Values(0.3, 0.6, 0.9, 1.0));

TEST(Effects, WithoutRestitutionABallStaysDown) {
  const auto simulation =
      simulate(on_floor(moving("ball", "ball", 0, 0.22) + "[effects.contact]\ndamping_ns_per_m = 400\n" + gravity));
  run_ticks(*simulation, 1000);
  EXPECT_LT(simulation->world().state({1}).velocity_m_per_s.norm(), 0.01);
  EXPECT_NEAR(simulation->world().state({1}).pose.translation.z(), 0.02, 0.001);
}

TEST(Effects, AConveyorCarriesACubeAtItsOwnSpeed) {
  const auto simulation =
      simulate(on_floor(moving("cube", "cube", 0, 0.02) + contact + gravity +
                        "[effects.friction]\nmu = 0.5\n[effects.surface_velocity]\nbody = \"floor\"\n"
                        "velocity_m_per_s = [0.3, 0, 0]\n"));
  run_ticks(*simulation, 1000);
  const ode::BodyState cube = simulation->world().state({1});
  EXPECT_NEAR(cube.velocity_m_per_s.x(), 0.3, 0.003);
  EXPECT_NEAR(cube.velocity_m_per_s.y(), 0.0, 0.003);
  // Accelerated by mu g until it moves with the belt, then carried along.
  EXPECT_NEAR(cube.pose.translation.x(), 0.3 * (1.0 - 0.5 * 0.3 / (0.5 * g)), 0.01);
}

TEST(Effects, RollingFrictionStopsABallAfterTheWayThatEnergySays) {
  const double rolling_m = 0.002;  // the ball's facets take a little too
  const auto simulation =
      simulate(on_floor(moving("ball", "ball", 0, 0.02) + contact + gravity +
                            "[effects.friction]\nmu = 0.8\n[effects.rolling_friction]\nrolling_m = 0.002\n",
                        4.0));
  run_ticks(*simulation, 100);
  throw_body(*simulation, 1, Vec3(0.3, 0, 0), Vec3(0, 15.0, 0));
  const double from = simulation->world().state({1}).pose.translation.x();
  run_ticks(*simulation, 2500);
  const ode::BodyState ball = simulation->world().state({1});
  EXPECT_LT(ball.velocity_m_per_s.norm(), 0.01);
  const double energy_per_kg = 0.5 * 0.3 * 0.3 * (1.0 + 0.4);
  EXPECT_NEAR(ball.pose.translation.x() - from, energy_per_kg / (rolling_m / 0.02 * g), 0.012);
}

TEST(Effects, SpinningFrictionStopsASpinOnTheSpot) {
  const std::string scene = moving("ball", "ball", 0, 0.02) + contact + gravity;
  const auto with = simulate(on_floor(scene + "[effects.rolling_friction]\nspinning_m = 0.001\n"));
  const auto without = simulate(on_floor(scene));
  for (const auto& simulation : {std::cref(with), std::cref(without)}) {
    run_ticks(*simulation.get(), 100);
    throw_body(*simulation.get(), 1, Vec3::Zero(), Vec3(0, 0, 20.0));
    run_ticks(*simulation.get(), 500);
  }
  // Torque 0.001 m * m g against inertia 0.4 m r^2: 61 rad/s2, so that it stands after a third of a second.
  EXPECT_LT(std::abs(with->world().state({1}).angular_velocity_rad_per_s.z()), 0.5);
  EXPECT_GT(without->world().state({1}).angular_velocity_rad_per_s.z(), 18.0);
}

TEST(Effects, StaticFrictionHoldsWhatSlidingFrictionDoesNot) {
  // Gravity leans by a slope of 0.4: more than mu = 0.3, less than the static 0.6.
  const std::string lean = "[effects.gravity]\ng_m_per_s2 = [3.5, 0, -9]\n";
  const std::string scene = moving("cube", "cube", 0, 0.0199) + contact + lean;
  const auto sticks = simulate(on_floor(scene + "[effects.friction]\nmu = 0.3\nstatic_mu = 0.6\n"));
  const auto slides = simulate(on_floor(scene + "[effects.friction]\nmu = 0.3\n"));
  run_ticks(*sticks, 700);
  run_ticks(*slides, 700);
  EXPECT_LT(sticks->world().state({1}).pose.translation.x(), 0.01);
  EXPECT_GT(slides->world().state({1}).pose.translation.x(), 0.1);
  throw_body(*sticks, 1, Vec3(0.3, 0, 0));  // pushed off, it slides on
  run_ticks(*sticks, 500);
  EXPECT_GT(sticks->world().state({1}).velocity_m_per_s.x(), 0.35);
}

TEST(Effects, ViscousFrictionSlidesAtTheSpeedThatBalancesTheSlope) {
  const auto simulation = simulate(on_floor(moving("cube", "cube", -1.0, 0.0199) + contact +
                                                "[effects.gravity]\ng_m_per_s2 = [2, 0, -9]\n"
                                                "[effects.friction]\nmu = 0.1\nviscous_ns_per_m = 0.5\n",
                                            3.0));
  run_ticks(*simulation, 2500);
  // m (2 - 0.1 * 9) = 0.11 N against 0.5 N s/m
  EXPECT_NEAR(simulation->world().state({1}).velocity_m_per_s.x(), 0.22, 0.02);
}

TEST(Effects, ASoftBodySinksByTheSpringsInSeries) {
  const auto simulation = simulate(
      on_floor(moving("cube", "cube", 0, 0.0195, 0.5) + "[effects.contact]\nstiffness_n_per_m = 20000\n" + gravity +
                   "[effects.compliance]\nbody = \"cube\"\nstiffness_n_per_m = 2000\ndamping_ns_per_m = 30\n",
               2.0));
  run_ticks(*simulation, 2000);
  const double stiffness = 1.0 / (1.0 / 20000 + 1.0 / 2000);
  EXPECT_NEAR(0.02 - simulation->world().state({1}).pose.translation.z(), 0.5 * g / stiffness,
              0.1 * 0.5 * g / stiffness);
}

// The second cube's centre is `z` above the first's, well above the floor; how far it came in some ticks.
Vec3 settled(const std::string& effects, double z, std::uint64_t work_units, int ticks) {
  std::string text = on_floor("[[body]]\nname = \"block\"\nmesh = \"cube\"\nposition_m = [0, 0, 0.5]\n" +
                              moving("cube", "cube", 0.01, 0.5 + z, 0.5) + contact + effects);
  const std::string asked = "work_units = 20000";
  text.replace(text.find(asked), asked.size(), "work_units = " + std::to_string(work_units));
  const auto simulation = simulate(text);
  run_ticks(*simulation, ticks);
  return simulation->world().state({2}).pose.translation - Vec3(0.01, 0, 0.5 + z);
}

TEST(Effects, ADeepOverlapPushesTheSameWhateverTheBudget) {
  const std::string deep = "[effects.deep_contact]\nspheres = 32\n";
  const Vec3 starved = settled(deep, 0.01, 5, 12);
  const Vec3 exact = settled(deep, 0.01, 20000, 12);
  EXPECT_EQ(starved, exact) << "bit for bit";
  EXPECT_GT(exact.dot(Vec3(1, 0, 1)), 0.001) << "out, the way it is aside already";
  EXPECT_NE(settled("", 0.01, 5, 12), settled("", 0.01, 20000, 12)) << "or there was nothing to show";
}

TEST(Effects, AShallowContactIsLeftAsItIs) {
  const std::string weight = gravity + "[effects.damping]\nangular_per_s = 1\n";
  EXPECT_EQ(settled("[effects.deep_contact]\nspheres = 32\n" + weight, 0.0399, 20000, 100),
            settled(weight, 0.0399, 20000, 100));
}

// The force on a ball of 1 kg, in one tick from rest, at places along a line from 1.5 mm to 20 mm into a block.
std::vector<Vec3> forces_into_block(const std::string& effects, double step) {
  const auto simulation = simulate(on_floor("[[body]]\nname = \"block\"\nmesh = \"cube\"\nposition_m = [0, 0, 0.5]\n" +
                                            moving("ball", "ball", 0.0, 0.6, 1.0) + effects));
  std::vector<Vec3> forces;
  for (double depth = 0.0015; depth < 0.02; depth += step) {
    ode::BodyState state = simulation->world().state({2});
    state.pose = {Mat3::Identity(), Vec3(0.002, 0.001, 0.54 - depth)};
    state.velocity_m_per_s = state.angular_velocity_rad_per_s = Vec3::Zero();
    simulation->world().set_state({2}, state);
    run_ticks(*simulation, 1);
    forces.push_back(simulation->world().state({2}).velocity_m_per_s / 1e-3);
  }
  return forces;
}

double largest_step(const std::vector<Vec3>& forces) {
  double largest = 0.0;
  for (std::size_t i = 1; i < forces.size(); ++i) largest = std::max(largest, (forces[i] - forces[i - 1]).norm());
  return largest;
}

TEST(Effects, OneLawTakesOverFromTheOtherWithoutAStep) {
  constexpr double step = 2e-5;
  const std::string deep = "[effects.deep_contact]\nspheres = 64\n";
  const auto free = forces_into_block("[effects.contact]\nmax_correcting_velocity_m_per_s = 1000\n" + deep, step);
  std::printf("  the largest step of force: %.3g N; of the spring alone %.3g N\n", largest_step(free), 20000.0 * step);
  EXPECT_LT(largest_step(free), 2.0 * 20000.0 * step);
  EXPECT_GT(free.back().z(), 300.0);
  // In series with a soft body, the contacts that join have no share of it yet.
  const auto soft = forces_into_block("[effects.contact]\nmax_correcting_velocity_m_per_s = 1000\n" + deep +
                                          "[effects.compliance]\nbody = \"ball\"\nstiffness_n_per_m = 3000\n",
                                      step);
  EXPECT_LT(largest_step(soft), 2.0 * 3000.0 * step);
  EXPECT_GT(soft.back().z(), 40.0);
}

TEST(Effects, ABoundOfTheCorrectingVelocityTurnsNoForceOfDeepContacts) {
  const std::string deep = "[effects.deep_contact]\nspheres = 64\n";
  const auto free = forces_into_block("[effects.contact]\nmax_correcting_velocity_m_per_s = 1000\n" + deep, 1e-4);
  const auto bounded = forces_into_block(contact + deep, 1e-4);
  ASSERT_EQ(free.size(), bounded.size());
  for (std::size_t i = free.size() / 2; i < free.size(); ++i) {
    EXPECT_LT(bounded[i].norm(), 0.3 * free[i].norm()) << "it is bounded";
    EXPECT_GT(bounded[i].normalized().dot(free[i].normalized()), 1.0 - 1e-6);
  }
}

TEST(Effects, AFluidBringsABodyToTheSpeedOfItsFlow) {
  const std::string scene = moving("ball", "ball", 0, 0.5);
  const auto simulation =
      simulate(on_floor(scene + "[effects.viscosity]\ndrag_ns_per_m = 0.5\nflow_m_per_s = [0.2, 0, 0]\n"));
  run_ticks(*simulation, 400);  // two time constants of m / c = 0.2 s
  EXPECT_NEAR(simulation->world().state({1}).velocity_m_per_s.x(), 0.2 * (1.0 - std::exp(-2.0)), 1e-3);
  const auto stiff =
      simulate(on_floor(scene + "[effects.viscosity]\ndrag_ns_per_m = 1e6\nangular_drag_nms_per_rad = 1e6\n"));
  throw_body(*stiff, 1, Vec3(1, 0, 0), Vec3(0, 30, 0));
  run_ticks(*stiff, 3);
  EXPECT_LT(stiff->world().state({1}).velocity_m_per_s.norm(), 1e-9);
  EXPECT_LT(stiff->world().state({1}).angular_velocity_rad_per_s.norm(), 0.1);
  const auto outside = simulate(
      on_floor(scene + "[effects.viscosity]\ndrag_ns_per_m = 0.5\nlower_m = [1, -1, -1]\nupper_m = [2, 1, 1]\n"));
  throw_body(*outside, 1, Vec3(0.5, 0, 0));
  run_ticks(*outside, 100);
  EXPECT_EQ(outside->world().state({1}).velocity_m_per_s.x(), 0.5);
  EXPECT_EQ(outside->effects().cost(0).evaluations, 0U);
}

// Together they are one fluid of their drags' sum, which flows with the mean of their flows.
TEST(Effects, FluidsInOnePlaceTurnNoSpeedRoundHoweverStrong) {
  const auto fluid = [](double drag, double flow) {
    return "[[effects.viscosity]]\ndrag_ns_per_m = " + std::to_string(drag) +
           "\nangular_drag_nms_per_rad = " + std::to_string(drag) + "\nflow_m_per_s = [" + std::to_string(flow) +
           ", 0, 0]\n";
  };
  const auto simulation =
      simulate(on_floor(moving("ball", "ball", 0, 0.5) + fluid(1000, 0.1) + fluid(1000, 0.1) + fluid(2000, 0.3)));
  throw_body(*simulation, 1, Vec3(1, 0, 0), Vec3(0, 30, 0));
  double least = 1.0;
  run_ticks(*simulation, 50, [&](int, const haptics::TickRecord&) {
    const ode::BodyState ball = simulation->world().state({1});
    least = std::min(least, ball.velocity_m_per_s.x());
    EXPECT_NEAR(ball.velocity_m_per_s.x(), 0.2, 1e-9);
    EXPECT_LT(ball.angular_velocity_rad_per_s.norm(), 0.1);
  });
  EXPECT_GT(least, 0.0);
  const auto weak = simulate(on_floor(moving("ball", "ball", 0, 0.5) + fluid(0.2, 0.1) + fluid(0.3, 0.4)));
  run_ticks(*weak, 400);  // two time constants of m / c = 0.2 s
  EXPECT_NEAR(weak->world().state({1}).velocity_m_per_s.x(), 0.28 * (1.0 - std::exp(-2.0)), 1e-3);
}

TEST(Effects, AMagnetDrawsMostAtItsRangeOverRootThreeAndKeepsTheEnergy) {
  const auto simulation = simulate(
      on_floor(moving("ball", "ball", 0.3, 0.5) +
                   "[[body]]\nname = \"magnet\"\nmesh = \"cube\"\nposition_m = [0, 0, 0.5]\n"
                   "[effects.attraction]\nbody = \"ball\"\nto = \"magnet\"\nmax_force_n = 0.5\nrange_m = 0.1\n",
               3.0));
  const double softening = 1.0 + 1e-6 * 16.0 / (3.0 * std::sqrt(3.0)) * 0.5 / 0.1 / 0.1;
  double greatest = 0.0;
  double where = 0.0;
  double last = 0.0;
  double energy_low = 1e9;
  double energy_high = -1e9;
  run_ticks(*simulation, 3000, [&](int, const haptics::TickRecord&) {
    const ode::BodyState ball = simulation->world().state({1});
    const double v = ball.velocity_m_per_s.x();
    const double x = ball.pose.translation.x();
    if (std::abs(v - last) > greatest) {
      greatest = std::abs(v - last);
      where = std::abs(x);
    }
    last = v;
    // U = -A / (1 + (x/r)^2) with F = 2 A / r * (x/r) / (1 + ...)^2
    const double a = 0.5 * 0.1 * 16.0 / (3.0 * std::sqrt(3.0)) * 0.5 / softening;
    const double energy = 0.5 * 0.1 * v * v - a / (1.0 + 100.0 * x * x);
    energy_low = std::min(energy_low, energy);
    energy_high = std::max(energy_high, energy);
  });
  EXPECT_NEAR(greatest * 0.1 / 0.001, 0.5, 0.005);  // m dv / h
  EXPECT_NEAR(where, 0.1 / std::sqrt(3.0), 0.003);
  EXPECT_LT(energy_high - energy_low, 0.002);  // of a well that is 0.077 J deep
}

TEST(Effects, AMagnetTooStiffForTheStepSaysHowStrongItIs) {
  const auto warnings = [](double mass, const std::string& range) {
    return simulate(
               on_floor(moving("ball", "ball", 0.3, 0.5, mass) +
                        "[effects.attraction]\nbody = \"ball\"\nto = \"floor\"\nmax_force_n = 1\nrange_m = " + range))
        ->warnings();
  };
  EXPECT_TRUE(warnings(0.1, "0.1").empty());
  ASSERT_EQ(warnings(0.001, "0.001").size(), 1U);
  EXPECT_NE(warnings(0.001, "0.001")[0].find("the magnet of 1 N between 'ball' and 'floor' is 0.245 N strong"),
            std::string::npos)
      << warnings(0.001, "0.001")[0];
}

TEST(Effects, AMagnetThatIsFixedDrawsToItsMiddleWhereverTheOriginOfItsMeshIs) {
  const auto simulation =
      simulate(on_floor(moving("ball", "ball", 0.3, 0.5) +
                        "[[mesh]]\nname = \"block\"\nfile = \"made:terrain:side=0.1,height=0.01,depth=0.4,cells=4\"\n"
                        "[[body]]\nname = \"magnet\"\nmesh = \"block\"\nposition_m = [0, 0, 0.5]\n"
                        "[effects.attraction]\nbody = \"ball\"\nto = \"magnet\"\nmax_force_n = 0.5\nrange_m = 0.1\n"));
  const mesh::TriangleMesh& block = simulation->world().shape({2})->mesh();  // from -0.4 m to about 0
  const Vec3 towards = 0.5 * (block.lower() + block.upper()) - Vec3(0.3, 0.0, 0.0);
  run_ticks(*simulation, 1, [](int, const haptics::TickRecord&) {});
  const Vec3 drawn = simulation->world().state({1}).velocity_m_per_s.normalized();
  EXPECT_LT((drawn - towards.normalized()).norm(), 1e-6) << drawn.transpose();
}

TEST(Effects, ASnapHoldsUntilItIsPulledTooHardAndCatchesAgain) {
  // Held by 3 N at most: a weight of 0.2 kg hangs, one of 0.4 kg tears off.
  const std::string snap =
      "[effects.snap]\nbody = \"cube\"\nanchor = \"floor\"\npoint_m = [0, 0, 0]\nsocket_m = [0, 0, 0.5]\n"
      "capture_m = 0.001\nstiffness_n_per_m = 2000\ndamping_ns_per_m = 20\nbreak_force_n = 3\n";
  for (const auto& [mass, holds] : {std::pair{0.2, true}, std::pair{0.4, false}}) {
    const auto simulation = simulate(on_floor(moving("cube", "cube", 0, 0.45, mass) + gravity + snap));
    run_ticks(*simulation, 1000);
    const double z = simulation->world().state({1}).pose.translation.z();
    if (holds) {
      EXPECT_NEAR(z, 0.45 - mass * g / 2000.0, 1e-5);
    } else {
      EXPECT_LT(z, 0.2);
      simulation->world().set_state({1}, {{Mat3::Identity(), Vec3(0, 0, 0.45)}, Vec3::Zero(), Vec3::Zero()});
      run_ticks(*simulation, 2);
      EXPECT_GT(simulation->effects().cost(1).evaluations, 0U);
    }
  }
}

TEST(Effects, AnAsymmetricBodyTumblesAndKeepsItsEnergyAndMomentum) {
  const auto state_after = [](const std::string& effects) {
    const auto simulation = simulate(on_floor(moving("bar", "bar", 0, 0.5) + effects));
    throw_body(*simulation, 1, Vec3::Zero(), Vec3(0.01, 0.01, 12.0));  // about the middle axis, slightly off
    double turned_over = 0.0;
    double most_energy = 0.0;
    const Mat3 inertia = simulation->world().mass({1}).inertia_kg_m2;
    run_ticks(*simulation, 2000, [&](int, const haptics::TickRecord&) {
      const ode::BodyState s = simulation->world().state({1});
      const Vec3 w = s.pose.rotation.transpose() * s.angular_velocity_rad_per_s;
      turned_over = std::min(turned_over, w.z());
      most_energy = std::max(most_energy, 0.5 * w.dot(inertia * w));
    });
    return std::pair{turned_over, most_energy / (0.5 * 144.0 * inertia(2, 2))};
  };
  const auto [with, energy] = state_after("[effects.gyroscopic]\n");
  const auto [without, same] = state_after("[effects.viscosity]\ndrag_ns_per_m = 0\n");
  EXPECT_LT(energy, 1.001) << "it must not gain energy";
  EXPECT_NEAR(same, 1.0, 1e-3);
  EXPECT_GE(without, 0.0);
  EXPECT_LT(with, -8.0) << "turning about its middle axis it must turn over";
}

TEST(Effects, EventsAloneMakeNoContactsAndTellBeginAndEnd) {
  const auto simulation = simulate(on_floor(moving("ball", "ball", 0, 0.05) + gravity + "[effects.events]\n", 0.5));
  const RunOutcome outcome = simulation->run();
  ASSERT_EQ(outcome.events.size(), 2U);  // it falls through the floor, and is in touch with it also while within
  EXPECT_TRUE(outcome.events[0].begins);
  EXPECT_FALSE(outcome.events[1].begins);
  const double begin_s = 1e-9 * static_cast<double>(outcome.events[0].t_ns);
  EXPECT_NEAR(begin_s, std::sqrt(2.0 * 0.03 / g), 0.002);
  const double end_s = 1e-9 * static_cast<double>(outcome.events[1].t_ns);
  EXPECT_NEAR(end_s, std::sqrt(2.0 * (0.03 + 0.1 + 0.04) / g), 0.002);
  EXPECT_EQ(simulation->world().options().query.max_contacts, 0) << "a verdict is all that is asked";
  std::uint64_t queries = 0;
  for (const haptics::TickRecord& tick : outcome.ticks) {
    queries += tick.queries;
    ASSERT_EQ(tick.contacts, 0U);
  }
  EXPECT_GT(queries, 10U);
}

// ODE gives the two bodies of a pair in an order that changes as they move.
TEST(Effects, EventsOfAPileBeginAndEndByTurns) {
  std::string bodies;
  for (int i = 0; i < 14; ++i) {
    bodies += moving("ball" + std::to_string(i), "ball", 0.004 * (i % 5) - 0.007 * (i % 3), 0.03 + 0.045 * i);
  }
  const std::string effects = "[effects.contact]\n[effects.events]\n";
  const RunOutcome outcome = simulate(on_floor(bodies + gravity + effects, 1.0))->run();
  std::map<std::pair<std::uint32_t, std::uint32_t>, bool> touching;
  for (const haptics::ContactEvent& event : outcome.events) {
    bool& before = touching[std::minmax(event.a.index, event.b.index)];
    ASSERT_NE(before, event.begins) << 1e-6 * static_cast<double>(event.t_ns) << " ms";
    before = event.begins;
  }
  EXPECT_GT(outcome.events.size(), 20U);
}

TEST(Effects, ATextureIsFeltAtItsWavelengthAndGivesNoEnergy) {
  // A ball is drawn over ridges 4 mm apart at 40 mm/s: ten a second.
  const std::string hand =
      "[[body]]\nname = \"tip\"\nmesh = \"ball\"\nmotion = \"dynamic\"\nmass_kg = 0.05\ndevice = \"hand\"\n"
      "[device.hand]\ntype = \"scripted\"\nposition_m = [0, 0, 0.018]\n[[device.hand.motion]]\nkind = \"slide\"\n"
      "duration_s = 3.0\nby_m = [0.12, 0, 0]\n";
  const std::string effects = "[effects.contact]\n[effects.virtual_coupling]\n";
  const std::string ridges = "[effects.texture]\nbody = \"floor\"\namplitude_m = 0.00002\nwavelength_m = 0.004\n";
  const RunOutcome smooth = simulate(on_floor(hand + effects, 3.0))->run();
  const RunOutcome rough = simulate(on_floor(hand + effects + ridges, 3.0))->run();
  const auto turns = [](const RunOutcome& run) {  // how often the force crosses its mean upwards
    double mean = 0.0;
    for (std::size_t i = 500; i < 2500; ++i) mean += run.ticks[i].force_n[2] / 2000.0;
    int count = 0;
    for (std::size_t i = 501; i < 2500; ++i)
      count += run.ticks[i - 1].force_n[2] <= mean && run.ticks[i].force_n[2] > mean ? 1 : 0;
    return count;
  };
  const double way = rough.ticks[2500].tool_position_m[0] - rough.ticks[500].tool_position_m[0];
  EXPECT_NEAR(turns(rough), way / 0.004, 2.0);
  EXPECT_LT(turns(smooth), turns(rough) / 2);
}

TEST(Effects, AStrikeRingsAtItsFrequencyAndDiesAway) {
  const std::string hand =
      "[[body]]\nname = \"tip\"\nmesh = \"ball\"\nmotion = \"dynamic\"\nmass_kg = 0.02\ndevice = \"hand\"\n"
      "[device.hand]\ntype = \"scripted\"\nposition_m = [0, 0, 0.05]\n[[device.hand.motion]]\nkind = \"slide\"\n"
      "duration_s = 0.3\nby_m = [0, 0, -0.031]\n";
  const std::string effects = "[effects.contact]\n[effects.virtual_coupling]\n";
  const auto with =
      simulate(on_floor(hand + effects + "[effects.vibration]\nforce_ns_per_m = 20\nfrequency_hz = 100\n", 0.6));
  const RunOutcome rings = with->run();
  const RunOutcome plain = simulate(on_floor(hand + effects, 0.6))->run();
  double most = 0.0;
  double late = 0.0;
  for (std::size_t i = 0; i < 600; ++i) {
    const double difference = std::abs(rings.ticks[i].force_n[2] - plain.ticks[i].force_n[2]);
    most = std::max(most, difference);
    if (i > 500) late = std::max(late, difference);
  }
  EXPECT_GT(most, 0.1);
  EXPECT_LE(most, 1.0 + 1e-9);
  EXPECT_LT(late, 0.01);
  EXPECT_GT(rings.effects.back().evaluations, 20U);
}

TEST(Effects, ThreeDegreesOfFreedomSendNoTorque) {
  const std::string hand =
      "[[body]]\nname = \"tip\"\nmesh = \"bar\"\nmotion = \"dynamic\"\nmass_kg = 0.05\ndevice = \"hand\"\n"
      "[device.hand]\ntype = \"scripted\"\nposition_m = [2.05, 0, 0.06]\n[[device.hand.motion]]\nkind = \"slide\"\n"
      "duration_s = 0.5\nby_m = [0, 0, -0.015]\n";
  const auto most_torque = [&](const std::string& keys) {
    const RunOutcome outcome =
        simulate(on_floor(hand + "[effects.contact]\n[effects.virtual_coupling]\n" + keys, 0.6))->run();
    double most = 0.0;
    for (const haptics::TickRecord& tick : outcome.ticks) {
      most = std::max(most, Vec3(tick.torque_nm[0], tick.torque_nm[1], tick.torque_nm[2]).norm());
    }
    return most;
  };
  EXPECT_GT(most_torque(""), 0.01);
  EXPECT_EQ(most_torque("degrees_of_freedom = 3\n"), 0.0);
}

TEST(Effects, RefuseWhatCannotWork) {
  const std::string ball = moving("ball", "ball", 0, 0.1);
  const auto says = [&](const std::string& effects, const char* part) {
    const std::string message = refusal(on_floor(ball + effects));
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  says("[effects.rolling_friction]\nrolling_m = 0.001\n", "rolling friction needs contact");
  says("[effects.contact]\n[effects.surface_velocity]\nbody = \"floor\"\nvelocity_m_per_s = [1, 0, 0]\n",
       "needs friction");
  says("[effects.contact]\n[effects.rolling_friction]\n", "does nothing");
  says("[effects.contact]\n[effects.restitution]\ncoefficient = 1.5\n", "out of range");
  says("[effects.contact]\n[effects.deep_contact]\nfrom = 0.5\nfull = 0.4\n", "give more than 'from'");
  says("[effects.contact]\n[effects.deep_contact]\nspheres = 1000\n", "8 to 512");
  says("[effects.attraction]\nbody = \"bal\"\nto = \"floor\"\nmax_force_n = 1\nrange_m = 1\n", "did you mean 'ball'");
  says("[effects.attraction]\nbody = \"floor\"\nto = \"ball\"\nmax_force_n = 1\nrange_m = 1\n", "never moves");
  says("[effects.attraction]\nbody = \"ball\"\nto = \"ball\"\nmax_force_n = 1\nrange_m = 1\n", "itself");
  says("[effects.vibration]\nfrequency_hz = 100\n", "no device");
  says("[effects.passivity_control]\n", "no device");
  says("[[effects.gravity]]\n[[effects.gravity]]\n", "2 times");
  says("[effects.contact]\n[effects.texture]\nbody = \"floor\"\namplitude_m = 0.01\nwavelength_m = 0.004\n",
       "45 degrees");
  says(
      "[effects.snap]\nbody = \"ball\"\nanchor = \"floor\"\ncapture_m = 0.1\nstiffness_n_per_m = 1000\nbreak_force_n = "
      "1\n",
      "break as soon");
  says("[effects.contact]\n[effects.friction]\nmu = 0.5\nstatic_mu = 0.2\n", "less than");
  says(
      "[[effects.viscosity]]\ndrag_ns_per_m = 1\n[[effects.viscosity]]\ndrag_ns_per_m = 2\nlower_m = [1, 1, "
      "1]\nupper_m = [0, 2, 2]\n",
      "empty");
  EXPECT_EQ(
      refusal(on_floor(ball + "[[effects.viscosity]]\ndrag_ns_per_m = 1\n[[effects.viscosity]]\ndrag_ns_per_m = 2\n")),
      "taken");
}

TEST(Effects, RefuseBodiesThatTheyCanDoNothingWith) {
  for (const auto& [file, why] : {std::pair{"made:terrain", "two bodies with closed meshes"},
                                  {"made:box:x=10,y=10,z=1e-6", "too thin to hold a sphere"}}) {
    auto parsed = parse_scene(
        "format = \"odds.scene/1\"\n[loop]\nseconds = 1\n[[mesh]]\nname = \"sheet\"\nfile = \"" + std::string(file) +
            "\"\n[[body]]\nname = \"one\"\nmesh = \"sheet\"\n[[body]]\nname = \"two\"\nmesh = \"sheet\"\nmotion = "
            "\"dynamic\"\nmass_kg = 1\n[effects.contact]\n[effects.deep_contact]\n",
        "test.toml", ".");
    ASSERT_TRUE(parsed.ok()) << parsed.error().message();
    const auto made = Simulation::make(std::move(parsed).value(), {});
    ASSERT_FALSE(made.ok());
    const std::string message = made.error().message();
    EXPECT_NE(message.find("test.toml:16"), std::string::npos) << message;
    EXPECT_NE(message.find(why), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace odds::scene
