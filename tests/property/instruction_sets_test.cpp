// The wide engine's instruction sets do the same work and give the same bits.
#include <gtest/gtest.h>

#include <bit>
#include <memory>
#include <optional>

#include "odds/math/random.hpp"
#include "odds/query/pair.hpp"
#include "query/wide/searches.hpp"
#include "support/instruction_sets.hpp"
#include "support/near_poses.hpp"
#include "support/shapes.hpp"

namespace odds::query {
namespace {

std::optional<Pair> pair_on(InstructionSet set, const std::shared_ptr<const Shape>& a,
                            const std::shared_ptr<const Shape>& b) {
  auto pair = Pair::make(a, b, {.instruction_set = set});
  if (!pair.ok()) return std::nullopt;
  return std::move(pair).value();
}

void expect_same(const Answer& expected, const Answer& answer) {
  ASSERT_EQ(answer.verdict, expected.verdict);
  ASSERT_EQ(answer.basis, expected.basis);
  ASSERT_EQ(std::bit_cast<std::uint64_t>(answer.probability), std::bit_cast<std::uint64_t>(expected.probability));
  ASSERT_EQ(answer.cost.node_pairs, expected.cost.node_pairs);
  ASSERT_EQ(answer.cost.triangle_pairs, expected.cost.triangle_pairs);
  ASSERT_EQ(answer.contacts.size(), expected.contacts.size());
  for (std::size_t i = 0; i < answer.contacts.size(); ++i) {
    ASSERT_EQ(answer.contacts[i].triangle_a, expected.contacts[i].triangle_a);
    ASSERT_EQ(answer.contacts[i].position, expected.contacts[i].position);
  }
}

TEST(InstructionSets, GiveTheSameBitsForEveryMethodAndBudget) {
  const auto a = Shape::build(testing::wavy_sphere(24)).value();
  const auto b = Shape::build(testing::wavy_sphere(15)).value();
  std::optional<Pair> portable = pair_on(InstructionSet::portable, a, b);
  ASSERT_TRUE(portable.has_value());
  int others = 0;
  for (const InstructionSet set : testing::instruction_sets) {
    std::optional<Pair> pair = pair_on(set, a, b);
    if (!pair || set == InstructionSet::portable) continue;  // not on this processor
    ++others;
    math::Random random(5);
    for (int i = 0; i < 200; ++i) {
      const math::Pose pose{random.rotation().toRotationMatrix(), (1.9 + 0.2 * random.uniform()) * random.direction()};
      Request request;
      request.method = static_cast<Method>(i % 3);
      request.max_contacts = i % 4;
      if (i % 5 == 0) request.budget = Budget::work(static_cast<std::uint64_t>(64 + 7 * i));
      if (i % 7 == 0) request.estimator = EstimatorKind::cells;
      portable->reset();
      pair->reset();
      expect_same(portable->run(pose, request), pair->run(pose, request));
      if (HasFatalFailure()) FAIL() << "pose " << i;
    }
  }
#if defined(__x86_64__) || defined(__aarch64__)
  EXPECT_GE(others, 1);  // every x86-64 has SSE2, every 64-bit ARM NEON
#else
  EXPECT_EQ(others, 0);
#endif
}

bool same(const std::optional<RayHit>& a, const std::optional<RayHit>& b) {
  return a.has_value() == b.has_value() && (!a || (a->distance == b->distance && a->triangle == b->triangle));
}

TEST(InstructionSets, CastTheSameRays) {
  const auto mesh = testing::wavy_sphere(20, 0.3);
  const auto tree = tree::WideTree::build(*mesh, {.leaf_triangles = 8});
  const wide::Searches* portable = wide::searches_for(InstructionSet::portable);
  for (const InstructionSet set : testing::instruction_sets) {
    const wide::Searches* searches = wide::searches_for(set);
    if (searches == nullptr) continue;
    math::Random random(6);
    int met = 0;
    for (int i = 0; i < 500; ++i) {
      const std::uint64_t nodes = i % 4 == 0 ? 1 + static_cast<std::uint64_t>(i) / 20 : UINT64_MAX;
      RayEffort effort;
      const wide::RayTask task{*mesh,   tree,  1.5 * random.uniform() * random.direction(), random.direction(), 5.0,
                               {nodes}, effort};
      const auto expected = portable->ray(task);
      const RayEffort portable_effort = effort;
      RayEffort other_effort;
      const wide::RayTask other{*mesh, tree, task.direction, -task.direction, 5.0, {nodes}, other_effort};
      const auto expected_of_other = portable->ray(other);
      for (const wide::Searches* of : {portable, searches}) {
        effort = other_effort = {};
        const auto [one, two] = of->two_rays(task, other);
        EXPECT_EQ(effort.nodes, portable_effort.nodes);
        EXPECT_EQ(effort.finished, portable_effort.finished);
        EXPECT_GT(other_effort.nodes, 0u);
        ASSERT_TRUE(same(one, expected)) << i;
        ASSERT_TRUE(same(two, expected_of_other)) << i;
      }
      const auto found = searches->ray(task);
      EXPECT_EQ(effort.nodes, portable_effort.nodes);
      EXPECT_EQ(effort.finished, portable_effort.finished);
      ASSERT_TRUE(same(found, expected)) << i;
      met += expected.has_value() ? 1 : 0;
    }
    EXPECT_GT(met, 100);
  }
}

}  // namespace
}  // namespace odds::query
