// Tells a computation's own time from time that was taken from it, by the gaps between its polls of the clock.
#pragma once

#include <cstdint>

namespace odds::realtime {

/// Sums the gaps between consecutive polls that are too long to be the caller's own work.
///
///     StallLedger ledger(clock());          // start
///     while (...) { work(); ledger.poll(clock()); }
///     ledger.gross_ns(), ledger.stall_ns(), ledger.net_ns();
///
/// A gap longer than the threshold counts as a stall with its whole length, so `net` leaves out the few hundred
/// nanoseconds of own work inside it. What the ledger cannot know: it excuses any long gap, also one that is the
/// caller's fault (a page fault, a lock, one over-long piece of work). Whoever judges by `net` must therefore
/// (a) check that the thread had no page faults and no voluntary switches meanwhile (usage.hpp), (b) bound the work
/// between two polls by counting it, (c) show gross beside net, (d) call a run with a large share of stalls
/// inconclusive (fitness.hpp). No allocation, no system call; one per thread.
class StallLedger {
 public:
  /// The longest legitimate work between two polls of a query is 1-2 us; a pre-empted or stolen processor is away
  /// longer.
  static constexpr std::int64_t default_threshold_ns = 5'000;

  explicit StallLedger(std::int64_t start_ns, std::int64_t threshold_ns = default_threshold_ns) noexcept
      : start_ns_(start_ns), last_ns_(start_ns), threshold_ns_(threshold_ns) {}

  /// Notes one reading of the clock; readings must not run backwards.
  void poll(std::int64_t now_ns) noexcept {
    const std::int64_t gap = now_ns - last_ns_;
    last_ns_ = now_ns;
    ++polls_;
    if (gap > longest_gap_ns_) longest_gap_ns_ = gap;
    if (gap > threshold_ns_) {
      stall_ns_ += gap;
      ++stalls_;
    }
  }

  /// From the start to the latest poll.
  [[nodiscard]] std::int64_t gross_ns() const noexcept { return last_ns_ - start_ns_; }
  /// The part of it inside gaps above the threshold.
  [[nodiscard]] std::int64_t stall_ns() const noexcept { return stall_ns_; }
  /// gross - stall, >= 0.
  [[nodiscard]] std::int64_t net_ns() const noexcept { return gross_ns() - stall_ns_; }
  [[nodiscard]] std::int64_t longest_gap_ns() const noexcept { return longest_gap_ns_; }
  [[nodiscard]] std::uint32_t stalls() const noexcept { return stalls_; }
  [[nodiscard]] std::uint32_t polls() const noexcept { return polls_; }

 private:
  std::int64_t start_ns_;
  std::int64_t last_ns_;
  std::int64_t threshold_ns_;
  std::int64_t stall_ns_ = 0;
  std::int64_t longest_gap_ns_ = 0;
  std::uint32_t stalls_ = 0;
  std::uint32_t polls_ = 0;
};

}  // namespace odds::realtime
