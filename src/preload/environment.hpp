// The preload library's settings, from environment variables.
#pragma once

#include <string>
#include <vector>

#include "odds/ode/odds_ode.h"

namespace odds::preload {

struct Environment {
  oddsTakeOverParams takeover;
  /// A file, wherever the program has gone meanwhile; "-": standard error; "off": none. In it %p stands for the
  /// process.
  std::string report;
  std::vector<std::string> mistakes;  ///< what was wrong with a variable and what is used instead
};

/// ODDS_PARTNERS (all, or names separated by commas: trimesh, sphere, box, capsule, cylinder, plane, ray, convex),
/// ODDS_BUDGET_US, ODDS_WORK_UNITS, ODDS_MAX_CONTACTS, ODDS_REPORT. What is not set, or wrong, has its default.
[[nodiscard]] Environment read_environment();

}  // namespace odds::preload
