// The recorder: everything arrives in order, or is counted as dropped; pushing neither allocates nor waits.
#include "odds/realtime/recorder.hpp"

#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <numeric>
#include <vector>

#include "odds/realtime/usage.hpp"
#include "support/sanitizer.hpp"

namespace odds::realtime {
namespace {

struct Sample {
  std::uint64_t number = 0;
  double values[31] = {};  // about the size of a tick's record
};

TEST(Recorder, hands_over_every_record_in_order_and_flushes_at_the_end) {
  std::vector<std::uint64_t> seen;
  Recorder<Sample> recorder(256, [&seen](std::span<const Sample> batch) {
    for (const Sample& sample : batch) seen.push_back(sample.number);
  });
  std::uint64_t pushed = 0;
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    while (!recorder.push({i, {}})) std::this_thread::yield();
    ++pushed;
  }
  recorder.finish();
  std::vector<std::uint64_t> expected(pushed);
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_EQ(seen, expected);
}

TEST(Recorder, a_full_ring_drops_and_counts_but_never_blocks) {
  std::mutex mutex;
  std::condition_variable released;
  bool may_go_on = false;
  std::uint64_t received = 0;
  Recorder<Sample> recorder(64, [&](std::span<const Sample> batch) {
    std::unique_lock lock(mutex);
    released.wait(lock, [&] { return may_go_on; });  // a disk that hangs
    received += batch.size();
  });
  std::uint64_t kept = 0;
  for (std::uint64_t i = 0; i < 10'000; ++i) kept += recorder.push({i, {}}) ? 1 : 0;
  EXPECT_GT(recorder.dropped(), 0u);
  EXPECT_GE(kept, 64u);
  EXPECT_EQ(kept + recorder.dropped(), 10'000u);
  {
    const std::lock_guard lock(mutex);
    may_go_on = true;
  }
  released.notify_all();
  recorder.finish();
  EXPECT_EQ(received, kept);
}

TEST(Recorder, finishing_twice_or_without_a_record_is_fine) {
  std::size_t batches = 0;
  {
    Recorder<Sample> recorder(8, [&batches](std::span<const Sample>) { ++batches; });
    recorder.finish();
    recorder.finish();
  }
  EXPECT_EQ(batches, 0u);
}

TEST(Recorder, pushing_into_a_fresh_ring_raises_no_page_fault) {
  if (support::under_sanitizer) GTEST_SKIP() << "a sanitizer's own memory faults in pages";
  Recorder<Sample> recorder(
      4'096, [](std::span<const Sample>) {}, std::chrono::seconds(1));
  Sample sample;
  recorder.push(sample);  // the code itself is faulted in by the first call
  const ThreadUsage before = thread_usage();
  for (std::uint64_t i = 1; i < 4'096; ++i) {
    sample.number = i;
    recorder.push(sample);
  }
  const ThreadUsage spent = thread_usage() - before;
  EXPECT_EQ(spent.minor_faults, 0u);
  EXPECT_EQ(spent.major_faults, 0u);
  EXPECT_EQ(spent.voluntary_switches, 0u);
  EXPECT_EQ(recorder.dropped(), 0u);
}

}  // namespace
}  // namespace odds::realtime
