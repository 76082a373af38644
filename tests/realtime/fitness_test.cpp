// The fitness probe against clocks that stall as told.
#include "odds/realtime/fitness.hpp"

#include <gtest/gtest.h>

namespace odds::realtime {
namespace {

/// Every reading takes 100 ns; every `stall_every`-th takes `stall_ns` more.
struct StallingClock {
  std::int64_t now_ns = 0;
  std::int64_t readings = 0;
  std::int64_t stall_every = 0;
  std::int64_t stall_ns = 0;

  [[nodiscard]] Clock clock() noexcept {
    return {[](void* state) noexcept {
              auto* self = static_cast<StallingClock*>(state);
              self->now_ns += 100;
              if (self->stall_every > 0 && ++self->readings % self->stall_every == 0) self->now_ns += self->stall_ns;
              return self->now_ns;
            },
            this};
  }
};

TEST(Fitness, a_quiet_machine_is_fit) {
  StallingClock quiet;
  const Fitness fitness = probe_fitness({}, quiet.clock());
  EXPECT_TRUE(fitness.fit) << fitness.reason;
  EXPECT_EQ(fitness.stalls, 0u);
  EXPECT_EQ(fitness.reason.rfind("fit: in 200 ms", 0), 0u) << fitness.reason;
}

TEST(Fitness, many_short_stalls_make_it_unfit_by_their_share) {
  StallingClock busy{.stall_every = 1'000, .stall_ns = 10'000};  // 10 us in every 110 us
  const Fitness fitness = probe_fitness({}, busy.clock());
  EXPECT_FALSE(fitness.fit) << fitness.reason;
  EXPECT_NEAR(fitness.stall_share, 10.1 / 110.0, 1e-3);
}

TEST(Fitness, one_long_gap_makes_it_unfit) {
  StallingClock once{.stall_every = 1'500'000, .stall_ns = 3'000'000};  // 3 ms once, 1.5 % of the time
  const Fitness fitness = probe_fitness({}, once.clock());
  EXPECT_FALSE(fitness.fit) << fitness.reason;
  EXPECT_LT(fitness.stall_share, 0.02);
  EXPECT_EQ(fitness.longest_gap_ns, 3'000'100);
}

TEST(Fitness, on_this_machine_ends_and_gives_its_figures) {
  const Fitness fitness = probe_fitness({.probe_ns = 20'000'000});
  EXPECT_GE(fitness.stall_share, 0.0);
  EXPECT_LE(fitness.stall_share, 1.0);
  EXPECT_GT(fitness.longest_gap_ns, 0);
  EXPECT_FALSE(fitness.reason.empty());
}

}  // namespace
}  // namespace odds::realtime
