// A loop with a fixed period: absolute deadlines, late ticks recorded late, missed periods skipped and counted.
#pragma once

#include <cstdint>
#include <limits>
#include <stop_token>
#include <type_traits>

#include "odds/realtime/clock.hpp"

namespace odds::realtime {

/// A clock together with the means to sleep until one of its readings. Replaced in tests and in simulated time.
struct TimeSource {
  Clock clock;
  void (*sleep_until_ns)(void* state,
                         std::int64_t deadline_ns) noexcept = nullptr;  ///< returns at or after the deadline
  void* state = nullptr;
};

/// CLOCK_MONOTONIC and clock_nanosleep with absolute deadlines.
[[nodiscard]] TimeSource real_time() noexcept;

/// Time that passes only in sleep and when told to: the loop runs as fast as the processor can, with repeatable times.
class SimulatedTime {
 public:
  explicit SimulatedTime(std::int64_t start_ns = 0) noexcept : now_ns_(start_ns) {}
  SimulatedTime(const SimulatedTime&) = delete;
  SimulatedTime& operator=(const SimulatedTime&) = delete;

  /// Lets work take time. `ns` >= 0.
  void spend(std::int64_t ns) noexcept { now_ns_ += ns; }
  /// The next sleep ends this much after its deadline, once.
  void wake_late_by(std::int64_t ns) noexcept { oversleep_ns_ = ns; }
  /// Valid as long as this object lives.
  [[nodiscard]] TimeSource source() noexcept {
    return {{&SimulatedTime::read, this}, &SimulatedTime::sleep_until, this};
  }

 private:
  static std::int64_t read(void* state) noexcept { return static_cast<SimulatedTime*>(state)->now_ns_; }
  static void sleep_until(void* state, std::int64_t deadline_ns) noexcept {
    auto* self = static_cast<SimulatedTime*>(state);
    if (deadline_ns > self->now_ns_) self->now_ns_ = deadline_ns;
    self->now_ns_ += self->oversleep_ns_;
    self->oversleep_ns_ = 0;
  }
  std::int64_t now_ns_;
  std::int64_t oversleep_ns_ = 0;
};

/// What a tick is told.
struct Tick {
  std::uint64_t index = 0;           ///< number of the planned tick; skipped ticks keep their numbers
  std::int64_t planned_ns = 0;       ///< first + index * period, exactly
  std::int64_t woke_ns = 0;          ///< when the loop ran; >= planned_ns
  std::uint64_t skipped_before = 0;  ///< whole periods left out since the tick before
};

struct LoopPlan {
  std::int64_t period_ns = 1'000'000;                               ///< > 0
  std::uint64_t ticks = std::numeric_limits<std::uint64_t>::max();  ///< planned ticks, skipped ones included
};

struct LoopSummary {
  std::uint64_t ran = 0;
  std::uint64_t skipped = 0;  ///< planned ticks that never ran
  bool stopped = false;  ///< ended before its last planned tick: by the stop token, or because a tick returned false
};

/// Calls `on_tick(const Tick&)` once per period until all planned ticks have passed, `stop` is requested, or `on_tick`
/// returns false (it may also return void). The first tick is due one period after the call.
///
/// The schedule is planned_ns = first + index * period and never drifts. A tick that wakes late runs late and is told
/// its planned time, so that its latency counts from there. When a tick ends, the periods that have passed completely
/// in the meantime are skipped and counted: at most one tick follows at once, the loop never catches up in a burst. No
/// allocation, no lock; between ticks it sleeps. Reads `stop` once per period.
template <class OnTick>
requires std::is_nothrow_invocable_v<OnTick&, const Tick&> LoopSummary run_periodic(const LoopPlan& plan,
                                                                                    const TimeSource& time,
                                                                                    const std::stop_token& stop,
                                                                                    OnTick&& on_tick)
noexcept {
  LoopSummary summary;
  const std::int64_t first_ns = time.clock() + plan.period_ns;
  Tick tick;
  while (tick.index < plan.ticks) {
    if (stop.stop_requested()) {
      summary.stopped = true;
      break;
    }
    tick.planned_ns = first_ns + static_cast<std::int64_t>(tick.index) * plan.period_ns;
    tick.woke_ns = time.clock();
    if (tick.woke_ns < tick.planned_ns) {
      time.sleep_until_ns(time.state, tick.planned_ns);
      tick.woke_ns = time.clock();
    }
    if constexpr (std::is_void_v<std::invoke_result_t<OnTick&, const Tick&>>) {
      on_tick(static_cast<const Tick&>(tick));
      ++summary.ran;
    } else {
      const bool go_on = on_tick(static_cast<const Tick&>(tick));
      ++summary.ran;
      if (!go_on) {
        summary.stopped = tick.index + 1 < plan.ticks;
        break;
      }
    }
    const std::int64_t behind_ns = time.clock() - (tick.planned_ns + plan.period_ns);
    const std::uint64_t passed = behind_ns > 0 ? static_cast<std::uint64_t>(behind_ns / plan.period_ns) : 0;
    const std::uint64_t remaining = plan.ticks - (tick.index + 1);
    tick.skipped_before = passed < remaining ? passed : remaining;
    summary.skipped += tick.skipped_before;
    tick.index += 1 + tick.skipped_before;
  }
  return summary;
}

}  // namespace odds::realtime
