// The meshes that stated odds are fitted on, and those that they are judged by.
#pragma once

#include <string>
#include <vector>

#include "calibration/unproved.hpp"

namespace odds::calibration {

/// Meshes of Debian's package openfoam-examples are among them, and left out if it is not installed.
[[nodiscard]] std::vector<Meeting> training_meetings();
/// None of the training meshes. `more`: names or files of further ones, each with its copy.
[[nodiscard]] std::vector<Meeting> held_out_meetings(const std::vector<std::string>& more);

}  // namespace odds::calibration
