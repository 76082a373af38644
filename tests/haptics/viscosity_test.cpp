// Fluids about bodies that turn more easily about one axis than about others.
#include <gtest/gtest.h>

#include <cmath>

#include "haptics/on_floor.hpp"

namespace odds::scene {
namespace {

// As strong a drag as stops its spin about its length within a step, and its turning about the others in a second.
TEST(Viscosity, ASlenderBarIsSlowedAboutEachAxisByItsOwnMoment) {
  const auto simulation = simulate(
      "format = \"odds.scene/1\"\n[loop]\nseconds = 1\n[[mesh]]\nname = \"rod\"\n"
      "file = \"made:box:x=1,y=0.01,z=0.01\"\n"
      "[[body]]\nname = \"rod\"\nmesh = \"rod\"\nmotion = \"dynamic\"\nmass_kg = 0.12\n"
      "orientation_wxyz = [0.6, 0, 0, 0.8]\n"
      "[effects.viscosity]\ndrag_ns_per_m = 0\nangular_drag_nms_per_rad = 0.02\n");
  const double across = 0.12 * (1.0 + 0.0001) / 12.0;
  throw_body(*simulation, 0, Vec3::Zero(), Vec3(0, 0, 3));
  run_ticks(*simulation, 500);
  EXPECT_NEAR(simulation->world().state({0}).angular_velocity_rad_per_s.z(), 3.0 * std::exp(-0.02 * 0.5 / across),
              1e-3);
  const Vec3 along = simulation->world().state({0}).pose.rotation * Vec3::UnitX();
  throw_body(*simulation, 0, Vec3::Zero(), 30.0 * along);
  run_ticks(*simulation, 3);
  EXPECT_LT(simulation->world().state({0}).angular_velocity_rad_per_s.norm(), 1e-6);
}

}  // namespace
}  // namespace odds::scene
