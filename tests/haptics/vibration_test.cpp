// Strikes of a tool that touches something already.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "haptics/on_floor.hpp"

namespace odds::scene {
namespace {

TEST(Vibration, AToolThatSlidesAlongAFloorRingsAtTheWallThatItMeets) {
  const std::string hand =
      "[[body]]\nname = \"tip\"\nmesh = \"ball\"\nmotion = \"dynamic\"\nmass_kg = 0.02\ndevice = \"hand\"\n"
      "[[body]]\nname = \"wall\"\nmesh = \"bar\"\nposition_m = [0.16, 0, 0.02]\n"
      "[device.hand]\ntype = \"scripted\"\nposition_m = [0, 0, 0.017]\n[[device.hand.motion]]\nkind = \"hold\"\n"
      "duration_s = 0.1\n[[device.hand.motion]]\nkind = \"slide\"\nduration_s = 0.2\nby_m = [0.06, 0, 0]\n"
      "[effects.contact]\n[effects.virtual_coupling]\n";
  const RunOutcome rings = simulate(on_floor(hand + "[effects.vibration]\nforce_ns_per_m = 20\n", 0.5))->run();
  const RunOutcome plain = simulate(on_floor(hand, 0.5))->run();
  double most_n = 0.0;
  for (std::size_t i = 0; i < 500; ++i) {
    const bool slides = i > 50 && i < 190;
    EXPECT_TRUE(!slides || plain.ticks[i].contacts > 0) << "it is on the floor until it meets the wall; " << i;
    most_n = std::max(most_n, std::abs(rings.ticks[i].force_n[0] - plain.ticks[i].force_n[0]));
  }
  EXPECT_GT(most_n, 0.1);
  EXPECT_LE(most_n, 1.0 + 1e-9);
}

// A tool that had no turn in a frame, or whose query saw it touch and had no time for a contact, struck anew
// afterwards.
TEST(Vibration, AToolThatIsNotKnownToHaveLeftStrikesNothingAnew) {
  std::string scene =
      "[[body]]\nname = \"tip\"\nmesh = \"ball\"\nmotion = \"dynamic\"\nmass_kg = 0.02\ndevice = \"hand\"\n"
      "[device.hand]\ntype = \"scripted\"\nposition_m = [0, 0, 0.015]\n[[device.hand.motion]]\nkind = \"slide\"\n"
      "duration_s = 0.4\nby_m = [0.2, 0, -0.03]\n"
      "[effects.virtual_coupling]\n[effects.gravity]\ng_m_per_s2 = [0.5, 0, 0]\n";
  for (int i = 0; i < 20; ++i) scene += moving("ball" + std::to_string(i), "ball", -1.5 + 0.06 * i, 0.0);
  for (const int units : {2, 8}) {
    const auto run = [&](const std::string& more) {
      std::string text = on_floor(scene + more, 0.4);
      text.insert(text.find("work_units"), "frame_work_units = " + std::to_string(units) + "\n");
      return simulate(text)->run();
    };
    const RunOutcome rings = run("[effects.vibration]\n");
    const RunOutcome plain = run("[effects.events]\n");
    EXPECT_GT(rings.pairs_left_out, 100U) << "else nothing is tried";
    for (std::size_t i = 0; i < rings.ticks.size(); ++i) {  // it begins at rest, in the floor
      ASSERT_NEAR(rings.ticks[i].force_n[2], plain.ticks[i].force_n[2], 0.02) << units << " units, tick " << i;
    }
  }
}

}  // namespace
}  // namespace odds::scene
