// Fits the weights of src/query/node_odds/node_odds_table.hpp.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace odds::calibration {

/// Prints the weights of one volume of the generic framework, or of all if `only` is empty; and on stderr how true the
/// odds are, for each pair of meshes: as they are, and after two numbers were learnt from every other pose.
/// `standing`: fits nothing, and judges the weights that stand in the library.
void calibrate_nodes(const std::string& only, std::uint64_t poses_per_band, std::uint64_t seed,
                     const std::vector<std::string>& held_out, bool standing);

}  // namespace odds::calibration
