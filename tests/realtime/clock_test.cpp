// The clocks: monotone, of one unit, and honest about which one was chosen.
#include "odds/realtime/clock.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

namespace odds::realtime {
namespace {

TEST(Clock, never_runs_backwards_on_one_thread) {
  for (const Clock clock : {monotonic_clock(), fastest_clock()}) {
    std::int64_t last = clock();
    for (int i = 0; i < 200'000; ++i) {
      const std::int64_t now = clock();
      ASSERT_GE(now, last);
      last = now;
    }
  }
}

// Both clocks are read around a wait; whatever stalls between two neighbouring readings only widens the bracket, so
// that the fast clock's duration must lie between the inner and the outer duration of the other, give or take the
// drift.
TEST(Clock, fastest_clock_counts_the_nanoseconds_of_the_monotonic_clock) {
  const Clock slow = monotonic_clock();
  const Clock fast = fastest_clock();
  const std::int64_t outer_begin = slow();
  const std::int64_t fast_begin = fast();
  const std::int64_t inner_begin = slow();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const std::int64_t inner_end = slow();
  const std::int64_t fast_end = fast();
  const std::int64_t outer_end = slow();
  const double drift_allowed = 1e-3 * static_cast<double>(outer_end - outer_begin);  // calibration and NTP slew
  EXPECT_GE(static_cast<double>(fast_end - fast_begin), static_cast<double>(inner_end - inner_begin) - drift_allowed);
  EXPECT_LE(static_cast<double>(fast_end - fast_begin), static_cast<double>(outer_end - outer_begin) + drift_allowed);
}

// Work before it may still be under way: a little early, but never late.
TEST(Clock, read_without_waiting_tells_the_same_time) {
  constexpr std::int64_t early_ns = 10'000;
  const Clock clock = fastest_clock();
  const Clock hasty = without_waiting(clock);
  EXPECT_EQ(hasty.now_ns != clock.now_ns, fastest_clock_choice().time_stamp_counter);
  for (int i = 0; i < 100'000; ++i) {
    const std::int64_t before = clock();
    const std::int64_t now = hasty();
    const std::int64_t after = clock();
    ASSERT_GE(now, before - early_ns);
    ASSERT_LE(now, after);
  }
}

TEST(Clock, that_is_another_is_read_as_it_is) {
  ManualClock manual;
  for (const Clock clock : {monotonic_clock(), manual.clock()}) {
    EXPECT_EQ(without_waiting(clock).now_ns, clock.now_ns);
    EXPECT_EQ(without_waiting(clock).state, clock.state);
  }
}

TEST(Clock, is_chosen_once_for_all_threads) {
  std::vector<Clock> seen(4);
  std::vector<std::thread> threads;
  for (Clock& clock : seen) threads.emplace_back([&clock] { clock = fastest_clock(); });
  for (std::thread& thread : threads) thread.join();
  for (const Clock& clock : seen) {
    EXPECT_EQ(clock.now_ns, seen.front().now_ns);
    EXPECT_EQ(clock.state, seen.front().state);
  }
}

TEST(Clock, says_which_source_it_uses_and_why) {
  const ClockChoice choice = fastest_clock_choice();
  EXPECT_FALSE(std::string(choice.reason).empty());
  EXPECT_EQ(choice.time_stamp_counter, fastest_clock().now_ns != monotonic_clock().now_ns);
  if (choice.time_stamp_counter) {
    EXPECT_GT(choice.counter_hz, 1e8);
    EXPECT_LT(choice.disagreement_ppm, 1000.0);
  } else {
    EXPECT_EQ(choice.counter_hz, 0.0);
  }
}

TEST(ManualClock, advances_only_by_hand_and_by_its_step) {
  ManualClock manual(10, 100);
  const Clock clock = manual.clock();
  EXPECT_EQ(clock(), 110);
  EXPECT_EQ(clock(), 120);
  manual.advance(1000);
  EXPECT_EQ(clock(), 1130);
  EXPECT_EQ(manual.readings(), 3);
}

}  // namespace
}  // namespace odds::realtime
