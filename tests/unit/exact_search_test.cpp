// What the wide engine's exact search leaves, and what it bears.
#include "query/wide/exact.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "odds/math/random.hpp"
#include "odds/query/pair.hpp"
#include "query/shape_data.hpp"
#include "query/wide/time_critical.hpp"
#include "support/by_queue.hpp"
#include "support/shapes.hpp"

namespace odds::query::wide {
namespace {

using L = lanes::Portable;

/// Two balls that overlap.
class ExactSearch : public ::testing::Test {
 protected:
  const std::shared_ptr<const Shape> shape = Shape::build(odds::testing::wavy_sphere(24)).value();
  const tree::WideTree& tree = *std::get_if<tree::WideTree>(&shape->data().tree);
  const PosedMeshes meshes{
      shape->mesh(), shape->mesh(), tree.origin(), tree.origin(), {Mat3::Identity(), {1.2, 0.3, 0.1}}};
  const Encounter met{tree, tree, meshes, EstimatorKind::kinematic};
  HitList hits{256};
};

TEST_F(ExactSearch, RanksThePairOfRootsIfItEndsThere) {
  const Request request{.budget = Budget::work(1)};
  BucketQueue queue(16);
  Spending spending(request.budget);
  SearchResult result;
  Task task{met, request, 1, &queue, hits, spending, result};
  Exact<L>::run_from_roots(task);
  EXPECT_EQ(result.ended, Progressed::spent);
  EXPECT_EQ(result.open, 1U);
  ASSERT_EQ(result.shortlist.size(), 1U);
  EXPECT_EQ(result.shortlist.highest().rank, rank_of<L>(met, tree::WideTree::root, tree::WideTree::root));
}

TEST_F(ExactSearch, CountsWhatItLeavesOpenHoweverFarItCame) {
  for (const int wanted : {1, 8}) {
    for (std::uint64_t units = 8; units < 1000; units += 8) {
      const Request request{.budget = Budget::work(units), .max_contacts = wanted};
      BucketQueue queue(16);
      Spending spending(request.budget);
      SearchResult result;
      hits.clear();
      Task task{met, request, static_cast<std::uint32_t>(wanted), &queue, hits, spending, result};
      Exact<L>::run_from_roots(task);
      EXPECT_LE(spending.so_far().node_pairs + spending.so_far().triangle_pairs, units);
      if (result.ended != Progressed::spent || !hits.empty()) continue;
      EXPECT_EQ(result.shortlist.size(), std::min(result.open, Shortlist::capacity)) << units << " units";
      for (const NodePair& pair : result.shortlist) EXPECT_LT(pair.rank, 64.0F) << units << " units";
    }
  }
}

TEST_F(ExactSearch, OfPairsThatFoundNoRoomInAQueueDoesNotChangeItsOrder) {
  const Request request = odds::testing::by_queue({.budget = Budget::work(2000), .max_contacts = 8});
  BucketQueue queue(1);
  Spending spending(request.budget);
  SearchResult result;
  Task task{met, request, 100, &queue, hits, spending, result};
  TimeCritical<L>::run(task);
  EXPECT_GT(spending.so_far().queue_full, 0U);
  EXPECT_EQ(result.method, Method::time_critical);
}

/// A square of the plane z = 0 from the origin on, of `cells` by `cells` squares.
std::shared_ptr<const mesh::TriangleMesh> flat_square(double size, int cells) {
  std::vector<Vec3> vertices;
  std::vector<mesh::Triangle> triangles;
  const auto corner = [&](int i, int j) { return static_cast<std::uint32_t>(i * (cells + 1) + j); };
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j <= cells; ++j) vertices.emplace_back(size * i / cells, size * j / cells, 0.0);
  }
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      triangles.push_back({corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)});
      triangles.push_back({corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)});
    }
  }
  return std::make_shared<const mesh::TriangleMesh>(
      mesh::TriangleMesh::make(std::move(vertices), std::move(triangles)).value());
}

// Surfaces without any thickness, so large that rounding may hide a gap of a million kilometres. A proof that bodies
// are apart needs the same pairs in every order.
TEST(HugeFlatMeshes, AreOpenedNoFurtherThanTheyOverlap) {
  constexpr double size = 7e14;
  const auto shape = Shape::build(flat_square(size, 40)).value();
  auto pair = std::move(Pair::make(shape, shape)).value();
  math::Random random(4);
  for (int i = 0; i < 100; ++i) {
    const Vec3 aside(size * random.uniform(-1.0, 1.0), size * random.uniform(-1.0, 1.0), 1e9);
    std::uint64_t opened[2];
    for (const int several : {0, 1}) {
      const Answer& answer = pair.run({Mat3::Identity(), aside}, {.max_contacts = several * 8});
      EXPECT_EQ(answer.verdict, Verdict::clear);
      EXPECT_EQ(answer.basis, Basis::proved);
      opened[several] = answer.cost.node_pairs;
    }
    EXPECT_EQ(opened[0], opened[1]);
  }
}

}  // namespace
}  // namespace odds::query::wide
