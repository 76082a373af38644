// The ring against a queue of the standard library, and between two threads.
#include "odds/realtime/spsc_ring.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <deque>
#include <thread>

namespace odds::realtime {
namespace {

TEST(SpscRing, rounds_its_capacity_up_to_a_power_of_two) {
  EXPECT_EQ(SpscRing<int>(0).capacity(), 1u);
  EXPECT_EQ(SpscRing<int>(5).capacity(), 8u);
  EXPECT_EQ(SpscRing<int>(8).capacity(), 8u);
}

RC_GTEST_PROP(SpscRing, behaves_as_a_bounded_queue_under_any_sequence, (std::vector<bool> pushes)) {
  SpscRing<int> ring(4);
  std::deque<int> model;
  int next = 0;
  for (const bool push : pushes) {
    if (push) {
      const bool room = model.size() < ring.capacity();
      RC_ASSERT(ring.try_push(next) == room);
      if (room) model.push_back(next);
      ++next;
    } else {
      int got = -1;
      RC_ASSERT(ring.try_pop(got) == !model.empty());
      if (model.empty()) continue;
      RC_ASSERT(got == model.front());
      model.pop_front();
    }
  }
}

TEST(SpscRing, carries_a_long_sequence_between_two_threads) {
  constexpr std::uint64_t count = 300'000;
  SpscRing<std::uint64_t> ring(128);
  std::thread writer([&ring] {
    for (std::uint64_t i = 0; i < count; ++i) {
      while (!ring.try_push(i)) std::this_thread::yield();
    }
  });
  std::uint64_t expected = 0;
  std::uint64_t wrong = 0;
  while (expected < count) {
    std::uint64_t got = 0;
    if (!ring.try_pop(got)) {
      std::this_thread::yield();
      continue;
    }
    wrong += got != expected ? 1 : 0;
    ++expected;
  }
  writer.join();
  EXPECT_EQ(wrong, 0u);
}

}  // namespace
}  // namespace odds::realtime
