// Memory that pairs share: each run has it for itself, and reads nothing that another one has left.
#include "query/memory/scratch_pool.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <memory>
#include <thread>
#include <vector>

#include "odds/query/pair.hpp"
#include "support/allocation_counter.hpp"
#include "support/shapes.hpp"

namespace odds::query {
namespace {

constexpr ScratchPool::Capacities small{64, 8};

TEST(ScratchPool, ServesAThousandPairsWithAFew) {
  const auto pool = ScratchPool::of(small);
  EXPECT_EQ(pool, ScratchPool::of(small));
  EXPECT_EQ(pool->size(), 0u);
  pool->add_pair();
  EXPECT_EQ(pool->size(), 1u);
  for (int i = 0; i < 999; ++i) pool->add_pair();
  EXPECT_EQ(pool->size(), std::max(ScratchPool::most_threads, std::thread::hardware_concurrency()));
  for (int i = 0; i < 1000; ++i) pool->remove_pair();
}

TEST(ScratchPool, ForgetsWhatNobodyNeeds) {
  ScratchPool::of(small)->add_pair();
  EXPECT_EQ(ScratchPool::of(small)->size(), 0u);
}

TEST(ScratchPool, GivesTheSameOneAgain) {
  const auto pool = ScratchPool::of(small);
  for (int i = 0; i < 3; ++i) pool->add_pair();
  std::uint32_t last = 0;
  const Scratch* first = std::to_address(pool->borrow(last));
  const support::AllocationCounter counter;
  for (int i = 0; i < 10; ++i) EXPECT_EQ(std::to_address(pool->borrow(last)), first);
  {
    const auto other = pool->borrow(last);
    std::uint32_t of_another_pair = 0;
    EXPECT_NE(std::to_address(pool->borrow(of_another_pair)), first);
    EXPECT_NE(of_another_pair, 0u);
  }
  EXPECT_EQ(counter.allocations(), 0u);
}

TEST(ScratchPool, SaysWhetherOneIsLeftToTake) {
  const auto pool = ScratchPool::of({64, 8, 0, 3});
  EXPECT_FALSE(pool->has_free());
  for (int i = 0; i < 5; ++i) pool->add_pair();
  std::uint32_t places[3] = {};
  Scratch* taken[3] = {};
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(pool->has_free()) << i;
    taken[i] = pool->take(places[i]);
    ASSERT_NE(taken[i], nullptr) << i;
  }
  EXPECT_FALSE(pool->has_free());
  std::uint32_t last = 0;
  EXPECT_EQ(pool->take(last), nullptr);
  pool->give_back(*taken[1], places[1]);
  EXPECT_TRUE(pool->has_free());
  EXPECT_EQ(pool->take(last), taken[1]);
  EXPECT_EQ(last, places[1]);
}

/// More threads than there are processors, and pairs that come and go meanwhile.
TEST(ScratchPool, LendsEachToOneThreadAtATime) {
  const auto pool = ScratchPool::of(small);
  constexpr int threads = 8;
  for (int i = 0; i < threads; ++i) pool->add_pair();
  std::vector<std::thread> at_work;
  std::atomic<int> failures{0};
  for (int t = 0; t < threads; ++t) {
    at_work.emplace_back([&, t] {
      std::uint32_t last = 0;
      for (int i = 0; i < 20000; ++i) {
        const auto scratch = pool->borrow(last);
        const auto mark = static_cast<std::uint32_t>(t * 20000 + i);
        scratch->queue.clear();
        scratch->queue.push(0, {mark, mark, 0.0F});  // a race, for the thread sanitizer, if another has it too
        if (i % 64 == 0) std::this_thread::yield();
        if (scratch->queue.size() != 1 || scratch->queue.top().a != mark) ++failures;
      }
    });
  }
  for (int i = 0; i < 100; ++i) {
    pool->add_pair();
    pool->remove_pair();
  }
  for (std::thread& thread : at_work) thread.join();
  EXPECT_EQ(failures, 0);
}

bool same_bits(const Vec3& u, const Vec3& v) { return std::memcmp(u.data(), v.data(), sizeof(double) * 3) == 0; }

struct Recorded {
  Verdict verdict;
  double probability;
  std::uint64_t units;
  std::vector<Contact> contacts;
  explicit Recorded(const Answer& answer)
      : verdict(answer.verdict),
        probability(answer.probability),
        units(answer.cost.node_pairs + answer.cost.triangle_pairs),
        contacts(answer.contacts.begin(), answer.contacts.end()) {}
};

void expect_same(const Recorded& x, const Recorded& y) {
  EXPECT_EQ(x.verdict, y.verdict);
  EXPECT_EQ(x.probability, y.probability);
  EXPECT_EQ(x.units, y.units);
  ASSERT_EQ(x.contacts.size(), y.contacts.size());
  for (std::size_t i = 0; i < x.contacts.size(); ++i) {
    EXPECT_TRUE(same_bits(x.contacts[i].position, y.contacts[i].position));
    EXPECT_TRUE(same_bits(x.contacts[i].normal, y.contacts[i].normal));
    EXPECT_EQ(x.contacts[i].depth, y.contacts[i].depth);
  }
}

/// A shape rocks on its copy; each seed is a motion of its own.
std::vector<Recorded> rock(Pair& pair, std::uint64_t seed, Method method, int from, int to) {
  Request request;
  request.method = method;
  request.max_contacts = 8;
  std::vector<Recorded> answers;
  for (int i = from; i < to; ++i) {
    request.budget = {};
    request.budget.work_units = i % 3 == 0 ? 40 : i % 3 == 1 ? 400 : 40000;
    const double t = 0.05 * i + static_cast<double>(seed);
    const Mat3 turned = Eigen::AngleAxisd(0.3 * t, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    answers.emplace_back(pair.run({turned, {1.6 + 0.4 * std::sin(t), 0.2 * std::cos(2.0 * t), 0.1}}, request));
  }
  return answers;
}

class SharedScratchOf : public ::testing::TestWithParam<Method> {};

TEST_P(SharedScratchOf, PairsThatTakeTurnsAnswerAsEachAlone) {
  auto fine = Shape::build(testing::wavy_sphere(40));
  auto coarse = Shape::build(testing::wavy_sphere(9, 0.3));
  ASSERT_TRUE(fine.ok() && coarse.ok());
  const auto make = [](const std::shared_ptr<const Shape>& shape) {
    return std::move(Pair::make(shape, shape)).value();
  };
  constexpr int runs = 120;
  std::vector<Recorded> alone[2];
  for (int k = 0; k < 2; ++k) {
    Pair pair = make(k == 0 ? fine.value() : coarse.value());
    alone[k] = rock(pair, static_cast<std::uint64_t>(k), GetParam(), 0, runs);
  }
  Pair turns[2] = {make(fine.value()), make(coarse.value())};
  for (int i = 0; i < runs; ++i) {
    for (int k = 0; k < 2; ++k) {
      const auto now = rock(turns[k], static_cast<std::uint64_t>(k), GetParam(), i, i + 1);
      expect_same(now[0], alone[k][static_cast<std::size_t>(i)]);
    }
  }
}

TEST_P(SharedScratchOf, PairsInThreadsAnswerAsOneAfterAnother) {
  auto shape = Shape::build(testing::wavy_sphere(30));
  ASSERT_TRUE(shape.ok());
  constexpr std::size_t threads = 6;
  constexpr int runs = 60;
  std::vector<Recorded> alone[threads];
  std::vector<Recorded> together[threads];
  std::vector<Pair> pairs;
  for (std::size_t t = 0; t < threads; ++t) {
    pairs.push_back(std::move(Pair::make(shape.value(), shape.value())).value());
    alone[t] = rock(pairs[t], t, GetParam(), 0, runs);
    pairs[t].reset();
  }
  std::vector<std::thread> at_work;
  for (std::size_t t = 0; t < threads; ++t) {
    at_work.emplace_back([&, t] { together[t] = rock(pairs[t], t, GetParam(), 0, runs); });
  }
  for (std::thread& thread : at_work) thread.join();
  for (std::size_t t = 0; t < threads; ++t) {
    ASSERT_EQ(together[t].size(), alone[t].size());
    for (std::size_t i = 0; i < alone[t].size(); ++i) expect_same(together[t][i], alone[t][i]);
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, SharedScratchOf,
                         ::testing::Values(Method::exact, Method::time_critical, Method::incremental));

}  // namespace
}  // namespace odds::query
