// The report: one HTML file with everything in it, and the same figures as a table of text.
#pragma once

#include <string>
#include <vector>

#include "ode_scenes/figures.hpp"

namespace odds::ode_scenes {

[[nodiscard]] std::string page_of(const std::vector<Section>& sections, double seconds_taken);

/// A line for each figure: scene,variant,collider,figure,value,unit,bar,meets,note.
[[nodiscard]] std::string csv_of(const std::vector<Section>& sections);

/// What misses its bar, a sentence each.
[[nodiscard]] std::vector<std::string> misses(const std::vector<Section>& sections);

}  // namespace odds::ode_scenes
