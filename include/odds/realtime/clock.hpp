// Where time comes from: the monotonic clock, the processor's time-stamp counter, or a test's own hand.
#pragma once

#include <cstdint>

namespace odds::realtime {

/// A source of nanoseconds that can be passed by value through the hot path and replaced in tests.
/// `now_ns` never allocates, locks or throws. The origin is arbitrary but fixed; times never run backwards.
struct Clock {
  std::int64_t (*now_ns)(void* state) noexcept = nullptr;
  void* state = nullptr;

  [[nodiscard]] std::int64_t operator()() const noexcept { return now_ns(state); }
};

/// CLOCK_MONOTONIC; about 20-40 ns a reading.
[[nodiscard]] Clock monotonic_clock() noexcept;

/// The processor's invariant time-stamp counter, scaled to CLOCK_MONOTONIC at the first call (takes about 10 ms, once
/// per process; call it before a real-time loop starts). Falls back to monotonic_clock() where there is no invariant
/// counter or the two disagree; fastest_clock_choice() says which. A reading waits for the instructions before it to
/// finish, so that no work hides behind it. For durations: after minutes its readings may have drifted from
/// CLOCK_MONOTONIC's by parts per million, so never subtract a reading of one from a reading of the other. Thread-safe.
[[nodiscard]] Clock fastest_clock() noexcept;

/// The same time as `clock` tells, but for looks that only ask whether a time is up: where it is fastest_clock() and
/// that is the counter, it is read without waiting for the instructions before it, which costs the work about it less.
/// Such a reading may be of some tenths of a microsecond ago, when work before it was still under way, and a little
/// before an earlier reading. Any other clock is returned as it is. Thread-safe.
[[nodiscard]] Clock without_waiting(Clock clock) noexcept;

/// Which clock fastest_clock() is, and why.
struct ClockChoice {
  bool time_stamp_counter = false;  ///< false: CLOCK_MONOTONIC
  double counter_hz = 0.0;          ///< calibrated frequency; 0 where the counter is not used
  double disagreement_ppm = 0.0;    ///< between the two halves of the calibration, parts per million
  const char* reason = "";          ///< one sentence, static storage
};
[[nodiscard]] ClockChoice fastest_clock_choice() noexcept;

/// A clock that moves only when told to, for deterministic tests of budgets: every reading advances it by `step_ns`.
class ManualClock {
 public:
  explicit ManualClock(std::int64_t step_ns = 0, std::int64_t start_ns = 0) noexcept
      : time_ns_(start_ns), step_ns_(step_ns) {}
  void advance(std::int64_t ns) noexcept { time_ns_ += ns; }
  [[nodiscard]] std::int64_t readings() const noexcept { return readings_; }
  /// A view of this clock; valid as long as the clock lives and is not moved.
  [[nodiscard]] Clock clock() noexcept { return {&ManualClock::read, this}; }

 private:
  static std::int64_t read(void* state) noexcept {
    auto* self = static_cast<ManualClock*>(state);
    ++self->readings_;
    self->time_ns_ += self->step_ns_;
    return self->time_ns_;
  }
  std::int64_t time_ns_;
  std::int64_t step_ns_;
  std::int64_t readings_ = 0;
};

}  // namespace odds::realtime
