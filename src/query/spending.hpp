// Keeps a query's accounts: work units, the deadline, and the gaps between polls of the clock.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "odds/query/answer.hpp"
#include "odds/query/budget.hpp"
#include "odds/realtime/clock.hpp"
#include "odds/realtime/stall_ledger.hpp"

namespace odds::query {

/// Made at the start of a query. `allows(n)` is asked before every n units of work; `may_go_on()` polls the clock and
/// is asked after every piece of work that `pair` bounds (a node pair's children, one row of a leaf pair).
class Spending {
 public:
  explicit Spending(const Budget& budget) noexcept
      : clock_(budget.clock.now_ns != nullptr ? budget.clock : realtime::fastest_clock()),
        start_ns_(clock_()),
        ledger_(start_ns_),
        units_left_(budget.work_units) {
    if (std::isfinite(budget.microseconds)) {
      timed_ = true;
      const double ns = std::clamp(budget.microseconds * 1e3, 0.0, 1e15);
      deadline_ns_ = start_ns_ + static_cast<std::int64_t>(ns);
    }
  }

  /// True if `units` more fit into the work budget.
  [[nodiscard]] bool allows(std::uint64_t units) const noexcept { return units <= units_left_; }

  void spend_node_pairs(std::uint32_t n) noexcept {
    cost_.node_pairs += n;
    note(n);
  }
  void spend_triangle_pairs(std::uint32_t n) noexcept {
    cost_.triangle_pairs += n;
    note(n);
  }
  void note_full_queue() noexcept { ++cost_.queue_full; }

  /// Polls the clock if there is a deadline. False once less than `reserve_ns` is left of the time.
  [[nodiscard]] bool may_go_on(std::int64_t reserve_ns = writing_reserve_ns) noexcept {
    cost_.longest_unpolled_units = std::max(cost_.longest_unpolled_units, unpolled_units_);
    unpolled_units_ = 0;
    if (!timed_) return true;
    const std::int64_t now = clock_();
    ledger_.poll(now);
    return now + reserve_ns < deadline_ns_;
  }

  /// Nanoseconds from the start to the deadline; a very large number where there is none.
  [[nodiscard]] std::int64_t allowance_ns() const noexcept {
    return timed_ ? deadline_ns_ - start_ns_ : std::numeric_limits<std::int64_t>::max() / 4;
  }

  /// Closes the accounts; the last thing a query does.
  [[nodiscard]] Cost close() noexcept {
    const std::int64_t now = clock_();
    ledger_.poll(now);
    cost_.longest_unpolled_units = std::max(cost_.longest_unpolled_units, unpolled_units_);
    cost_.gross_us = static_cast<double>(ledger_.gross_ns()) * 1e-3;
    // Without polls a long gap is the query's own work, not a stall.
    cost_.stall_us = timed_ ? static_cast<double>(ledger_.stall_ns()) * 1e-3 : 0.0;
    if (timed_ && now > deadline_ns_) {
      cost_.overshoot_us = static_cast<double>(now - deadline_ns_) * 1e-3;
      const std::int64_t net_over = ledger_.net_ns() - (deadline_ns_ - start_ns_);
      cost_.net_overshoot_us = static_cast<double>(std::max<std::int64_t>(net_over, 0)) * 1e-3;
    }
    return cost_;
  }

  /// What the writing of the answer takes at most, after the search has stopped.
  static constexpr std::int64_t writing_reserve_ns = 150;

 private:
  void note(std::uint32_t units) noexcept {
    units_left_ -= std::min<std::uint64_t>(units, units_left_);
    unpolled_units_ += units;
  }

  realtime::Clock clock_;
  std::int64_t start_ns_;
  std::int64_t deadline_ns_ = 0;
  realtime::StallLedger ledger_;
  std::uint64_t units_left_;
  std::uint32_t unpolled_units_ = 0;
  bool timed_ = false;
  Cost cost_;
};

}  // namespace odds::query
