// The odds of pairs of nodes: numbers whatever the nodes, and true on meshes that they were not fitted on.
#include "query/node_odds/node_odds.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <variant>
#include <vector>

#include "odds/math/random.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"
#include "query/node_odds/node_odds_table.hpp"
#include "query/posed_meshes.hpp"
#include "query/search/encounter.hpp"
#include "support/node_sample.hpp"

namespace odds::query {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr float no_number = std::numeric_limits<float>::quiet_NaN();

TEST(NodeOdds, AreLikelierTheGreaterTheRateAndTheDeeperTheSlabs) {
  NodeNumbers numbers{{1.0F, -2.0F, -0.5F, 0.2F, 10.0F, 0.0F, 0.5F}};
  for (std::size_t kind = 0; kind < node_weights.size(); ++kind) {
    for (const std::size_t what : {1U, 3U}) {
      NodeNumbers more = numbers;
      more.x[what] += 0.5F;
      EXPECT_GT(log_odds(more, node_weights[kind]), log_odds(numbers, node_weights[kind])) << kind << " " << what;
    }
  }
}

TEST(NodeOdds, OfHullsAreLessWhereTheSurfacesFaceTheSameWay) {
  const NodeWeights& weights = node_weights[static_cast<std::size_t>(volume::Kind::hull)];
  tree::NodeStatistics a;
  a.mean_normal = Vec3f(0, 0, 0.9F);
  a.height = 3;
  tree::NodeStatistics b = a;
  const Vec3f place(0, 0, 0.1F);
  const auto odds = [&](const tree::NodeStatistics& other) {
    return log_odds(numbers_of({a, other, Mat3f::Identity(), 1.0, 1.0, 0.2}, {place, 1.0F, 1.0F}), weights);
  };
  const float one_behind_the_other = odds(b);
  b.mean_normal = Vec3f(0, 0, -0.9F);
  EXPECT_LT(one_behind_the_other, odds(b) - 0.5F);
}

TEST(NodeOdds, HaveFurtherNumbersWhereTheyAreAskedFor) {
  tree::NodeStatistics a;
  a.mean_normal = Vec3f(0, 0, 0.9F);
  a.height = 3;
  const Vec3f place(0, 0, 0.1F);
  const NodesMet met{a, a, Mat3f::Identity(), 1.0, 1.0, 0.2};
  const NodeNumbers all = numbers_of(met, {place, 1.0F, 1.0F});
  const NodeNumbers usual = numbers_of(met, {place, 1.0F, 1.0F}, NodeNumbers::usual);
  for (std::size_t i = 0; i < NodeNumbers::count; ++i) {
    EXPECT_EQ(usual.x[i], i < NodeNumbers::usual ? all.x[i] : 0.0F) << i;
  }
  EXPECT_NEAR(all.x[7], std::log2(0.2F), 0.1F);
  EXPECT_FLOAT_EQ(all.x[8], 1.0F);
  EXPECT_FLOAT_EQ(all.x[9], 3.6F);
  EXPECT_FLOAT_EQ(all.x[10], 0.81F);
  EXPECT_FLOAT_EQ(all.x[11], 6.0F * 0.81F);
}

TEST(NodeOdds, AreProbabilitiesAndKeepTheirOrder) {
  float last = -1.0F;
  float last_rate = -infinite;
  for (float z = -30.0F; z <= 30.0F; z += 0.25F) {
    const float p = probability_of_log_odds(z);
    EXPECT_NEAR(p, 1.0 / (1.0 + std::exp(-static_cast<double>(z))), 1e-5) << z;
    EXPECT_GE(p, last);
    EXPECT_LE(p, 1.0F);
    EXPECT_GT(log_rate_of_log_odds(z), last_rate);
    last = p;
    last_rate = log_rate_of_log_odds(z);
  }
  EXPECT_EQ(log_odds({{1.0F, no_number, 0, 0, 0, 0, 0}}, node_weights[0]), 0.0F);
  EXPECT_EQ(log_odds({{1.0F, infinite, 0, 0, 0, 0, 0}}, node_weights[0]), 0.0F);
}

TEST(NodeOdds, AreNumbersWhateverTheNodes) {
  const float strange[] = {0.0F, 1e-30F, 1e30F, -1.0F, infinite, no_number};
  for (const float s : strange) {
    for (const double volume : {0.0, 1e-300, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
      tree::NodeStatistics a;
      a.centroid = Vec3f(s, 0, 0);
      a.slab_half = s;
      a.log_relative_area = s;
      a.log_volume = s;
      tree::NodeStatistics b;
      b.mean_normal = Vec3f(0, s, 0);
      const Vec3f place(s, 0, 0);
      const NodeNumbers numbers = numbers_of({a, b, Mat3f::Identity(), volume, volume, volume}, {place, s, 0.0F});
      for (const NodeWeights& weights : node_weights) {
        const float p = probability_of_log_odds(log_odds(numbers, weights));
        EXPECT_TRUE(p >= 0.0F && p <= 1.0F) << s << " " << volume << " " << p;
      }
    }
  }
}

struct Told {
  double stated = 0.0;  ///< mean probability
  double met = 0.0;     ///< share
  double separation = 0.5;
};

/// How far B, which comes from that side, is when it first touches A, to 1e-4 of the size.
double first_touch(Pair& pair, const Mat3& turned, const Vec3& way) {
  double apart = 2.0 * pair.a().mesh().size();
  double touching = 0.0;
  const auto meets = [&](double at) { return pair.run({turned, way * at}, {}).verdict == Verdict::hit; };
  while (!meets(apart * 0.98) && apart > 0.02 * pair.a().mesh().size()) apart *= 0.98;
  touching = apart * 0.98;
  for (int i = 0; i < 10; ++i) (meets(0.5 * (touching + apart)) ? touching : apart) = 0.5 * (touching + apart);
  return touching;
}

/// Over pairs of nodes of two copies of a mesh about their first touch.
Told told_of(const std::string& name, volume::Kind kind) {
  const auto mesh = std::make_shared<const mesh::TriangleMesh>(mesh::made::make_shape(name).value());
  const auto shape = Shape::build(mesh, {.volume = kind}).value();
  auto pair = std::move(Pair::make(shape, shape)).value();
  std::vector<double> of_those_that_meet;
  std::vector<double> of_the_others;
  HitList hits{8};
  math::Random random(0x0DD5, 3);
  for (std::uint64_t i = 0; i < 40; ++i) {
    const Vec3 way = random.direction();
    const Mat3 turned = random.rotation().toRotationMatrix();
    constexpr double offsets[] = {-0.1, -0.01, -0.001, 0.001, 0.01};
    const double place = first_touch(pair, turned, way) + offsets[i % 5] * mesh->size();
    const math::Pose pose{turned, way * place};
    std::visit(
        [&](const auto& tree) {
          using Tree = std::remove_cvref_t<decltype(tree)>;
          if constexpr (!std::is_same_v<Tree, tree::WideTree>) {
            const Request request;
            const PosedMeshes meshes(*mesh, *mesh, tree.origin(), tree.origin(), pose);
            const Encounter met(tree, tree, meshes.pose(), request);
            for (const NodePair& nodes : testing::sample_nodes(met, 48, i)) {
              auto& those = testing::meet_below(met, nodes, hits) ? of_those_that_meet : of_the_others;
              those.push_back(static_cast<double>(met.probability(nodes.a, nodes.b)));
            }
          }
        },
        shape->data().tree);
  }
  Told told;
  const auto count = static_cast<double>(of_those_that_meet.size() + of_the_others.size());
  double won = 0.0;
  for (const double p : of_those_that_meet) {
    told.stated += p / count;
    told.met += 1.0 / count;
    for (const double q : of_the_others) won += p > q ? 1.0 : p == q ? 0.5 : 0.0;
  }
  for (const double q : of_the_others) told.stated += q / count;
  told.separation = won / static_cast<double>(of_those_that_meet.size() * of_the_others.size());
  return told;
}

class NodeOddsOf : public ::testing::TestWithParam<volume::Kind> {};

TEST_P(NodeOddsOf, MeanWhatTheySayOnMeshesThatTheyWereNotFittedOn) {
  struct Held {
    const char* name;
    double within;
    double separation;
  };
  // The gear's long triangles fill their nodes in ways that the others' do not.
  for (const auto& [name, within, separation] :
       {Held{"made:torus:around=90,across=40,ring=0.05,tube=0.02", 0.06, 0.8},
        Held{"made:bumpy_sphere:frequency=24,seed=11", 0.06, 0.8}, Held{"made:gear:teeth=13,flank=9", 0.2, 0.6}}) {
    const Told told = told_of(name, GetParam());
    std::printf("  %s: stated %.3f, met %.3f, separation %.3f\n", name, told.stated, told.met, told.separation);
    EXPECT_GT(told.met, 0.02) << name;
    EXPECT_NEAR(told.stated, told.met, within) << name;
    EXPECT_GT(told.separation, separation) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Volumes, NodeOddsOf,
                         ::testing::Values(volume::Kind::aabb, volume::Kind::obb, volume::Kind::sphere,
                                           volume::Kind::kdop14, volume::Kind::kdop18, volume::Kind::kdop26,
                                           volume::Kind::hull),
                         [](const auto& kind) { return std::string(volume::name(kind.param)); });

}  // namespace
}  // namespace odds::query
