// The hard budget: with an injected clock (repeatable), without allocations, and in a real 1 kHz loop judged by net
// time.
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <limits>

#include "odds/math/random.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"
#include "odds/realtime/fitness.hpp"
#include "odds/realtime/periodic_loop.hpp"
#include "odds/realtime/thread_setup.hpp"
#include "odds/realtime/usage.hpp"
#include "support/all_kinds.hpp"
#include "support/allocation_counter.hpp"

namespace odds::query {
namespace {

constexpr auto kinds = testing::all_kinds();
constexpr Method methods[] = {Method::exact, Method::incremental, Method::time_critical};

std::shared_ptr<const Shape> car(std::uint32_t triangles, volume::Kind kind) {
  auto mesh = mesh::made::make_shape("made:car_body:triangles=" + std::to_string(triangles));
  return Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value()), {.volume = kind}).value();
}

/// Overlapping to just apart.
math::Pose random_pose(math::Random& random, double size) {
  return math::Pose::from_quaternion(size * random.uniform(0.1, 0.7) * random.direction(), random.rotation());
}

TEST(Budget, EndsAtAnInjectedDeadlineWhateverIsAsked) {
  // Each reading of this clock moves it by 0.1 us, as if every piece of work between two polls took that long.
  constexpr std::int64_t step_ns = 100;
  for (const volume::Kind kind : kinds) {
    const auto shape = car(4000, kind);
    auto pair = std::move(Pair::make(shape, shape)).value();
    math::Random random(1);
    for (int i = 0; i < 200; ++i) {
      const auto pose = random_pose(random, shape->mesh().size());
      for (const Method method : methods) {
        for (const int contacts : {0, 1, 8}) {
          realtime::ManualClock clock(step_ns);
          Request request;
          request.method = method;
          request.max_contacts = contacts;
          request.budget = Budget::time(1.0 + i % 60);
          request.budget.clock = clock.clock();
          const Answer& answer = pair.run(pose, request);
          // One piece of work may be under way when the time ends, and closing reads the clock once more. What contacts
          // need to end is learnt from the queries before.
          const double allowed = (contacts > 0 ? 10.0 : 2.0) * step_ns * 1e-3;
          EXPECT_LE(answer.cost.overshoot_us, allowed) << volume::name(kind) << " method " << static_cast<int>(method);
          // The wide engine tests 8 boxes or up to 64 pairs of triangles at once, each in a tenth of the time.
          const std::uint32_t most = kind == volume::Kind::wide ? 112 : 4;
          EXPECT_LE(answer.cost.longest_unpolled_units, most) << "little work may pass between two polls";
          EXPECT_TRUE(answer.probability >= 0.0 && answer.probability <= 1.0);
        }
      }
    }
  }
}

TEST(Budget, NoQueryAllocates) {
  if (!support::counts_allocations) GTEST_SKIP() << "the sanitizer's allocator is not counted";
  for (const volume::Kind kind : kinds) {
    const auto shape = car(4000, kind);
    auto pair = std::move(Pair::make(shape, shape)).value();
    math::Random random(2);
    const Budget budgets[] = {Budget::unlimited(), Budget::time(1.0), Budget::time(20.0), Budget::work(1),
                              Budget::work(300)};
    for (int i = 0; i < 40; ++i) {
      const auto pose = random_pose(random, shape->mesh().size());
      for (const Method method : methods) {
        for (const auto estimator : {EstimatorKind::cells, EstimatorKind::kinematic}) {
          for (const Budget& budget : budgets) {
            Request request;
            request.method = method;
            request.estimator = estimator;
            request.budget = budget;
            request.max_contacts = i % 9;
            request.p_min = i % 2 == 0 ? 1.0 : 0.9;
            request.polygon_free = i % 5 == 0;
            const support::AllocationCounter counter;
            static_cast<void>(pair.run(pose, request));
            ASSERT_EQ(counter.allocations(), 0u) << volume::name(kind) << " method " << static_cast<int>(method);
            ASSERT_EQ(counter.frees(), 0u);
          }
        }
      }
    }
  }
}

/// Nearest rank; of nothing, not a number.
double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  return values[std::clamp<std::size_t>(rank, 1, values.size()) - 1];
}

TEST(Budget, HoldsInA1kHzLoopNetOfStalls) {
  const auto fitness = realtime::probe_fitness();
  if (!fitness.fit) GTEST_SKIP() << "INCONCLUSIVE: " << fitness.reason;
  constexpr double budget_us = 100.0;
  constexpr std::uint64_t ticks = 2000;
  const auto shape = car(20000, volume::Kind::wide);
  auto pair = std::move(Pair::make(shape, shape)).value();
  std::vector<double> net(ticks);  // touched now: its pages are not the queries' faults
  net.clear();
  std::uint64_t answered = 0;
  double stalls_us = 0.0;
  double gross_us = 0.0;
  std::vector<double> undisturbed(ticks);  // after a stall the caches are another's
  undisturbed.clear();
  math::Random random(3);
  const Request request = {.budget = Budget::time(budget_us), .max_contacts = 8};
  // Pages of code and of the stack that nobody has touched yet are faults, too. Where memory cannot be locked, most of
  // them are touched as every way to an answer is gone a few times.
  const auto setup = realtime::set_up_this_thread({.lock_memory = true, .prefault_stack_bytes = 512 * 1024});
  const bool locked = setup.front().outcome != realtime::SetupLine::Outcome::refused;
  for (const double warm_us : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0, budget_us}) {
    Request warm = request;
    warm.budget = Budget::time(warm_us);
    for (int i = 0; i < 40; ++i) static_cast<void>(pair.run(random_pose(random, shape->mesh().size()), warm));
  }
  const auto before = realtime::thread_usage();
  const auto loop =
      realtime::run_periodic({.ticks = ticks}, realtime::real_time(), {}, [&](const realtime::Tick&) noexcept {
        const Answer& answer = pair.run(random_pose(random, shape->mesh().size()), request);
        answered += answer.probability >= 0.0 && answer.probability <= 1.0 ? 1 : 0;
        net.push_back(answer.cost.net_us());
        if (!(answer.cost.stall_us > 0.0)) undisturbed.push_back(answer.cost.gross_us);
        stalls_us += answer.cost.stall_us;
        gross_us += answer.cost.gross_us;
      });
  const auto faults = realtime::thread_usage() - before;
  EXPECT_EQ(answered, loop.ran) << "every tick is answered";
  const double p999 = quantile(net, 0.999);
  RecordProperty("net_p999_us", std::to_string(p999));
  std::cout << "net query time p50 " << quantile(net, 0.5) << ", p99 " << quantile(net, 0.99) << ", p99.9 " << p999
            << ", max " << quantile(net, 1.0) << " us of " << net.size() << " ticks; skipped " << loop.skipped
            << ", p99.9 " << quantile(undisturbed, 0.999) << " of " << undisturbed.size() << " without a stall; stalls "
            << 100.0 * stalls_us / gross_us << " % of the time\n";
  if (stalls_us > 0.02 * gross_us)
    GTEST_SKIP() << "INCONCLUSIVE: " << 100.0 * stalls_us / gross_us << " % of the time was stalls";
  // Others may have come while it ran: they slow down even what is not stalled.
  const auto fitness_after = realtime::probe_fitness();
  if (!fitness_after.fit) GTEST_SKIP() << "INCONCLUSIVE: after the run " << fitness_after.reason;
  EXPECT_LE(faults.minor_faults + faults.major_faults, locked ? 0u : 2u)
      << "page faults would hide among the stalls; " << setup.front().text();
  EXPECT_GE(undisturbed.size(), net.size() * 9 / 10) << "too many: own work without a look at the clock is no stall";
  EXPECT_LE(quantile(undisturbed, 0.99), budget_us + 1.0);
  EXPECT_LE(quantile(undisturbed, 0.999), budget_us + 5.0) << "two ticks; odds_bench_overshoot has more";
}

}  // namespace
}  // namespace odds::query
