// Which ticks of an earlier run were served: the first column of its ticks.csv.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "odds/math/error.hpp"

namespace odds::tool {

/// Numbers of planned ticks, ascending. Fails, naming the line, on a file that `odds run` did not write.
[[nodiscard]] Result<std::vector<std::uint64_t>> read_served_ticks(const std::string& path);

}  // namespace odds::tool
