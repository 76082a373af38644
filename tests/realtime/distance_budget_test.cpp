// The hard budget of distances: with an injected clock, without allocations, and honest about what it did not finish.
#include <gtest/gtest.h>

#include "odds/math/random.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"
#include "odds/realtime/clock.hpp"
#include "support/allocation_counter.hpp"

namespace odds::query {
namespace {

class DistanceBudget : public ::testing::Test {
 protected:
  static Pair make_knots() {
    auto mesh = mesh::made::make_shape("made:torus_knot:along=200,across=10");
    const auto shape = Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value()), {}).value();
    return std::move(Pair::make(shape, shape)).value();
  }
  math::Pose pose() {
    const double size = pair_.a().mesh().size();
    return math::Pose::from_quaternion(size * random_.uniform(0.2, 1.5) * random_.direction(), random_.rotation());
  }

  Pair pair_ = make_knots();
  math::Random random_{7};
};

TEST_F(DistanceBudget, EndsAtAnInjectedDeadline) {
  constexpr std::int64_t step_ns = 500;
  int cut_short = 0;
  for (int i = 0; i < 300; ++i) {
    const math::Pose placed = pose();
    const double truth = pair_.distance(placed, {}).upper;
    realtime::ManualClock clock(step_ns);
    DistanceRequest request{.budget = Budget::time(1.0 + i % 30)};
    request.budget.clock = clock.clock();
    const DistanceAnswer answer = pair_.distance(placed, request);
    EXPECT_LE(answer.cost.overshoot_us, 2.0 * step_ns * 1e-3);
    EXPECT_LE(answer.cost.longest_unpolled_units, 112U) << "little work may pass between two polls";
    EXPECT_LE(answer.lower, truth);
    EXPECT_GE(answer.upper, truth);
    cut_short += answer.proved ? 0 : 1;
  }
  EXPECT_GT(cut_short, 100);
}

TEST_F(DistanceBudget, NoQueryAllocates) {
  if (!support::counts_allocations) GTEST_SKIP() << "the sanitizer's allocator is not counted";
  for (int i = 0; i < 100; ++i) {
    const math::Pose placed = pose();
    for (const Budget& budget : {Budget::unlimited(), Budget::time(5.0), Budget::work(1), Budget::work(300)}) {
      const support::AllocationCounter counter;
      static_cast<void>(pair_.distance(placed, {.within = 0.5 * (1 + i % 4), .budget = budget}));
      ASSERT_EQ(counter.allocations(), 0U);
      ASSERT_EQ(counter.frees(), 0U);
    }
  }
}

}  // namespace
}  // namespace odds::query
