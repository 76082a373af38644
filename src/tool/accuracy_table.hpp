// The short table at the end of `odds accuracy`.
#pragma once

#include <string>
#include <vector>

#include "odds/report/accuracy/study.hpp"

namespace odds::tool {

/// The headline, and one line for each limit: all poses together, then shares by group of bands.
std::string accuracy_table(const report::Study& study, const std::vector<report::AccuracyRow>& rows);

}  // namespace odds::tool
