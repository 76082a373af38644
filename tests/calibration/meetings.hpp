// The meshes that stated odds are fitted on, and those that they are judged by.
#pragma once

#include <string>
#include <vector>

#include "calibration/unproved.hpp"

namespace odds::calibration {

/// Meshes of Debian's packages openfoam-examples, cura, prusa-slicer and assimp-testmodels are among them, and left out
/// where they are not; of the last three, `apt-get download` and `dpkg -x PACKAGE.deb /` bring the files alone.
[[nodiscard]] std::vector<Meeting> training_meetings();
/// None of the training pairs. `more`: names or files of further ones, each with its copy.
[[nodiscard]] std::vector<Meeting> held_out_meetings(const std::vector<std::string>& more);

}  // namespace odds::calibration
