// A query's accounts under a clock that the test sets: what ends when, and what a stall excuses.
#include "query/spending.hpp"

#include <gtest/gtest.h>

namespace odds::query {
namespace {

struct Query {
  explicit Query(double budget_us) : spending(budget(budget_us), {.search_ns = 600}) {}
  Budget budget(double us) {
    Budget made = Budget::time(us);
    made.clock = clock.clock();
    return made;
  }
  /// Own work in pieces of half a microsecond, with a look at the clock after each.
  void work(std::int64_t ns) {
    for (; ns > 0; ns -= 500) {
      clock.advance(std::min<std::int64_t>(ns, 500));
      static_cast<void>(spending.may_make_contacts());
    }
  }
  realtime::ManualClock clock;
  Spending spending;
};

TEST(Spending, ContactsAreMadeInHasteBeforeTheyAreFinished) {
  EndingReserve reserve({2000, 600, 4000, 100, 400, 1});
  Query query(20.0);
  query.spending.reserve_for_contacts(reserve, 3000);
  query.work(14'500);
  EXPECT_TRUE(query.spending.may_make_contacts());
  query.work(500);
  EXPECT_FALSE(query.spending.may_make_contacts());
  EXPECT_TRUE(query.spending.may_finish_contacts());
  query.work(3'000);
  EXPECT_FALSE(query.spending.may_finish_contacts());
}

TEST(Spending, AStartEndsNoLaterThanItsSearch) {
  // Of a microsecond the answer needs 0.6, which is less than the start's share leaves of it.
  Query query(1.0);
  query.spending.begin_start(0.6, 0.6);
  query.clock.advance(300);
  EXPECT_TRUE(query.spending.start_may_go_on_after(0));
  query.clock.advance(150);
  EXPECT_FALSE(query.spending.start_may_go_on_after(0));
  EXPECT_FALSE(query.spending.may_go_on());
  Query longer(10.0);
  longer.spending.begin_start(0.6, 0.6);
  longer.clock.advance(5'900);
  EXPECT_TRUE(longer.spending.start_may_go_on_after(0));
  longer.clock.advance(200);
  EXPECT_FALSE(longer.spending.start_may_go_on_after(0));
  EXPECT_TRUE(longer.spending.may_go_on());
}

TEST(Spending, AStartHasItsShareOfAnyWork) {
  const auto units_of_start = [](std::uint64_t work_units, double share) {
    Spending spending(Budget::work(work_units));
    spending.begin_start(share, share);
    const std::uint64_t before = spending.units_left();
    constexpr std::uint32_t step = 1U << 31U;
    for (int steps = 0; steps < 64 && spending.start_may_go_on_after(0); ++steps) spending.spend_node_pairs(step);
    return before - spending.units_left();
  };
  // As a double that is 2^64, which does not fit back into 64 bits: all of it must not become nothing.
  const std::uint64_t no_limit = Budget::unlimited().work_units;
  constexpr std::uint64_t all_steps = 64ULL << 31U;
  for (const double share : {1.0, 0.999999, 0.5}) EXPECT_EQ(units_of_start(no_limit, share), all_steps) << share;
  EXPECT_EQ(units_of_start(no_limit, 0.0), 0U);
  constexpr std::uint64_t four_steps = 4ULL << 31U;
  EXPECT_EQ(units_of_start(four_steps, 1.0), four_steps);
  EXPECT_EQ(units_of_start(four_steps, 0.5), four_steps / 2);
  EXPECT_EQ(units_of_start(four_steps, 0.0), 0U);
}

TEST(Spending, AReserveLearnsHowLongContactsTakeToEnd) {
  EndingReserve reserve({2000, 600, 6000, 100, 400, 1});
  for (int i = 0; i < 200; ++i) {
    Query query(20.0);
    query.spending.reserve_for_contacts(reserve);
    while (query.spending.may_finish_contacts()) query.work(500);
    query.work(3'000);
    static_cast<void>(query.spending.close());
  }
  EXPECT_GE(reserve.ns(), 3'000);
  EXPECT_LE(reserve.ns(), 4'000);
}

TEST(Spending, WhatIsHeardLateIsLearntToo) {
  // A piece of 2 us without a look at the clock is under way when the time is up.
  EndingReserve reserve({600, 600, 6000, 100, 400, 1});
  for (int i = 0; i < 400; ++i) {
    Query query(20.0);
    query.spending.reserve_for_contacts(reserve);
    while (query.spending.may_finish_contacts()) query.clock.advance(2'000);
    query.work(500);
    static_cast<void>(query.spending.close());
  }
  EXPECT_GE(reserve.ns(), 1'500);
}

TEST(Spending, OfTheLastHitItsPieceIsPartOfTheEnding) {
  for (const std::int64_t contact_ns : {200, 1'200}) {
    EndingReserve reserve({1200, 300, 5000, 50, 300, 4});
    for (int i = 0; i < 400; ++i) {
      Query query(10.0);
      static_cast<void>(query.spending.may_go_on());
      query.clock.advance(400);  // the piece
      query.spending.end_from_last_piece(reserve);
      query.clock.advance(contact_ns);
      static_cast<void>(query.spending.close());
    }
    EXPECT_NEAR(static_cast<double>(reserve.ns()), static_cast<double>(400 + contact_ns), 40.0);
  }
}

TEST(Spending, OfASearchTheLastPieceIsPartOfTheEnding) {
  Query query(10.0);             // of which 0.6 us are kept
  for (int i = 0; i < 3; ++i) {  // longer gaps would be stalls
    query.clock.advance(3'000);
    EXPECT_TRUE(query.spending.may_go_on());
  }
  query.clock.advance(1'500);
  EXPECT_FALSE(query.spending.may_go_on());
  query.clock.advance(250);
  static_cast<void>(query.spending.close());
  EXPECT_EQ(query.spending.ending_ns(), 1'350);
}

TEST(Spending, OfLongPiecesAShortTimeIsKeptAsAWhole) {
  const auto goes_on_after = [](double budget_us, bool pieces_are_long, std::int64_t ns,
                                std::int64_t search_ns = 1'500) {
    realtime::ManualClock clock;
    Budget budget = Budget::time(budget_us);
    budget.clock = clock.clock();
    Spending spending(budget, {.search_ns = search_ns, .pieces_are_long = pieces_are_long});
    clock.advance(ns);
    return spending.may_go_on();
  };
  EXPECT_FALSE(goes_on_after(1.0, true, 0));
  EXPECT_TRUE(goes_on_after(1.0, false, 399));
  EXPECT_FALSE(goes_on_after(1.0, false, 400));
  EXPECT_TRUE(goes_on_after(2.0, true, 799));
  EXPECT_FALSE(goes_on_after(2.0, true, 800));
  EXPECT_TRUE(goes_on_after(2.0, false, 799)) << "what caches do not know takes longer than three tenths";
  EXPECT_FALSE(goes_on_after(2.0, false, 800));
  EXPECT_TRUE(goes_on_after(3.0, false, 1'499)) << "what it needs";
  EXPECT_FALSE(goes_on_after(3.0, false, 1'500));
  EXPECT_TRUE(goes_on_after(3.0, false, 1'199, 5'000)) << "no more than six tenths";
  EXPECT_FALSE(goes_on_after(3.0, false, 1'200, 5'000));
  EXPECT_TRUE(goes_on_after(4.0, false, 1'999, 5'000)) << "nor than 2 us";
  EXPECT_FALSE(goes_on_after(4.0, false, 2'000, 5'000));
  EXPECT_TRUE(goes_on_after(5.0, true, 3'499)) << "what it needs and no more";
  EXPECT_FALSE(goes_on_after(5.0, true, 3'500));
}

TEST(Spending, AContactOfTheLastHitIsKeptTimeForToo) {
  const auto goes_on_after = [](double budget_us, std::int64_t last_contact_ns, std::int64_t ns) {
    realtime::ManualClock clock;
    Budget budget = Budget::time(budget_us);
    budget.clock = clock.clock();
    Spending spending(budget, {.search_ns = 300, .last_contact_ns = last_contact_ns});
    clock.advance(ns);
    return spending.may_go_on();
  };
  EXPECT_TRUE(goes_on_after(5.0, 1'000, 3'999));
  EXPECT_FALSE(goes_on_after(5.0, 1'000, 4'000));
  EXPECT_FALSE(goes_on_after(5.0, 100, 4'700)) << "the longer of both";
  EXPECT_TRUE(goes_on_after(5.0, 3'000, 3'499)) << "three tenths at most";
  EXPECT_FALSE(goes_on_after(5.0, 3'000, 3'500));
}

// What is kept then is twice as much.
TEST(Spending, AfterAStallASearchEndsEarlier) {
  const auto goes_on_at = [](std::int64_t search_ns, bool pieces_are_long, std::int64_t ns) {
    realtime::ManualClock clock;
    Budget budget = Budget::time(40.0);
    budget.clock = clock.clock();
    Spending spending(budget, {.search_ns = search_ns, .pieces_are_long = pieces_are_long});
    clock.advance(30'000);
    EXPECT_TRUE(spending.may_go_on());
    clock.advance(ns - 30'000);
    return spending.may_go_on();
  };
  EXPECT_TRUE(goes_on_at(2'000, false, 35'999));
  EXPECT_FALSE(goes_on_at(2'000, false, 36'000));
  EXPECT_TRUE(goes_on_at(2'000, true, 35'999));
  EXPECT_FALSE(goes_on_at(2'000, true, 36'000));
}

// What the search would keep no longer counts once time is kept for contacts: here as much before a stall as after it.
TEST(Spending, AStallIsExcusedFromWhereContactsHaveToEnd) {
  realtime::ManualClock clock;
  Budget budget = Budget::time(10.0);
  budget.clock = clock.clock();
  Spending spending(budget, {.search_ns = 3'000, .contacts_ns = 3'000, .pieces_are_long = true});
  spending.keep_time_for_contacts();
  clock.advance(6'000);  // another's, in time for contacts to end at 7 us
  static_cast<void>(spending.left_us());
  clock.advance(5'200);  // another's, of which 4.2 us are beyond that
  static_cast<void>(spending.left_us());
  for (int i = 0; i < 4; ++i) {
    clock.advance(950);
    static_cast<void>(spending.left_us());
  }
  EXPECT_NEAR(spending.close().net_overshoot_us, 5.0 - 4.2, 1e-9);
}

TEST(Spending, AnEndingWithAStallIsNotLearnt) {
  Query query(10.0);
  query.clock.advance(50'000);
  EXPECT_FALSE(query.spending.may_go_on());
  static_cast<void>(query.spending.close());
  EXPECT_EQ(query.spending.ending_ns(), 0);
}

TEST(Spending, OwnWorkBeyondTheBudgetIsNeverExcused) {
  Query query(20.0);
  query.work(23'000);
  const Cost cost = query.spending.close();
  EXPECT_EQ(cost.stall_us, 0.0);
  EXPECT_DOUBLE_EQ(cost.overshoot_us, 3.0);
  EXPECT_DOUBLE_EQ(cost.net_overshoot_us, 3.0);
}

TEST(Spending, AStallExcusesFromTheMomentThatTheQueryHadToEnd) {
  // 10 us of work, then 30 us away: of those 20.6 lie beyond the last moment, 600 ns before the deadline.
  Query query(20.0);
  query.work(10'000);
  query.clock.advance(30'000);
  static_cast<void>(query.spending.may_go_on());
  query.work(1'500);
  const Cost cost = query.spending.close();
  EXPECT_DOUBLE_EQ(cost.overshoot_us, 21.5);
  EXPECT_DOUBLE_EQ(cost.net_overshoot_us, 0.9) << "1.5 us of work, for which 0.6 were kept";
}

TEST(Spending, AnEarlyStallExcusesNothing) {
  Query query(50.0);
  query.work(10'000);
  query.clock.advance(30'000);
  query.work(12'000);
  const Cost cost = query.spending.close();
  EXPECT_DOUBLE_EQ(cost.stall_us, 30.5);
  EXPECT_DOUBLE_EQ(cost.net_overshoot_us, 2.0) << "there was time to react to it";
}

TEST(Spending, AfterAStallTwiceTheTimeIsKeptForCachesAreCold) {
  EndingReserve reserve({2000, 600, 4000, 100, 400, 1});
  Query query(50.0);
  query.spending.reserve_for_contacts(reserve, 3000);
  query.work(10'000);
  query.clock.advance(10'000);
  query.work(23'000);  // 43 us
  EXPECT_TRUE(query.spending.may_finish_contacts());
  EXPECT_FALSE(query.spending.may_make_contacts()) << "2 + 2 + 3 us before the end";
  query.clock.advance(10'000);
  EXPECT_FALSE(query.spending.may_finish_contacts());
  EXPECT_DOUBLE_EQ(query.spending.close().net_overshoot_us, 0.0) << "the second is excused from 46 us on";
}

TEST(Spending, AStallBeforeContactsAreBegunCoolsTheirEndingToo) {
  EndingReserve reserve({2000, 600, 4000, 100, 400, 1});
  Query query(50.0);
  query.clock.advance(10'000);
  EXPECT_TRUE(query.spending.may_go_on());
  query.spending.reserve_for_contacts(reserve);
  query.work(35'500);
  EXPECT_TRUE(query.spending.may_finish_contacts());
  query.work(500);
  EXPECT_FALSE(query.spending.may_finish_contacts()) << "46 us";
}

TEST(Spending, AfterAStallASearchEndsEarlierToo) {
  Query query(20.0);
  query.clock.advance(10'000);
  EXPECT_TRUE(query.spending.may_go_on());
  query.clock.advance(8'700);
  EXPECT_TRUE(query.spending.may_go_on());
  query.clock.advance(100);
  EXPECT_FALSE(query.spending.may_go_on()) << "twice 600 ns before the end";
}

TEST(Spending, WithinWorkUnitsNothingIsLearntAndTheClockIsNotAsked) {
  EndingReserve reserve({2000, 600, 4000, 100, 400, 1});
  realtime::ManualClock clock;
  Budget budget = Budget::work(100);
  budget.clock = clock.clock();
  Spending spending(budget);
  const auto readings = clock.readings();
  spending.reserve_for_contacts(reserve, 3000);
  EXPECT_TRUE(spending.may_make_contacts());
  EXPECT_TRUE(spending.may_finish_contacts());
  EXPECT_EQ(clock.readings(), readings);
  static_cast<void>(spending.close());
  EXPECT_EQ(reserve.ns(), 2000);
}

}  // namespace
}  // namespace odds::query
