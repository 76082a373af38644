// What a texture makes of a contact.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "haptics/on_floor.hpp"
#include "odds/haptics/effect_registry.hpp"

namespace odds::scene {
namespace {

// A point of the ball in the floor, as steep ridges as there may be, and the work of its spring on a way. Out of a
// potential nobody gets work by going round.
class RidgedFloor {
 public:
  RidgedFloor()
      : simulation_(simulate(on_floor(moving("ball", "ball", 0, 0.5) + contact +
                                      "[effects.texture]\nbody = \"floor\"\namplitude_m = 0.0006\n"
                                      "wavelength_m = 0.004\n"))) {
    const std::array<haptics::BodyInfo, 2> bodies = {{{"floor", false}, {"ball", true}}};
    auto made = haptics::make_effect("texture", {&simulation_->scene().find_effect("texture")->settings, bodies, 1e-3});
    EXPECT_TRUE(made.ok());
    texture_ = std::move(made).value();
  }
  // On the ball, at a place and a depth below the floor's flat surface. `floor_first`: of which body ODE tells first.
  Vec3 force_n(double x_m, double depth_m, bool floor_first) {
    std::array<ode::ContactPoint, 1> points;
    points[0].position_m = {x_m, 0.0, 0.0};
    points[0].normal = floor_first ? Vec3(-Vec3::UnitZ()) : Vec3::UnitZ();
    points[0].depth_m = depth_m;
    points[0].surface.stiffness_n_per_m = 1000.0;
    ode::Meeting meeting;
    meeting.a = {floor_first ? 0U : 1U};
    meeting.b = {floor_first ? 1U : 0U};
    meeting.contacts = points;
    haptics::TickView tick;
    tick.world = &simulation_->world();
    texture_->meet(tick, meeting);
    const double push = points[0].surface.stiffness_n_per_m * points[0].depth_m;
    return (floor_first ? -push : push) * points[0].normal;
  }
  double work_j(double from_x, double from_depth, double to_x, double to_depth, bool floor_first) {
    constexpr int steps = 2000;
    const Vec3 way((to_x - from_x) / steps, 0.0, (from_depth - to_depth) / steps);
    double work = 0.0;
    for (int i = 0; i < steps; ++i) {
      const double share = (i + 0.5) / steps;
      const double x = from_x + share * (to_x - from_x);
      work += force_n(x, from_depth + share * (to_depth - from_depth), floor_first).dot(way);
    }
    return work;
  }

 private:
  std::unique_ptr<Simulation> simulation_;
  std::unique_ptr<haptics::Effect> texture_;
};

TEST(Texture, GivesNoWorkToWhatGoesInOnAFlankAndOutInAValley) {
  RidgedFloor floor;
  for (const bool floor_first : {false, true}) {
    const double in = floor.work_j(0.0, 0.001, 0.0, 0.003, floor_first);
    const double along = floor.work_j(0.0, 0.003, 0.003, 0.003, floor_first);
    const double out = floor.work_j(0.003, 0.003, 0.003, 0.001, floor_first);
    const double back = floor.work_j(0.003, 0.001, 0.0, 0.001, floor_first);
    EXPECT_NEAR(in, -0.5 * 1000.0 * (0.003 * 0.003 - 0.001 * 0.001), 1e-9);
    EXPECT_LT(std::abs(in + along + out + back), 1e-8) << in << " " << along << " " << out << " " << back;
  }
}

}  // namespace
}  // namespace odds::scene
