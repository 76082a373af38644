// Odds of answers without a proof.
#include "query/answer_odds/answer_odds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "odds/query/pair.hpp"
#include "query/answer_odds/odds_for.hpp"
#include "query/memory/recalibration.hpp"
#include "support/all_kinds.hpp"
#include "support/shapes.hpp"

namespace odds::query {
namespace {

void expect_ascending_shares(const AnswerOdds& odds) {
  for (const auto& seen : {odds.seen, odds.seen_of_shells}) {
    EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
    EXPECT_GE(seen.front(), 0.0F);
    EXPECT_LE(seen.back(), 1.0F);
    EXPECT_GT(seen.back(), 0.0F);  // fitted at all
  }
  EXPECT_LT(odds.seen.front(), odds.seen.back());
}

TEST(AnswerOdds, EveryTableAscendsWithinZeroAndOne) {
  for (const AnswerOdds& odds : answer_odds) expect_ascending_shares(odds);
  for (const AnswerOdds& odds : polygon_free_odds) expect_ascending_shares(odds);
}

TEST(AnswerOdds, TheRegressionIsTheLogisticFunction) {
  AnswerOdds odds;
  odds.weights = {0.5F, 0.75F, -0.25F, 0.125F, 0.0F, 1.0F, 2.0F, 0.0F, 0.0F, 0.0F,
                  1.5F, -1.0F, 0.5F,   0.25F,  0.0F, 0.0F, 0.2F, 0.3F, -0.4F};
  Remains remains;
  remains.open = 3.0F;
  remains.spent = 6.0F;
  remains.tested = 4.0F;
  remains.logit = 1.0F;
  remains.rank = -2.0F;
  remains.facing = 0.25F;
  remains.thin = -4.0F;
  remains.small = -5.0F;
  const double apart =
      -0.25 * 6.0 + 2.0 * 3.0 + 1.5 * -2.0 + 0.5 * -4.0 + 0.1 * (0.2 * -2.0 * 3.0 + 0.3 * 6.0 * 6.0 - 0.4 * 6.0 * -5.0);
  const double of_shells = 0.75 + 0.125 * 6.0 + 1.0 * 4.0 - 1.0 * -2.0 + 0.25 * -4.0;
  odds.weights[AnswerOdds::straight] = 0.7F;                               // spent, from -1.2 of (spent - 7) / 2 on
  odds.weights[AnswerOdds::straight + AnswerOdds::again + 1] = -0.3F;      // open, from -0.4 of (open - 3) / 1.5 on
  odds.weights[AnswerOdds::straight + 3 * AnswerOdds::again + 3] = 10.0F;  // rank, from 1.2 of rank / 2 on: not yet
  const double again = 0.7 * (-0.5 + 1.2) - 0.3 * 0.4;
  const double z = 0.5 + 0.75 * (apart + again) + 0.25 * of_shells;
  EXPECT_NEAR(static_cast<double>(regression(odds, remains)), 1.0 / (1.0 + std::exp(-z)), 1e-6);
  odds.weights[0] = -400.0F;
  EXPECT_EQ(regression(odds, remains), 0.0F);
  odds.weights[0] = 400.0F;
  EXPECT_EQ(regression(odds, remains), 1.0F);
}

TEST(AnswerOdds, TheBendRunsThroughItsKnots) {
  constexpr std::size_t pieces = AnswerOdds::pieces;
  constexpr double n = pieces;
  AnswerOdds odds;
  for (std::size_t k = 0; k <= pieces; ++k) odds.seen[k] = static_cast<float>(static_cast<double>(k * k) / (n * n));
  for (const double p : {0.0001, 0.2, 0.35, 0.9999}) {
    odds.weights[0] = static_cast<float>(std::log(p / (1.0 - p)));
    const double low = std::floor(n * p);
    const double expected = (low * low + (n * p - low) * (2.0 * low + 1.0)) / (n * n);
    EXPECT_NEAR(probability_of_hit(odds, {}), expected, 1e-5) << p;
  }
  odds.weights[0] = 400.0F;
  EXPECT_EQ(probability_of_hit(odds, {}), 1.0);
}

TEST(AnswerOdds, ShellsHaveALineOfTheirOwn) {
  AnswerOdds odds;
  odds.seen.fill(0.8F);
  odds.seen_of_shells.fill(0.4F);
  Remains remains;
  for (const float facing : {0.0F, 0.25F, 1.0F}) {
    remains.facing = facing;
    EXPECT_NEAR(probability_of_hit(odds, remains), 0.8 - 0.4 * static_cast<double>(facing), 1e-6);
  }
}

TEST(AnswerOdds, NumbersOfShellsAreThoseThatVanishWhereNothingFacesTheSameWay) {
  Remains remains{3.0F, 6.0F, 4.0F, 1.0F, -2.0F, 0.0F, -4.0F, -5.0F};
  const auto apart = numbers_of(remains);
  remains.facing = 1.0F;
  const auto shells = numbers_of(remains);
  for (std::size_t i = 2; i < AnswerOdds::straight; ++i) {
    EXPECT_EQ(apart[i] == 0.0F, is_of_shells(i)) << i;
    EXPECT_EQ(shells[i] != 0.0F, is_of_shells(i)) << i;
  }
  for (std::size_t i = AnswerOdds::straight; i < AnswerOdds::count; ++i) {
    EXPECT_TRUE(counts_again(i));
    EXPECT_FALSE(is_of_shells(i));
    EXPECT_EQ(shells[i], 0.0F) << i;
  }
}

/// What a number says may change along its range, nowhere by a jump.
TEST(AnswerOdds, FiveNumbersCountAgainFromFourPlacesOn) {
  float Remains::*const numbers_again[AnswerOdds::again] = {&Remains::spent, &Remains::open, &Remains::logit,
                                                            &Remains::rank, &Remains::small};
  for (std::size_t n = 0; n < AnswerOdds::again; ++n) {
    Remains remains;
    std::size_t counted = 0;
    float last[AnswerOdds::places.size()] = {};
    for (float x = -16.0F; x < 16.0F; x += 0.125F) {
      remains.*numbers_again[n] = x;
      const auto numbers = numbers_of(remains);
      std::size_t now = 0;
      for (std::size_t place = 0; place < AnswerOdds::places.size(); ++place) {
        const float number = numbers[AnswerOdds::straight + place * AnswerOdds::again + n];
        now += number > 0.0F ? 1U : 0U;
        EXPECT_GE(number, last[place]);
        EXPECT_LE(number, last[place] + 0.125F / 1.5F + 1e-6F);  // the narrowest spread
        last[place] = number;
      }
      EXPECT_GE(now, counted);
      EXPECT_LE(now, counted + 1);
      counted = now;
    }
    EXPECT_EQ(counted, AnswerOdds::places.size()) << n;
  }
}

/// Of all else equal: a search in an order that does not look for hits has met none among so many.
TEST(AnswerOdds, SinkWithThePairsOfTrianglesThatWereLookedAtInVain) {
  for (const volume::Kind kind : testing::all_kinds()) {
    for (const EstimatorKind estimator : {EstimatorKind::cells, EstimatorKind::kinematic}) {
      const AnswerOdds& odds = answer_odds[odds_index(kind, estimator, Method::exact)];
      Remains few;
      few.open = 4.0F;
      few.spent = 8.0F;
      few.tested = 2.0F;
      few.rank = -2.0F;
      few.thin = -8.0F;
      few.small = -5.0F;
      Remains many = few;
      many.tested = 9.0F;
      EXPECT_LT(regression(odds, many), regression(odds, few) - 0.005F) << volume::name(kind);
    }
  }
}

/// Of all else equal, what overlaps as deeply for its thickness is likelier to meet where that is little.
TEST(AnswerOdds, OfTheWideEngineKnowHowThinSurfacesAre) {
  for (const EstimatorKind estimator : {EstimatorKind::cells, EstimatorKind::kinematic}) {
    const AnswerOdds& one_hit = answer_odds[odds_index(volume::Kind::wide, estimator, Method::time_critical)];
    Remains thick;
    thick.open = 5.0F;
    thick.spent = 9.0F;
    thick.thin = -4.0F;
    Remains thin = thick;
    thin.thin = -10.0F;
    EXPECT_GT(probability_of_hit(one_hit, thin), probability_of_hit(one_hit, thick) + 0.01);
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

TEST(Recalibration, HasNothingToLearnFromWithoutPolygons) {
  const auto shape = Shape::build(testing::wavy_sphere(10)).value();
  const auto without = shape->without_polygons();
  PairOptions options;
  EXPECT_TRUE(Pair::make(shape, without, options).ok());
  options.calibration_poses = 48;
  EXPECT_FALSE(Pair::make(shape, without, options).ok());
  EXPECT_FALSE(Pair::make(without, shape, options).ok());
  EXPECT_TRUE(Pair::make(shape, shape, options).ok());
}

// The wide engine's roots had a rank of their own where a threshold was set, whatever their overlap.
TEST(AnswerOdds, OfTheRootsAloneAreTheSameWithAndWithoutAThreshold) {
  for (const volume::Kind kind : {volume::Kind::wide, volume::Kind::aabb}) {
    ShapeOptions options;
    options.volume = kind;
    const auto shape = Shape::build(testing::wavy_sphere(24), options).value();
    Pair pair = Pair::make(shape, shape).value();
    for (const double x : {0.3, 1.0, 1.6, 1.9}) {
      const math::Pose pose{Eigen::AngleAxisd(x, Vec3::UnitZ()).toRotationMatrix(), {x, 0.1, 0.2}};
      Request request;
      request.max_contacts = 0;
      request.budget = Budget::work(kind == volume::Kind::wide ? 7 : 2);  // opens nothing
      const Answer without = pair.run(pose, request);
      ASSERT_EQ(without.basis, Basis::budget);
      request.p_min = 0.9999999;
      EXPECT_EQ(pair.run(pose, request).probability, without.probability) << x;
    }
  }
}

}  // namespace
}  // namespace odds::query
