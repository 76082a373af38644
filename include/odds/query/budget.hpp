// What a query may spend.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "odds/realtime/clock.hpp"

namespace odds::query {

/// The limit of one query. Both limits may be set; the first one reached ends the query.
/// Microseconds are wall time from the call of `run` to its return, contacts included, and not repeatable. Work units
/// (one per pair of nodes visited, one per pair of triangles tested, as Cost counts them) give the same bits on every
/// run.
struct Budget {
  double microseconds = std::numeric_limits<double>::infinity();         ///< > 0; infinity: no limit
  std::uint64_t work_units = std::numeric_limits<std::uint64_t>::max();  ///< > 0; max: no limit
  realtime::Clock clock = {};                                            ///< null: realtime::fastest_clock()

  [[nodiscard]] bool is_limited() const noexcept {
    return std::isfinite(microseconds) || work_units != std::numeric_limits<std::uint64_t>::max();
  }
  [[nodiscard]] static Budget unlimited() noexcept { return {}; }
  [[nodiscard]] static Budget time(double microseconds) noexcept { return {.microseconds = microseconds}; }
  [[nodiscard]] static Budget work(std::uint64_t units) noexcept { return {.work_units = units}; }
};

}  // namespace odds::query
