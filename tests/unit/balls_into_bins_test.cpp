// Equations (4.15) and (4.16) against exact rational numbers, and the look-up table against the formulas.
#include "odds/probability/balls_into_bins.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "odds/probability/balls_table.hpp"
#include "support/big_natural.hpp"

namespace {

using odds::probability::BallsTable;
using odds::probability::CellCounts;
using odds::probability::cells_in_overlap;
using odds::probability::cells_of_overlap;
using odds::probability::collision_probability;
using odds::probability::probability_of_shared_cells;
using odds::probability::shared_cell_tails;
using odds::test::BigNatural;

// Pascal's triangle.
const BigNatural& choose(int n, int k) {
  static const auto rows = [] {
    std::vector<std::vector<BigNatural>> triangle;
    for (std::size_t i = 0; i <= 512; ++i) {
      triangle.emplace_back(i + 1, BigNatural(1));
      for (std::size_t j = 1; j < i; ++j) {
        triangle[i][j] = triangle[i - 1][j - 1];
        triangle[i][j] += triangle[i - 1][j];
      }
    }
    return triangle;
  }();
  return rows[static_cast<std::size_t>(n)][static_cast<std::size_t>(k)];
}

// (4.16) as it is written.
double exact_tail(int s, int a, int b, int x) {
  BigNatural favourable;
  for (int t = std::max({x, 0, a + b - s}); t <= std::min(a, b); ++t) {
    BigNatural term = choose(a, t) * choose(s - a, b - t);
    favourable += term;
  }
  return favourable == choose(s, b) ? 1.0 : ratio(favourable, choose(s, b));
}

::testing::AssertionResult right(int s, int a, int b, int x) {
  const double expected = exact_tail(s, a, b, x);
  const double got = probability_of_shared_cells(s, a, b, x);
  if (std::fabs(got - expected) <= 1e-12 * expected) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "s " << s << " a " << a << " b " << b << " x " << x << ": " << got
                                       << " instead of " << expected;
}

TEST(BallsIntoBins, Equation4_16MatchesExactRationalsOnAllSmallCounts) {
  for (int s = 1; s <= 14; ++s) {
    for (int a = 0; a <= s; ++a) {
      for (int b = 0; b <= s; ++b) {
        for (int x = -1; x <= s + 1; ++x) ASSERT_TRUE(right(s, a, b, x));
      }
    }
  }
}

TEST(BallsIntoBins, Equation4_16MatchesExactRationalsOverTheWholeDomain) {
  std::mt19937 random(416);
  const auto draw = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  for (int i = 0; i < 2500; ++i) {
    const int s = i % 3 == 0 ? draw(400, 512) : draw(1, 512);
    const int a = i % 2 == 0 ? draw(0, s) : draw(0, std::min(s, 40));
    const int b = i % 5 < 3 ? draw(0, s) : draw(0, std::min(s, 40));
    const int mean = a * b / s;
    for (const int x : {draw(0, 10), std::max(0, mean + draw(-8, 8)), draw(0, s), mean + 1}) {
      ASSERT_TRUE(right(s, a, b, x));
    }
  }
}

TEST(BallsIntoBins, Equation4_16AtTheCorners) {
  for (const int s : {1, 2, 10, 11, 255, 256, 511, 512}) {
    const int counts[] = {0, 1, 2, s / 2, (s + 1) / 2, s - 1, s};
    for (const int a : counts) {
      for (const int b : counts) {
        if (a > s || b > s) continue;
        for (const int x : {0, 1, 2, 9, 10, 11, a, b, a + b - s, a + b - s + 1}) ASSERT_TRUE(right(s, a, b, x));
      }
    }
  }
}

TEST(BallsIntoBins, CertaintiesAreExact) {
  EXPECT_EQ(probability_of_shared_cells(512, 300, 222, 10), 1.0);  // s_A + s_B = s + x
  EXPECT_LT(probability_of_shared_cells(20, 15, 14, 10), 1.0);
  EXPECT_EQ(probability_of_shared_cells(512, 4, 500, 5), 0.0);
  EXPECT_EQ(probability_of_shared_cells(512, 0, 512, 1), 0.0);
  EXPECT_EQ(probability_of_shared_cells(512, 10, 10, 0), 1.0);
  // The smallest of all probabilities keeps its digits: one in C(512, 256).
  EXPECT_NEAR(probability_of_shared_cells(512, 256, 256, 256) * ratio(choose(512, 256), BigNatural(1)), 1.0, 1e-12);
}

TEST(BallsIntoBins, CountsOutsideTheirRangesAreClamped) {
  EXPECT_EQ(probability_of_shared_cells(600, 5, 7, 1), probability_of_shared_cells(512, 5, 7, 1));
  EXPECT_EQ(probability_of_shared_cells(10, 50, 3, 2), probability_of_shared_cells(10, 10, 3, 2));
  EXPECT_EQ(probability_of_shared_cells(-4, 2, 2, 1), 1.0);
  EXPECT_EQ(probability_of_shared_cells(10, -3, 5, 1), 0.0);
}

TEST(BallsIntoBins, AllTailsTogetherEqualThoseOneByOne) {
  for (const int s : {1, 5, 20, 100, 333, 512}) {
    for (int a = 0; a <= s; a += 1 + s / 40) {
      for (int b = 0; b <= s; b += 1 + s / 37) {
        const auto tails = shared_cell_tails(s, a, b);
        for (int x = 0; x <= 10; ++x) {
          const double expected = probability_of_shared_cells(s, a, b, x);
          ASSERT_NEAR(tails.at_least[x], expected, 1e-12 * expected) << s << " " << a << " " << b << " " << x;
        }
      }
    }
  }
}

TEST(BallsIntoBins, FractionalCountsInterpolateAndNeverFall) {
  const CellCounts whole{100.0, 12.0, 9.0};
  EXPECT_EQ(probability_of_shared_cells(whole, 2), probability_of_shared_cells(100, 12, 9, 2));
  const CellCounts between{100.2, 12.25, 9.5};
  double expected = 0.0;
  for (const int a : {12, 13}) {
    for (const int b : {9, 10}) {
      expected += (a == 12 ? 0.75 : 0.25) * 0.5 * probability_of_shared_cells(100, a, b, 2);
    }
  }
  EXPECT_NEAR(probability_of_shared_cells(between, 2), expected, 1e-15);
  double last = 0.0;
  for (double a = 0.0; a <= 101.0; a += 0.01) {
    const double p = probability_of_shared_cells(CellCounts{100.0, a, 7.3}, 3);
    ASSERT_GE(p, last - 1e-15);
    ASSERT_LE(p, 1.0);
    last = p;
  }
  EXPECT_NEAR(last, probability_of_shared_cells(100, 100, 7, 3), 1e-12);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(probability_of_shared_cells(CellCounts{nan, nan, 3.0}, 1), 0.0);
}

TEST(BallsIntoBins, Equation4_15CountsCellsOfOneSize) {
  // A is the larger node: a quarter of it overlaps, and half of B, whose cells are half as large.
  const CellCounts counts = cells_in_overlap(80, 200, 2.0, 8.0, 4.0);
  EXPECT_DOUBLE_EQ(counts.cells, 128.0);
  EXPECT_DOUBLE_EQ(counts.filled_a, 80 * 2.0 / 8.0);
  EXPECT_DOUBLE_EQ(counts.filled_b, (200 * 2.0 / 4.0) * (4.0 / 8.0));
  EXPECT_DOUBLE_EQ(counts.filled_b, cells_in_overlap(200, 2.0, 8.0));
}

TEST(BallsIntoBins, Equation4_15IsClampedToAGrid) {
  EXPECT_EQ(cells_of_overlap(0.0, 1.0), 1.0);
  EXPECT_EQ(cells_of_overlap(1e-9, 1.0), 1.0);
  EXPECT_EQ(cells_of_overlap(3.0, 1.0), 512.0);
  EXPECT_EQ(cells_of_overlap(0.0, 0.0), 1.0);
  EXPECT_EQ(cells_in_overlap(600, 1.0, 1.0), 512.0);
  const CellCounts exaggerated = cells_in_overlap(100, 300, 50.0, 8.0, 4.0);
  EXPECT_DOUBLE_EQ(exaggerated.cells, 256.0);  // no more than all of the smaller node
  for (const double volume : {0.0, 1e-6, 0.3, 1.0, 7.0}) {
    const CellCounts counts = cells_in_overlap(512, 17, volume, 1.0, 1e-3);
    EXPECT_LE(counts.filled_a, counts.cells);
    EXPECT_LE(counts.filled_b, counts.cells);
  }
}

TEST(BallsIntoBins, CollisionProbabilityIsTheMaximumOverSharedCells) {
  for (const double bound : {0.0, 0.1, 0.5, 0.9, 1.0}) {
    for (const int a : {0, 1, 6, 30, 90}) {
      double expected = 0.0;
      for (int x = 1; x <= std::min(a, 10); ++x) {
        expected = std::max(expected, exact_tail(200, a, 40, x) * (1.0 - std::pow(1.0 - bound, x)));
      }
      EXPECT_NEAR(collision_probability(200, a, 40, bound), expected, 1e-12);
      EXPECT_NEAR(collision_probability(200, 40, a, bound), expected, 1e-12);
    }
  }
  EXPECT_EQ(odds::probability::collision_in_shared_cell(3, 5, 10, 6), 0.5);
  EXPECT_EQ(odds::probability::collision_in_shared_cell(0, 0, 0, 0), 1.0);
}

TEST(BallsTable, StaysWithinItsErrorAndSize) {
  const BallsTable& table = BallsTable::shared();
  EXPECT_GT(table.size_in_bytes(), 10u << 20);
  EXPECT_LT(table.size_in_bytes(), 30u << 20);
  RecordProperty("bytes", static_cast<int>(table.size_in_bytes()));
  double worst = 0.0;
  for (int s = 1; s <= 512; s += s < 40 ? 1 : 59) {
    for (int a = 0; a <= s; a += 1 + a / 20) {
      for (int b = 0; b <= s; b += 1 + b / 24) {
        for (int x = 0; x <= 10; ++x) {
          const double got = table.probability_of_shared_cells(s, a, b, x);
          worst = std::max(worst, std::fabs(got - probability_of_shared_cells(s, a, b, x)));
        }
      }
    }
  }
  EXPECT_LE(worst, BallsTable::max_error);
  EXPECT_GT(worst, 0.001);  // the sample does reach the steps
}

TEST(BallsTable, NeverFallsWithAnyCountAndIsSymmetric) {
  const BallsTable& table = BallsTable::shared();
  for (const int s : {1, 2, 9, 10, 11, 64, 300, 512}) {
    for (int x = 1; x <= 10; ++x) {
      for (int a = 0; a <= s; a += 1 + a / 12) {
        double last = 0.0;
        for (int b = 0; b <= s; ++b) {
          const double p = table.probability_of_shared_cells(s, a, b, x);
          ASSERT_GE(p, last) << s << " " << a << " " << b << " " << x;
          ASSERT_LE(p, 1.0);
          ASSERT_EQ(p, table.probability_of_shared_cells(s, b, a, x));
          last = p;
        }
      }
    }
  }
}

TEST(BallsTable, CornersAreExact) {
  const BallsTable& table = BallsTable::shared();
  for (const int s : {1, 7, 10, 100, 512}) {
    for (int x = 1; x <= 10; ++x) {
      EXPECT_EQ(table.probability_of_shared_cells(s, s, s, x), x <= s ? 1.0 : 0.0);
      EXPECT_EQ(table.probability_of_shared_cells(s, x - 1, s, x), 0.0);
      EXPECT_EQ(table.probability_of_shared_cells(s, x, s, x), x <= s ? 1.0 : 0.0) << s << " " << x;
      EXPECT_EQ(table.probability_of_shared_cells(s, 0, s, x), 0.0);
    }
  }
  EXPECT_EQ(table.probability_of_shared_cells(9999, 600, 600, 3), 1.0);
  EXPECT_EQ(table.probability_of_shared_cells(100, 5, 5, 0), 1.0);
}

TEST(BallsTable, GivesTheCollisionProbabilityToItsError) {
  const BallsTable& table = BallsTable::shared();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 5000; ++i) {
    const double s = 1.0 + 511.0 * unit(random);
    const CellCounts counts{s, s * unit(random) * unit(random), s * unit(random) * unit(random)};
    const double bound = unit(random);
    ASSERT_NEAR(table.collision_probability(counts, bound), collision_probability(counts, bound),
                BallsTable::max_error);
  }
}

TEST(BallsTable, IsReadByManyThreadsAtOnce) {
  std::vector<double> sums(4, 0.0);
  std::vector<std::thread> threads;
  for (double& sum : sums) {
    threads.emplace_back([&sum] {
      for (int b = 0; b <= 512; ++b) sum += BallsTable::shared().probability_of_shared_cells(512, 30, b, 3);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const double sum : sums) EXPECT_EQ(sum, sums[0]);
}

}  // namespace
