// How much of a budget is kept for what follows a search that ran out of time.
#pragma once

#include <algorithm>
#include <cstdint>

namespace odds::query {

/// What follows the moment that a piece of a query hears that its time is up takes from 0.2 us (odds and place of an
/// answer without a proof) to 5 us (a patch made hastily), three times that where caches are cold. So a pair
/// watches its own queries: an ending that took longer than the reserve adds to it, a shorter one takes a little away.
/// The share of endings that are longer settles where both balance. Changes no answer within work units.
class EndingReserve {
 public:
  struct Range {
    std::int64_t first_ns;  ///< where it starts, which is more than most endings need; then it comes down soon
    std::int64_t least_ns;
    std::int64_t most_ns;
    std::int64_t rise_percent;  ///< by one ending: of what it took more
    std::int64_t most_rise_ns;  ///< and no more than this
    std::int64_t fall_ns;       ///< by an ending that was shorter
  };

  explicit constexpr EndingReserve(const Range& range) noexcept : range_(range), ns_(range.first_ns) {}

  [[nodiscard]] std::int64_t ns() const noexcept { return ns_; }

  /// `took_ns`: from the moment that the piece heard, or should have heard, that its time was up to the query's end.
  void note(std::int64_t took_ns) noexcept {
    const std::int64_t fall_ns = notes_ < first_notes ? (ns_ - took_ns) / 16 : range_.fall_ns;
    notes_ = std::min(notes_ + 1, first_notes);
    const std::int64_t rise_ns = std::min((took_ns - ns_) * range_.rise_percent / 100, range_.most_rise_ns);
    ns_ += took_ns > ns_ ? std::max(rise_ns, least_rise_ns) : -fall_ns;
    ns_ = std::clamp(ns_, range_.least_ns, range_.most_ns);
  }
  /// It left no time for what it is kept from, so nothing is learnt: an ending that was late once must not keep it so.
  void ease() noexcept { ns_ = std::max(ns_ - ns_ / 64, range_.least_ns); }

 private:
  static constexpr int first_notes = 32;
  static constexpr std::int64_t least_rise_ns = 32;

  Range range_;
  std::int64_t ns_;
  int notes_ = 0;
};

/// The endings that a pair watches. One ending in some hundreds is late; one that was late by microseconds, as of a
/// patch that did not fit, stays away for thousands.
struct EndingReserves {
  EndingReserve search{{2000, 200, 5000, 50, 300, 2}};      ///< odds and place of what was left undecided
  EndingReserve patch{{12000, 1000, 16000, 150, 3000, 1}};  ///< of a patch made hastily: witnesses, choice, writing
  EndingReserve single{{4000, 600, 10000, 150, 3000, 1}};   ///< the same of a single contact
  EndingReserve last{{1200, 600, 5000, 100, 400, 1}};       ///< the single contact of a hit that the search found last
  EndingReserve around{{1000, 300, 5000, 100, 400, 1}};     ///< a look at the nodes about a contact
  EndingReserve rough{{4000, 600, 8000, 150, 3000, 1}};     ///< one more rough contact, and writing the answer
  EndingReserve late{{1500, 300, 5000, 150, 3000, 1}};      ///< of contacts that are carried along: writing the answer
  EndingReserve ray{{2000, 600, 6000, 150, 3000, 1}};       ///< one ray, and writing the answer
};

}  // namespace odds::query
