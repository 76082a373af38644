// The stall ledger against clocks moved by hand.
#include "odds/realtime/stall_ledger.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <numeric>
#include <vector>

namespace odds::realtime {
namespace {

TEST(StallLedger, without_a_poll_has_measured_nothing) {
  const StallLedger ledger(1'000'000);
  EXPECT_EQ(ledger.gross_ns(), 0);
  EXPECT_EQ(ledger.net_ns(), 0);
  EXPECT_EQ(ledger.polls(), 0u);
}

TEST(StallLedger, short_gaps_are_work_and_long_gaps_are_stalls) {
  StallLedger ledger(0, 5'000);
  ledger.poll(1'000);
  ledger.poll(6'000);   // exactly the threshold: still work
  ledger.poll(11'001);  // one beyond: a stall
  ledger.poll(12'000);
  EXPECT_EQ(ledger.gross_ns(), 12'000);
  EXPECT_EQ(ledger.stall_ns(), 5'001);
  EXPECT_EQ(ledger.net_ns(), 6'999);
  EXPECT_EQ(ledger.stalls(), 1u);
  EXPECT_EQ(ledger.polls(), 4u);
  EXPECT_EQ(ledger.longest_gap_ns(), 5'001);
}

RC_GTEST_PROP(StallLedger, net_is_the_sum_of_the_gaps_within_the_threshold, (std::vector<std::uint16_t> gaps)) {
  constexpr std::int64_t threshold = 20'000;
  StallLedger ledger(-7, threshold);
  std::int64_t now = -7;
  std::int64_t work = 0;
  for (const std::int64_t gap : gaps) {
    now += gap;
    if (gap <= threshold) work += gap;
    ledger.poll(now);
  }
  RC_ASSERT(ledger.net_ns() == work);
  RC_ASSERT(ledger.gross_ns() == now + 7);
  RC_ASSERT(ledger.stall_ns() + ledger.net_ns() == ledger.gross_ns());
}

}  // namespace
}  // namespace odds::realtime
