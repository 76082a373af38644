// Thread set-up never fails the program and says truthfully what was granted.
#include "odds/realtime/thread_setup.hpp"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>

#include <thread>

#include "odds/realtime/usage.hpp"
#include "support/sanitizer.hpp"

namespace odds::realtime {
namespace {

using Outcome = SetupLine::Outcome;

/// Each test changes a thread of its own.
template <class Function>
void on_its_own_thread(Function function) {
  std::thread(function).join();
}

TEST(ThreadSetup, asks_for_nothing_by_default) { EXPECT_TRUE(set_up_this_thread({}).empty()); }

TEST(ThreadSetup, real_time_priority_is_granted_exactly_if_the_kernel_says_so) {
  on_its_own_thread([] {
    const auto lines = set_up_this_thread({.fifo_priority = 10});
    ASSERT_EQ(lines.size(), 1u);
    int policy = 0;
    sched_param parameters{};
    ASSERT_EQ(pthread_getschedparam(pthread_self(), &policy, &parameters), 0);
    const bool real = policy == SCHED_FIFO && parameters.sched_priority == 10;
    EXPECT_EQ(lines[0].outcome == Outcome::granted, real) << lines[0].text();
    if (!real) {
      EXPECT_NE(lines[0].text().find("rtprio"), std::string::npos) << "a refusal says what would help";
    }
  });
}

TEST(ThreadSetup, impossible_wishes_are_refused_with_a_reason) {
  on_its_own_thread([] {
    const auto lines = set_up_this_thread({.fifo_priority = 200, .cpu = 100'000, .timer_slack_ns = 0});
    ASSERT_EQ(lines.size(), 3u);
    for (const SetupLine& line : lines) {
      EXPECT_EQ(line.outcome, Outcome::refused) << line.text();
      EXPECT_FALSE(line.detail.empty()) << line.asked;
    }
  });
}

TEST(ThreadSetup, pins_to_a_processor_that_the_process_may_use) {
  on_its_own_thread([] {
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    ASSERT_EQ(sched_getaffinity(0, sizeof allowed, &allowed), 0);
    unsigned cpu = 0;
    while (!CPU_ISSET(cpu, &allowed)) ++cpu;
    const auto lines = set_up_this_thread({.cpu = static_cast<int>(cpu)});
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_EQ(lines[0].outcome, Outcome::granted) << lines[0].text();
    EXPECT_EQ(sched_getcpu(), static_cast<int>(cpu));
  });
}

TEST(ThreadSetup, timer_slack_is_read_back_from_the_kernel) {
  on_its_own_thread([] {
    const auto lines = set_up_this_thread({.timer_slack_ns = 1'234});
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_EQ(lines[0].outcome == Outcome::granted, prctl(PR_GET_TIMERSLACK, 0UL, 0UL, 0UL, 0UL) <= 1'234);
  });
}

[[gnu::noinline]] void use_stack(std::size_t bytes) {
  auto* block = static_cast<volatile unsigned char*>(__builtin_alloca(bytes));
  for (std::size_t i = 0; i < bytes; i += 1024) block[i] = 1;
}

TEST(ThreadSetup, a_touched_stack_causes_no_page_faults_later) {
  if (support::under_sanitizer) GTEST_SKIP() << "a sanitizer's own memory faults in pages";
  on_its_own_thread([] {
    const auto lines = set_up_this_thread({.prefault_stack_bytes = 512 * 1024});
    ASSERT_EQ(lines.size(), 1u);
    ASSERT_EQ(lines[0].outcome, Outcome::granted) << lines[0].text();
    const ThreadUsage before = thread_usage();
    use_stack(256 * 1024);
    EXPECT_EQ((thread_usage() - before).minor_faults, 0u);
  });
}

TEST(ThreadSetup, more_stack_than_the_thread_has_is_granted_in_part) {
  on_its_own_thread([] {
    const auto lines = set_up_this_thread({.prefault_stack_bytes = std::size_t{1} << 40});
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_EQ(lines[0].outcome, Outcome::partly) << lines[0].text();
  });
}

TEST(ThreadSetup, locking_memory_never_makes_later_allocations_fail) {
  on_its_own_thread([] {
    const auto lines = set_up_this_thread({.lock_memory = true});
    ASSERT_EQ(lines.size(), 1u);
    std::vector<char> later(std::size_t{32} << 20, 'x');  // beyond the usual memlock limit of 8 MiB
    EXPECT_EQ(later.back(), 'x');
    EXPECT_FALSE(lines[0].detail.empty());
  });
}

}  // namespace
}  // namespace odds::realtime
