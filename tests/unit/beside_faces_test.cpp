// The search beside known faces: it passes over what meets between them, and nothing else.
#include "query/wide/beside_faces.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <utility>

#include "odds/math/random.hpp"
#include "query/shape_data.hpp"
#include "query/wide/exact.hpp"
#include "support/shapes.hpp"

namespace odds::query::wide {
namespace {

using Hits = std::set<std::pair<std::uint32_t, std::uint32_t>>;

constexpr std::uint32_t all = 1U << 16U;

/// A layer of the given thickness through a place of A, as both trees see it.
KnownFaces::Layer layer_through(const Vec3& place, const Vec3& normal, double half, const math::Pose& pose) {
  const Vec3 in_b = pose.rotation.transpose() * normal;
  KnownFaces::Layer layer{};
  for (int i = 0; i < 3; ++i) {
    layer.normal[0][i] = static_cast<float>(normal[i]);
    layer.normal[1][i] = static_cast<float>(in_b[i]);
  }
  layer.offset[0] = static_cast<float>(normal.dot(place));
  layer.offset[1] = static_cast<float>(normal.dot(place) - normal.dot(pose.translation));
  layer.half = static_cast<float>(half);
  return layer;
}

KnownFaces with_half(KnownFaces::Layer layer, double change) {
  KnownFaces faces;
  layer.half += static_cast<float>(change);
  faces.add(layer);
  return faces;
}

Hits hits_of(const Task& task) {
  Hits hits;
  for (const TrianglePair& pair : task.hits.pairs()) hits.emplace(pair.a, pair.b);
  return hits;
}

TEST(BesideFaces, FindsAllThatMeetsOutsideOfALayer) {
  const std::shared_ptr<const Shape> shape = Shape::build(odds::testing::wavy_sphere(16)).value();
  const tree::WideTree& tree = *std::get_if<tree::WideTree>(&shape->data().tree);
  const Request request{.budget = Budget::work(1U << 30U)};
  const double rounding = 1e-5 * shape->mesh().size();
  std::size_t passed_over = 0;
  std::size_t found_beside = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    math::Random random(seed);
    const math::Pose pose{random.rotation().toRotationMatrix(), random.direction() * random.uniform(0.5, 1.9)};
    const PosedMeshes meshes(shape->mesh(), shape->mesh(), tree.origin(), tree.origin(), pose);
    const Encounter met(tree, tree, meshes, request.estimator);
    const auto layer =
        layer_through(0.5 * meshes.pose().translation, random.direction(), random.uniform(0.02, 0.5), meshes.pose());
    const auto search = [&](auto run) {
      HitList hits{all};
      Spending spending(request.budget);
      SearchResult result;
      Task task{met, request, all, nullptr, hits, spending, result};
      spending.begin_start(1.0, 1.0);
      run(task);
      EXPECT_EQ(result.ended, Progressed::finished);
      return hits_of(task);
    };
    const KnownFaces faces = with_half(layer, 0.0);
    const Hits beside = search([&](Task& task) { BesideFaces<lanes::Portable>::run(task, faces); });
    const Hits anywhere = search([](Task& task) { Exact<lanes::Portable>::run_from_roots(task); });
    for (const Searches* searches : {searches_for(InstructionSet::avx2), searches_for(InstructionSet::best)}) {
      if (searches == nullptr) continue;
      EXPECT_EQ(search([&](Task& task) { searches->beside_faces(task, faces); }), beside) << searches->instruction_set;
    }
    const KnownFaces wider = with_half(layer, rounding);
    const KnownFaces narrower = with_half(layer, -rounding);
    for (const auto& [a, b] : anywhere) {
      const auto corners_a = meshes.corners_a(a);
      const auto corners_b = meshes.corners_b(b);
      EXPECT_TRUE(wider.include(corners_a, corners_b) || beside.contains({a, b})) << seed;
      EXPECT_FALSE(narrower.include(corners_a, corners_b) && beside.contains({a, b})) << seed;
    }
    for (const auto& hit : beside) EXPECT_TRUE(anywhere.contains(hit)) << "it does not meet";
    found_beside += beside.size();
    passed_over += anywhere.size() - beside.size();
  }
  EXPECT_GT(passed_over, 1000U);
  EXPECT_GT(found_beside, 1000U);
}

TEST(BesideFaces, WithoutABudgetSaysThatItDoesNotKnow) {
  const std::shared_ptr<const Shape> shape = Shape::build(odds::testing::wavy_sphere(16)).value();
  const tree::WideTree& tree = *std::get_if<tree::WideTree>(&shape->data().tree);
  const Request request{.budget = Budget::work(8)};
  const PosedMeshes meshes(shape->mesh(), shape->mesh(), tree.origin(), tree.origin(), {Mat3::Identity(), {1, 0, 0}});
  const Encounter met(tree, tree, meshes, request.estimator);
  HitList hits{8};
  Spending spending(request.budget);
  SearchResult result;
  Task task{met, request, 8, nullptr, hits, spending, result};
  spending.begin_start(1.0, 1.0);
  BesideFaces<lanes::Portable>::run(task, KnownFaces());
  EXPECT_EQ(result.ended, Progressed::spent);
  EXPECT_TRUE(hits.empty());
  EXPECT_LE(spending.so_far().node_pairs, 8U);
}

}  // namespace
}  // namespace odds::query::wide
