// One page with all cases, their numbers and their pictures.
#pragma once

#include <string>
#include <vector>

#include "hard_cases/run_case.hpp"

namespace odds::hard_cases {

/// HTML, opens offline.
std::string page_of(const std::vector<Outcome>& outcomes, double seconds_taken);

}  // namespace odds::hard_cases
