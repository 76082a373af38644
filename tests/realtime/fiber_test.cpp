// A call that is left in the middle and taken up again.
#include "realtime/fiber.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <thread>

#include "support/allocation_counter.hpp"

namespace odds::realtime {
namespace {

constexpr std::size_t stack_bytes = 64 * 1024;

struct Count {
  Fiber* fiber;
  int last;
  int now = 0;
};

void count_up(void* argument) noexcept {
  auto& count = *static_cast<Count*>(argument);
  while (count.now < count.last) {
    ++count.now;
    count.fiber->yield();
  }
}

TEST(Fiber, GoesOnWhereItYielded) {
  Fiber fiber(stack_bytes);
  EXPECT_TRUE(fiber.is_done());
  Count count{&fiber, 3};
  fiber.start(&count_up, &count);
  EXPECT_EQ(count.now, 0) << "begins at the first resume";
  for (int i = 1; i <= 3; ++i) {
    fiber.resume();
    EXPECT_EQ(count.now, i);
    EXPECT_FALSE(fiber.is_done());
  }
  fiber.resume();
  EXPECT_TRUE(fiber.is_done());
  EXPECT_EQ(count.now, 3);
}

TEST(Fiber, StartsAgainAsOftenAsWantedWithoutMemory) {
  Fiber fiber(stack_bytes);
  const support::AllocationCounter counter;
  for (int i = 0; i < 1000; ++i) {
    Count count{&fiber, i % 5};
    fiber.start(&count_up, &count);
    int pieces = 0;
    for (; !fiber.is_done(); ++pieces) fiber.resume();
    ASSERT_EQ(pieces, i % 5 + 1);
  }
  EXPECT_EQ(counter.allocations(), 0u);
}

// What is on its stack is still there after the caller has used its own.
TEST(Fiber, KeepsItsStack) {
  struct Both {
    Fiber* fiber;
    std::uint64_t sum = 0;
  };
  Fiber fiber(stack_bytes);
  Both both{&fiber};
  fiber.start(
      [](void* argument) noexcept {
        auto& own = *static_cast<Both*>(argument);
        std::array<volatile std::uint64_t, 4000> values{};
        for (std::size_t i = 0; i < values.size(); ++i) {
          values[i] = i;
          if (i % 1000 == 0) own.fiber->yield();
        }
        for (const auto& value : values) own.sum += value;
      },
      &both);
  while (!fiber.is_done()) {
    fiber.resume();
    std::array<volatile std::uint64_t, 4000> others{};
    for (auto& other : others) other = 7;
  }
  EXPECT_EQ(both.sum, 3999u * 4000u / 2u);
}

TEST(Fiber, EachPieceMayRunInAnotherThread) {
  Fiber fiber(stack_bytes);
  Count count{&fiber, 20};
  fiber.start(&count_up, &count);
  while (!fiber.is_done()) std::thread([&fiber] { fiber.resume(); }).join();
  EXPECT_EQ(count.now, 20);
}

TEST(Fiber, OneMayResumeAnother) {
  Fiber inner(stack_bytes);
  Fiber outer(stack_bytes);
  Count count{&inner, 4};
  inner.start(&count_up, &count);
  outer.start([](void* argument) noexcept { static_cast<Fiber*>(argument)->resume(); }, &inner);
  outer.resume();
  EXPECT_TRUE(outer.is_done());
  EXPECT_EQ(count.now, 1);
  while (!inner.is_done()) inner.resume();
}

}  // namespace
}  // namespace odds::realtime
