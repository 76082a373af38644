// A frame budget for 512 pairs, made and freed for each test.
#pragma once

#include "odds/ode/odds_frame.h"
#include "ode/ode_fixture.hpp"

namespace odds::test {

inline oddsFrameSummary summary_of(oddsFrameBudgetID budget) {
  oddsFrameSummary summary = {};
  EXPECT_EQ(oddsFrameBudgetGetSummary(budget, &summary), 1);
  return summary;
}

class FrameTest : public OdeTest {
 protected:
  void SetUp() override {
    OdeTest::SetUp();
    budget = oddsFrameBudgetCreate(512);
    ASSERT_NE(budget, nullptr);
  }
  void TearDown() override {
    oddsFrameBudgetDestroy(budget);
    OdeTest::TearDown();
  }
  [[nodiscard]] oddsFrameSummary summary() const { return summary_of(budget); }

  oddsFrameBudgetID budget = nullptr;
};

}  // namespace odds::test
