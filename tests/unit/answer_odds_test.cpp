// Odds of answers without a proof.
#include "query/answer_odds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "odds/query/pair.hpp"
#include "query/answer_odds_table.hpp"
#include "query/recalibration.hpp"
#include "support/all_kinds.hpp"
#include "support/shapes.hpp"

namespace odds::query {
namespace {

TEST(AnswerOdds, EveryTableAscendsWithinZeroAndOne) {
  for (const AnswerOdds& odds : answer_odds) {
    const auto seen = std::span(odds.seen).first(odds.pieces + 1);
    EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
    EXPECT_GE(seen.front(), 0.0F);
    EXPECT_LE(seen.back(), 1.0F);
    EXPECT_LT(seen.front(), seen.back());  // fitted at all
  }
}

TEST(AnswerOdds, EveryTableIsOfTheFormThatItsVolumeHas) {
  for (const volume::Kind kind : testing::all_kinds()) {
    for (const EstimatorKind estimator : {EstimatorKind::kinematic, EstimatorKind::cells}) {
      for (const Method method : {Method::time_critical, Method::exact}) {
        const AnswerOdds& odds = answer_odds[odds_index(kind, estimator, method)];
        EXPECT_EQ(odds.pieces, pieces_of(kind)) << volume::name(kind);
        if (counts_thin(kind, method)) continue;
        EXPECT_EQ(odds.weights[10], 0.0F) << volume::name(kind);
        EXPECT_EQ(odds.weights[11], 0.0F) << volume::name(kind);
      }
    }
  }
}

TEST(AnswerOdds, TheRegressionIsTheLogisticFunction) {
  AnswerOdds odds;
  odds.weights = {0.5F, -0.25F, 0.125F, 0.0F, 0.0F, 2.0F, 0.0F, 0.0F, 0.0F, -1.0F, 0.5F, 0.25F};
  Remains remains{3.0F, 6.0F, 1.0F, -2.0F, 0.5F, -4.0F};
  const double z = 0.5 - 0.25 * 6.0 + 0.125 * 3.0 + 0.5 * -4.0 + 2.0 * 0.5 - 1.0 * 0.5 * -2.0 + 0.25 * 0.5 * -4.0;
  EXPECT_NEAR(static_cast<double>(regression(odds, remains)), 1.0 / (1.0 + std::exp(-z)), 1e-6);
  odds.weights[0] = -400.0F;
  EXPECT_EQ(regression(odds, remains), 0.0F);
  odds.weights[0] = 400.0F;
  EXPECT_EQ(regression(odds, remains), 1.0F);
}

TEST(AnswerOdds, TheBendRunsThroughItsKnots) {
  for (const std::size_t pieces : {10U, 20U}) {
    AnswerOdds odds;
    odds.pieces = pieces;
    const auto n = static_cast<double>(pieces);
    for (std::size_t k = 0; k <= pieces; ++k) odds.seen[k] = static_cast<float>(static_cast<double>(k * k) / (n * n));
    for (const double p : {0.0001, 0.2, 0.35, 0.9999}) {
      odds.weights[0] = static_cast<float>(std::log(p / (1.0 - p)));
      const double low = std::floor(n * p);
      const double expected = (low * low + (n * p - low) * (2.0 * low + 1.0)) / (n * n);
      EXPECT_NEAR(probability_of_hit(odds, {}), expected, 1e-5) << p << " " << pieces;
    }
    odds.weights[0] = 400.0F;
    EXPECT_EQ(probability_of_hit(odds, {}), 1.0) << pieces;
  }
}

/// Of all else equal, what overlaps as deeply for its thickness is likelier to meet where that is little.
TEST(AnswerOdds, OfTheWideEngineKnowHowThinSurfacesAre) {
  for (const EstimatorKind estimator : {EstimatorKind::cells, EstimatorKind::kinematic}) {
    const AnswerOdds& one_hit = answer_odds[odds_index(volume::Kind::wide, estimator, Method::time_critical)];
    const AnswerOdds& several = answer_odds[odds_index(volume::Kind::wide, estimator, Method::exact)];
    const Remains thick{5.0F, 9.0F, 0.0F, 0.0F, 0.0F, -4.0F};
    Remains thin = thick;
    thin.thin = -10.0F;
    EXPECT_GT(probability_of_hit(one_hit, thin), probability_of_hit(one_hit, thick) + 0.01);
    EXPECT_EQ(probability_of_hit(several, thin), probability_of_hit(several, thick));
  }
}

TEST(Recalibration, AsMadeItChangesNothingAndKeepsTheOrder) {
  EXPECT_EQ(Recalibration{}(0.3), 0.3);
  EXPECT_EQ(Recalibration{}(0.0), 0.0);
  const Recalibration learnt{0.7, -0.4};
  double last = 0.0;
  for (const double p : {0.0, 1e-12, 0.1, 0.5, 0.9, 1.0}) {
    EXPECT_GE(learnt(p), last);
    EXPECT_LT(learnt(p), 1.0);
    last = learnt(p);
  }
  EXPECT_NEAR(learnt(0.5), 1.0 / (1.0 + std::exp(0.4)), 1e-12);
}

TEST(Recalibration, IsRefusedOutOfRangeAndTheSameEachTime) {
  const auto shape = Shape::build(testing::wavy_sphere(40)).value();
  PairOptions options;
  options.calibration_poses = 2'000'000;
  EXPECT_FALSE(Pair::make(shape, shape, options).ok());
  options.calibration_poses = 48;
  Pair one = Pair::make(shape, shape, options).value();
  Pair two = Pair::make(shape, shape, options).value();
  const math::Pose pose{Mat3::Identity(), {1.6, 0.8, 0.3}};
  const Request request{.budget = Budget::work(64)};
  EXPECT_EQ(one.run(pose, request).probability, two.run(pose, request).probability);
  Pair general = Pair::make(shape, shape).value();
  EXPECT_NE(one.run(pose, request).probability, general.run(pose, request).probability);
}

}  // namespace
}  // namespace odds::query
