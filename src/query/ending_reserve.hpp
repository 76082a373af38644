// How much of a budget is kept for what follows a search that ran out of time.
#pragma once

#include <algorithm>
#include <cstdint>

namespace odds::query {

/// Odds and place of an answer without a proof take 0.2 to 1 us, by the processor and by what its caches hold. So a
/// pair watches its own queries: an ending that took longer than the reserve adds to it, a shorter one takes a little
/// away, in such a proportion that about one in ten is longer, and then by little. Changes no answer within work units.
class EndingReserve {
 public:
  [[nodiscard]] std::int64_t ns() const noexcept { return ns_; }

  /// `took_ns`: from the moment that a search heard that its time was up to the query's end.
  void note(std::int64_t took_ns) noexcept {
    // A stall must not cost more than it did.
    ns_ += took_ns > ns_ ? std::clamp((took_ns - ns_) / 4, least_rise_ns, most_rise_ns) : -fall_ns;
    ns_ = std::clamp(ns_, least_ns, most_ns);
  }

  static constexpr std::int64_t least_ns = 200;
  static constexpr std::int64_t most_ns = 2000;

 private:
  static constexpr std::int64_t first_ns = 600;
  static constexpr std::int64_t fall_ns = 4;
  static constexpr std::int64_t least_rise_ns = 32;
  static constexpr std::int64_t most_rise_ns = 100;

  std::int64_t ns_ = first_ns;
};

}  // namespace odds::query
