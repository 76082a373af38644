// A hard case: a scene made to break the loop, what is done to it meanwhile, and what must hold all the same.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace odds::hard_cases {

/// What happens to the loop's time.
enum class Trouble {
  none,
  missed_ticks,  ///< one tick in ten is left out, now and then many in a row
  clock_jumps,   ///< the time jumps ahead by 300 ms, twice, and stands still for 50 ms, once
};

struct HardCase {
  std::string name;
  std::string what;   ///< one sentence
  std::string scene;  ///< TOML without format line, [loop] seconds and [query] budget
  double seconds = 1.0;
  Trouble trouble = Trouble::none;
  double max_force_n = 5.0;
  /// Energy that the simulation may give to the hand beyond what it has taken: what the scene stores at the start,
  /// rounding, and, where the case is made to break the rule of passivity, what breaks it.
  double given_j = 1e-3;
  double deep_m = 5e-4;      ///< an overlap deeper than this must not be missed in two consecutive ticks
  double touching_n = 0.05;  ///< forces are compared with the exact run's where that is greater
  bool compares = true;      ///< false: chaotic, or too far from rest to be compared tick by tick
  std::string ends = {};     ///< body that must be found ...
  double ends_above_m =
      -1e300;  ///< ... above this height at the end, or whatever else says that it did not fall through
};

/// All of them; meshes that no made shape gives are written into `folder`, relative names refer to it. `knot`: the mesh
/// of the two cases in which two alike overlap deeply, a scene's `file`.
std::vector<HardCase> all_cases(const std::string& folder, const std::string& knot = "made:torus_knot");

}  // namespace odds::hard_cases
