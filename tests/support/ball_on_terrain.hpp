// The bodies of a small scene: a ball on a hand, over a terrain.
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

}  // namespace odds::testing
