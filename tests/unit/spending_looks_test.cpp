// When a query looks at the clock: as often as needed, and no more.
#include <gtest/gtest.h>

#include "query/spending.hpp"

namespace odds::query {
namespace {

using Looks = Spending::Looks;

constexpr std::uint32_t piece = 8;     // units: an opened pair of the wide engine
constexpr std::uint32_t between = 16;  // units between two looks where there is no time to lose

struct Searched {
  std::int64_t ended_ns = 0;  ///< when it was told to end
  std::int64_t looks = 0;
};

/// A search in pieces of which one takes `ns_of(now)`, until it is told to end or has done `most` of them.
template <class NsOf>
Searched search(double budget_us, Looks looks, const NsOf& ns_of, int most = 1'000'000) {
  realtime::ManualClock clock;
  Budget budget = Budget::time(budget_us);
  budget.clock = clock.clock();
  Spending spending(budget, {.search_ns = 600}, looks);
  std::int64_t now = 0;
  for (int i = 0; i < most && spending.may_go_on_in_time(between); ++i) {
    const std::int64_t ns = ns_of(now);
    now += ns;
    clock.advance(ns);
    spending.spend_node_pairs(piece);
  }
  return {now, clock.readings()};
}

TEST(SpendingLooks, AreFewWhereThereIsTime) {
  const auto pace = [](std::int64_t) { return 40; };
  for (const double us : {5.0, 20.0, 100.0}) {
    const Searched always = search(us, Looks::always, pace);
    const Searched as_needed = search(us, Looks::as_needed, pace);
    EXPECT_LT(as_needed.looks, us < 10.0 ? 3 * always.looks / 4 : always.looks / 3) << us << " us";
    EXPECT_NEAR(static_cast<double>(as_needed.ended_ns), static_cast<double>(always.ended_ns), 100.0) << us << " us";
  }
  EXPECT_EQ(search(1e3, Looks::as_needed, pace, 100).looks, 7) << "the start, after 2 pieces, then after each 18";
}

TEST(SpendingLooks, LeaveAQuarterOfTheTimeToWhatNoCacheKnows) {
  // From any moment on a piece takes five times as long.
  for (std::int64_t change = 0; change < 9'400; change += 37) {
    const auto pace = [change](std::int64_t now) { return now < change ? 40 : 200; };
    const Searched searched = search(10.0, Looks::as_needed, pace);
    EXPECT_LE(searched.ended_ns, 9'400 + 3 * 200) << "slow from " << change << " ns on";
  }
}

TEST(SpendingLooks, AreAsManyOnASlowMachineAsItTakes) {
  // Eight times as slow as is taken for slow: known after the first looks.
  const auto pace = [](std::int64_t) { return 1'600; };
  const Searched searched = search(60.0, Looks::as_needed, pace);
  EXPECT_LE(searched.ended_ns, 59'400 + 3 * 1'600);
}

TEST(SpendingLooks, FollowEveryChangeOfTheDeadline) {
  realtime::ManualClock clock;
  Budget budget = Budget::time(1'000.0);
  budget.clock = clock.clock();
  const auto looks_at_once_after = [&](const auto& change) {
    Spending spending(budget, {.search_ns = 600, .contacts_ns = 300'000}, Looks::as_needed);
    EXPECT_TRUE(spending.may_go_on());
    spending.spend_node_pairs(between);
    const std::int64_t before = clock.readings();
    EXPECT_TRUE(spending.may_go_on_in_time(between));
    EXPECT_EQ(clock.readings(), before) << "there is time";
    change(spending);
    static_cast<void>(spending.may_go_on_in_time(between));
    return clock.readings() > before;
  };
  EXPECT_TRUE(looks_at_once_after([](Spending& spending) { spending.keep_time_for_contacts(); }));
  EXPECT_TRUE(looks_at_once_after([](Spending& spending) { spending.begin_start(0.4, 0.4); }));
  EXPECT_FALSE(looks_at_once_after([](Spending&) {}));
}

TEST(SpendingLooks, TestsOfTrianglesAreLookedAtNearTheEnd) {
  realtime::ManualClock clock;
  Budget budget = Budget::time(10.0);
  budget.clock = clock.clock();
  Spending spending(budget, {.search_ns = 600}, Looks::as_needed);
  std::int64_t tests = 0;
  for (; spending.may_test_triangles(); ++tests) {
    clock.advance(100);
    spending.spend_triangle_pairs(1);
  }
  EXPECT_EQ(tests, 94) << "until 9.4 us";
  EXPECT_LT(clock.readings(), tests / 2);
}

TEST(SpendingLooks, AClockThatCountsIsLookedAtEachTime) {
  realtime::ManualClock clock(100);  // a step of 100 ns a look
  Budget budget = Budget::time(10.0);
  budget.clock = clock.clock();
  Spending spending(budget);
  for (int i = 0; i < 20; ++i) {
    const std::int64_t before = clock.readings();
    EXPECT_TRUE(spending.may_test_triangles());
    EXPECT_EQ(clock.readings(), before + 1);
  }
}

TEST(SpendingLooks, AreFewerWhileContactsHaveTime) {
  const auto looks_of = [](Looks looks, std::int64_t& ended_ns) {
    realtime::ManualClock clock;
    Budget budget = Budget::time(50.0);
    budget.clock = clock.clock();
    EndingReserve reserve({4'000, 600, 4'000, 100, 400, 1});
    Spending spending(budget, {.search_ns = 600}, looks);
    spending.reserve_for_contacts(reserve);
    for (ended_ns = 0; spending.may_go_on_making(); ended_ns += 500) clock.advance(500);
    return clock.readings();
  };
  std::int64_t always_ns = 0;
  std::int64_t as_needed_ns = 0;
  const std::int64_t always = looks_of(Looks::always, always_ns);
  EXPECT_LT(looks_of(Looks::as_needed, as_needed_ns), always / 2);
  EXPECT_EQ(always_ns, 46'000);
  EXPECT_EQ(as_needed_ns, 46'000) << "as punctual";
}

// The last look of a search with much time may be long ago: what lies between is not its ending.
TEST(SpendingLooks, AnEndingBeginsWithTheLastPiece) {
  realtime::ManualClock clock;
  Budget budget = Budget::time(1'000.0);
  budget.clock = clock.clock();
  EndingReserve reserve({600, 600, 4'000, 100, 400, 1});
  Spending spending(budget, {.search_ns = 600}, Looks::as_needed);
  EXPECT_TRUE(spending.may_go_on());
  for (int i = 0; i < 16; ++i) {
    clock.advance(200);
    spending.spend_node_pairs(piece);
    EXPECT_TRUE(spending.may_go_on_in_time(between));
  }
  spending.end_from_last_piece(reserve);
  clock.advance(500);
  static_cast<void>(spending.close());
  EXPECT_LT(reserve.ns(), 1'000) << "0.7 us, not 3.7";
}

}  // namespace
}  // namespace odds::query
