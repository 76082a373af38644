// What one collision with a primitive may spend, from the same settings that bound the queries between meshes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "odds/realtime/clock.hpp"
#include "ode/frame_share.hpp"
#include "ode/statistics.hpp"

namespace odds::ode {

/// Work units and wall time of one collision; starts when it is made.
class Limit {
 public:
  explicit Limit(const Settings& own) noexcept : clock_(realtime::fastest_clock()) {
    const Settings settings = within_share(own);
    shared_ = is_bound_by_share(own, settings);
    if (settings.work_units > 0) units = settings.work_units;
    begun_with_ = units;
    const double ns = settings.budget_us * 1e3;
    timed_ = ns < 9e18;
    if (!timed_) return;
    end_ns_ = clock_() + static_cast<std::int64_t>(ns);
    units = std::min(units, static_cast<std::uint64_t>(std::ceil(settings.budget_us * nodes_per_us)));
    begun_with_ = units;
  }

  [[nodiscard]] bool time_is_up() const noexcept { return timed_ && clock_() >= end_ns_; }

  /// The collision's end: counts it if it was cut off, tells the frame. Gives `contacts` back.
  [[nodiscard]] int finish(bool complete, int contacts) const noexcept {
    if (!complete) count(statistics().primitive_cut_off);
    if (current_share != nullptr) {
      current_share->report(begun_with_ - units, contacts, complete || !shared_ ? Outcome::finished : Outcome::starved);
    }
    return contacts;
  }

 private:
  // Searches in a tree do not read the clock at each node; a node takes 10 to 50 ns where the cache holds it.
  static constexpr double nodes_per_us = 30.0;
  static constexpr std::uint64_t most_units = std::uint64_t{1} << 40;
  realtime::Clock clock_;
  std::int64_t end_ns_ = 0;
  bool timed_ = false;
  bool shared_ = false;
  std::uint64_t begun_with_ = most_units;

 public:
  std::uint64_t units = most_units;  ///< left; searches take from it
};

}  // namespace odds::ode
