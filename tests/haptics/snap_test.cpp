// Fasteners of bodies that turn more easily about one axis than about others.
#include <gtest/gtest.h>

#include <algorithm>

#include "haptics/on_floor.hpp"

namespace odds::scene {
namespace {

constexpr double g = 9.81;

// Held beside its axis, about which it hardly resists: no stiffness and no damping is too much for the step.
TEST(Snap, ASlenderBarSwingsAndGainsNothing) {
  const auto simulation = simulate(
      "format = \"odds.scene/1\"\n[loop]\nseconds = 3\n"
      "[[mesh]]\nname = \"rod\"\nfile = \"made:box:x=1,y=0.01,z=0.01\"\n[[mesh]]\nname = \"stand\"\nfile = "
      "\"made:box\"\n"
      "[[body]]\nname = \"stand\"\nmesh = \"stand\"\n"
      "[[body]]\nname = \"rod\"\nmesh = \"rod\"\nmotion = \"dynamic\"\nmass_kg = 0.1\nposition_m = [0, 0, 0.5]\n" +
      gravity +
      "[effects.snap]\nbody = \"rod\"\nanchor = \"stand\"\npoint_m = [0.1, 0.02, 0]\nsocket_m = [0.1, 0.02, 0.5]\n"
      "capture_m = 0.01\nstiffness_n_per_m = 100000\ndamping_ns_per_m = 1000\nbreak_force_n = 1e9\n");
  const Mat3& inertia = simulation->world().mass({1}).inertia_kg_m2;
  double most_j = -1.0;
  double farthest_m = 0.0;
  run_ticks(*simulation, 3000, [&](int, const haptics::TickRecord&) {
    const ode::BodyState rod = simulation->world().state({1});
    const Vec3 spin = rod.pose.rotation.transpose() * rod.angular_velocity_rad_per_s;
    most_j = std::max(most_j, 0.05 * rod.velocity_m_per_s.squaredNorm() + 0.5 * spin.dot(inertia * spin) +
                                  0.1 * g * (rod.pose.translation.z() - 0.5));
    farthest_m = std::max(farthest_m, (rod.pose * Vec3(0.1, 0.02, 0.0) - Vec3(0.1, 0.02, 0.5)).norm());
  });
  EXPECT_LT(most_j, 1e-4);  // it can fall by 0.1 m: 98 mJ
  EXPECT_LT(farthest_m, 0.001);
}

// A lid of 0.1 kg with fasteners at its corners, or all of them in one place. Put a millimetre too high, it comes down
// by that, and by no more than the springs yield.
TEST(Snap, SeveralOnABodyHoldItStillHoweverStiff) {
  struct Case {
    int count;
    double apart_m;
    double stiffness_n_per_m;
    double damping_ns_per_m;
  };
  for (const Case& c : {Case{4, 0.0, 1e3, 1000.0}, Case{8, 0.018, 1e4, 1000.0}, Case{2, 0.0, 1e6, 10.0},
                        Case{4, 0.018, 1e6, 0.0}, Case{8, 0.018, 1e5, 10.0}}) {
    std::string text =
        "format = \"odds.scene/1\"\n[loop]\nseconds = 1\n"
        "[[mesh]]\nname = \"cube\"\nfile = \"made:box:x=0.04,y=0.04,z=0.04\"\n"
        "[[body]]\nname = \"box\"\nmesh = \"cube\"\n"
        "[[body]]\nname = \"lid\"\nmesh = \"cube\"\nmotion = \"dynamic\"\nmass_kg = 0.1\n"
        "position_m = [0, 0, 0.001]\n" +
        gravity;
    for (int i = 0; i < c.count; ++i) {
      const auto side = [&](int bit) { return std::to_string((i >> bit & 1) != 0 ? c.apart_m : -c.apart_m); };
      const std::string at = "[" + side(0) + ", " + side(1) + ", " + side(2) + "]\n";
      text += "[[effects.snap]]\nbody = \"lid\"\nanchor = \"box\"\npoint_m = " + at + "socket_m = " + at +
              "capture_m = 0.005\nbreak_force_n = 1e9\nstiffness_n_per_m = " + std::to_string(c.stiffness_n_per_m) +
              "\ndamping_ns_per_m = " + std::to_string(c.damping_ns_per_m) + "\n";
    }
    const auto simulation = simulate(text);
    run_ticks(*simulation, 900);
    double fastest_m_per_s = 0.0;
    run_ticks(*simulation, 100, [&](int, const haptics::TickRecord&) {
      fastest_m_per_s = std::max(fastest_m_per_s, simulation->world().state({1}).velocity_m_per_s.norm());
    });
    EXPECT_LT(fastest_m_per_s, 0.002) << c.count << " of " << c.stiffness_n_per_m;
    EXPECT_NEAR(simulation->world().state({1}).pose.translation.z(), 0.0, 0.001) << c.count;
  }
}

}  // namespace
}  // namespace odds::scene
