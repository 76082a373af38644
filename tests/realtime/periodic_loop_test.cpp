// The loop's schedule in simulated time: no drift, late ticks late, missed periods skipped, never a burst; and once for
// real.
#include "odds/realtime/periodic_loop.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <vector>

namespace odds::realtime {
namespace {

constexpr std::int64_t ms = 1'000'000;
constexpr std::int64_t us = 1'000;

TEST(PeriodicLoop, a_punctual_loop_runs_every_tick_at_its_planned_time) {
  SimulatedTime time(5 * ms);
  std::vector<Tick> ticks;
  const LoopSummary summary = run_periodic({ms, 1000}, time.source(), {}, [&](const Tick& tick) noexcept {
    ticks.push_back(tick);
    time.spend(300 * us);
  });
  EXPECT_EQ(summary.ran, 1000u);
  EXPECT_EQ(summary.skipped, 0u);
  EXPECT_FALSE(summary.stopped);
  ASSERT_EQ(ticks.size(), 1000u);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    EXPECT_EQ(ticks[i].index, i);
    EXPECT_EQ(ticks[i].planned_ns, 6 * ms + static_cast<std::int64_t>(i) * ms);
    EXPECT_EQ(ticks[i].woke_ns, ticks[i].planned_ns);
  }
}

TEST(PeriodicLoop, late_wake_ups_are_told_and_do_not_shift_the_schedule) {
  SimulatedTime time;
  std::vector<Tick> ticks;
  run_periodic({ms, 100}, time.source(), {}, [&](const Tick& tick) noexcept {
    ticks.push_back(tick);
    time.wake_late_by(70 * us);  // every one of them
  });
  ASSERT_EQ(ticks.size(), 100u);
  for (std::size_t i = 1; i < ticks.size(); ++i) {
    EXPECT_EQ(ticks[i].planned_ns - ticks[i - 1].planned_ns, ms);
    EXPECT_EQ(ticks[i].woke_ns - ticks[i].planned_ns, 70 * us);
  }
}

TEST(PeriodicLoop, a_short_overrun_starts_the_next_tick_at_once_and_late) {
  SimulatedTime time;
  std::vector<Tick> ticks;
  const LoopSummary summary = run_periodic({ms, 4}, time.source(), {}, [&](const Tick& tick) noexcept {
    ticks.push_back(tick);
    time.spend(tick.index == 1 ? 1'400 * us : 100 * us);
  });
  EXPECT_EQ(summary.skipped, 0u);
  ASSERT_EQ(ticks.size(), 4u);
  EXPECT_EQ(ticks[2].woke_ns - ticks[2].planned_ns, 400 * us);
  EXPECT_EQ(ticks[3].woke_ns, ticks[3].planned_ns);
}

TEST(PeriodicLoop, whole_missed_periods_are_skipped_counted_and_never_caught_up) {
  SimulatedTime time;
  std::vector<Tick> ticks;
  const LoopSummary summary = run_periodic({ms, 12}, time.source(), {}, [&](const Tick& tick) noexcept {
    ticks.push_back(tick);
    time.spend(tick.index == 2 ? 5'300 * us : 100 * us);  // ends 5.3 periods after its planned start
  });
  ASSERT_EQ(ticks.size(), 8u);
  EXPECT_EQ(ticks[3].index, 7u);
  EXPECT_EQ(ticks[3].skipped_before, 4u);  // 3, 4, 5, 6
  EXPECT_EQ(ticks[3].woke_ns - ticks[3].planned_ns, 300 * us);
  EXPECT_EQ(ticks[4].index, 8u);
  EXPECT_EQ(ticks[4].skipped_before, 0u);
  EXPECT_EQ(ticks[4].woke_ns, ticks[4].planned_ns);
  EXPECT_EQ(summary.ran, 8u);
  EXPECT_EQ(summary.skipped, 4u);
}

TEST(PeriodicLoop, a_tick_that_wakes_periods_late_still_runs_and_shows_its_whole_delay) {
  SimulatedTime time;
  std::vector<Tick> ticks;
  const LoopSummary summary = run_periodic({ms, 10}, time.source(), {}, [&](const Tick& tick) noexcept {
    ticks.push_back(tick);
    if (tick.index == 3) time.wake_late_by(3'500 * us);
  });
  ASSERT_EQ(ticks.size(), 8u);
  EXPECT_EQ(ticks[4].index, 4u);
  EXPECT_EQ(ticks[4].woke_ns - ticks[4].planned_ns, 3'500 * us);
  EXPECT_EQ(ticks[5].index, 7u);
  EXPECT_EQ(summary.skipped, 2u);
}

TEST(PeriodicLoop, ends_when_the_stop_token_or_the_tick_says_so) {
  SimulatedTime time;
  std::stop_source source;
  const LoopSummary by_token =
      run_periodic({ms, 100}, time.source(), source.get_token(), [&](const Tick& tick) noexcept {
        if (tick.index == 9) source.request_stop();
      });
  EXPECT_EQ(by_token.ran, 10u);
  EXPECT_TRUE(by_token.stopped);
  const LoopSummary by_tick =
      run_periodic({ms, 100}, time.source(), {}, [](const Tick& tick) noexcept { return tick.index < 4; });
  EXPECT_EQ(by_tick.ran, 5u);
  EXPECT_TRUE(by_tick.stopped);
}

RC_GTEST_PROP(PeriodicLoop, any_delays_keep_the_schedule_and_account_for_every_period, ()) {
  const auto work_us = *rc::gen::container<std::vector<std::int64_t>>(rc::gen::inRange<std::int64_t>(0, 4'000));
  const auto late_us = *rc::gen::container<std::vector<std::int64_t>>(rc::gen::inRange<std::int64_t>(0, 3'000));
  const auto planned = *rc::gen::inRange<std::uint64_t>(0, 60);
  const auto pick = [](const std::vector<std::int64_t>& from, std::uint64_t i) {
    return from.empty() ? 0 : from[i % from.size()];
  };
  SimulatedTime time(17);
  std::vector<Tick> ticks;
  const LoopSummary summary = run_periodic({ms, planned}, time.source(), {}, [&](const Tick& tick) noexcept {
    ticks.push_back(tick);
    time.spend(us * pick(work_us, tick.index));
    time.wake_late_by(us * pick(late_us, tick.index));
  });
  RC_ASSERT(summary.ran == ticks.size());
  RC_ASSERT(summary.ran + summary.skipped == planned);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    RC_ASSERT(ticks[i].planned_ns == 17 + ms * (1 + static_cast<std::int64_t>(ticks[i].index)));
    RC_ASSERT(ticks[i].woke_ns >= ticks[i].planned_ns);
    if (i == 0) continue;
    RC_ASSERT(ticks[i].index == ticks[i - 1].index + 1 + ticks[i].skipped_before);
  }
}

TEST(PeriodicLoop, in_real_time_no_tick_starts_early_and_every_period_is_accounted_for) {
  std::vector<Tick> ticks;
  ticks.reserve(100);
  const std::int64_t before_ns = real_time().clock();
  const LoopSummary summary =
      run_periodic({ms, 100}, real_time(), {}, [&](const Tick& tick) noexcept { ticks.push_back(tick); });
  EXPECT_GE(real_time().clock() - before_ns, 100 * ms);
  EXPECT_EQ(summary.ran + summary.skipped, 100u);
  for (const Tick& tick : ticks) EXPECT_GE(tick.woke_ns, tick.planned_ns);
}

}  // namespace
}  // namespace odds::realtime
