// A small scene: a ball on a hand, over a terrain, and the hand that lets it down.
#pragma once

#include <string>

namespace odds::testing {

inline const std::string ball_on_terrain = R"(
[[mesh]]
name = "terrain"
file = "made:terrain:side=0.3,height=0.01,depth=0.03,cells=48"
[[mesh]]
name = "ball"
file = "made:icosphere:radius=0.01"
[[body]]
name = "terrain"
mesh = "terrain"
[[body]]
name = "ball"
mesh = "ball"
motion = "dynamic"
mass_kg = 0.05
device = "hand"
)";

/// A device that begins above the terrain and is on it after 0.2 s; further motions may follow.
inline std::string hand_onto_terrain(const std::string& type = "scripted") {
  return "[device.hand]\ntype = \"" + type + R"("
position_m = [-0.03, 0, 0.03]
[[device.hand.motion]]
kind = "slide"
duration_s = 0.2
by_m = [0, 0, -0.03]
)";
}

}  // namespace odds::testing
