// Well-filled cells: analytic surfaces, conservation of area, frames, degenerate boxes, and a brute-force comparison.
#include "odds/tree/well_filled_cells.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace {

using odds::Mat3;
using odds::Quat;
using odds::Vec3;
using odds::tree::CellCounter;
using odds::tree::kCellsPerAxis;

using Triangle = std::array<Vec3, 3>;

double area_of(const Triangle& t) { return 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm(); }

// Parallelogram origin, origin + u, origin + u + v, origin + v.
void add_sheet(CellCounter& cells, const Vec3& origin, const Vec3& u, const Vec3& v) {
  cells.add(origin, origin + u, origin + u + v);
  cells.add(origin, origin + u + v, origin + v);
}

std::vector<Triangle> random_triangles(std::uint32_t seed, int count, double reach, double size) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Triangle> triangles;
  for (int i = 0; i < count; ++i) {
    const Vec3 middle = reach * Vec3(unit(random), unit(random), unit(random));
    Triangle t;
    for (Vec3& corner : t) corner = middle + size * Vec3(unit(random), unit(random), unit(random));
    triangles.push_back(t);
  }
  return triangles;
}

TEST(WellFilledCells, MaxSectionAreaIsTheDiagonalSectionThroughTheLongestEdges) {
  EXPECT_DOUBLE_EQ(odds::tree::max_section_area(Vec3(1, 1, 1)), std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(odds::tree::max_section_area(Vec3(3, 12, 4)), 60.0);
  EXPECT_DOUBLE_EQ(odds::tree::max_section_area(Vec3(4, 3, 0)), 12.0);
}

TEST(WellFilledCells, PlaneThroughTheMiddleOfALayerFillsItsCellsEvenly) {
  CellCounter cells;
  cells.begin(Vec3(1, 2, 3), Mat3::Identity(), Vec3(4, 4, 4));  // cells of side 1
  add_sheet(cells, Vec3(-3, -2, 3.5), Vec3(8, 0, 0), Vec3(0, 8, 0));
  for (int x = 0; x < kCellsPerAxis; ++x) {
    for (int y = 0; y < kCellsPerAxis; ++y) {
      for (int z = 0; z < kCellsPerAxis; ++z) EXPECT_NEAR(cells.area(x, y, z), z == 4 ? 1.0 : 0.0, 1e-12);
    }
  }
  EXPECT_EQ(cells.count(0.5), 64);
  EXPECT_EQ(cells.count(1.0 / std::sqrt(2.0)), 64);
  EXPECT_EQ(cells.count(0.71), 0);
}

TEST(WellFilledCells, DiagonalSectionFillsItsCellsExactly) {
  const Mat3 axes = Quat(0.3, -0.5, 0.7, 0.2).normalized().toRotationMatrix();
  const Vec3 center(10, -20, 30);
  const Vec3 half(4, 2, 1);  // cells 1 x 0.5 x 0.25; the section through the x edges crosses one rod per layer
  CellCounter cells;
  cells.begin(center, axes, half);
  add_sheet(cells, center + axes * Vec3(-4, -2, -1), axes * Vec3(8, 0, 0), axes * Vec3(0, 4, 2));
  EXPECT_NEAR(cells.max_area(), std::hypot(0.5, 0.25), 1e-15);
  EXPECT_EQ(cells.count(1.0), 64);
  EXPECT_EQ(cells.count(1.001), 0);
  for (int x = 0; x < kCellsPerAxis; ++x) EXPECT_NEAR(cells.area(x, 3, 3), cells.max_area(), 1e-12);
}

TEST(WellFilledCells, TiltedPlaneMatchesTheIntegralOverEachCell) {
  // z = x / 8 + 1 / 16 over cells of side 1: every column keeps the slope's full area.
  CellCounter cells;
  cells.begin(Vec3(4, 4, 4), Mat3::Identity(), Vec3(4, 4, 4));
  add_sheet(cells, Vec3(0, 0, 0.0625), Vec3(8, 0, 1), Vec3(0, 8, 0));
  const double column = std::sqrt(1.0 + 1.0 / 64.0);
  for (int y = 0; y < kCellsPerAxis; ++y) {
    for (int x = 0; x < 7; ++x) EXPECT_NEAR(cells.area(x, y, 0), column, 1e-12) << x;
    EXPECT_NEAR(cells.area(7, y, 0), 0.5 * column, 1e-12);  // z reaches 1 at x = 7.5
    EXPECT_NEAR(cells.area(7, y, 1), 0.5 * column, 1e-12);
  }
}

TEST(WellFilledCells, AreaIsConservedInsideAndOutsideTheBox) {
  for (const double size : {1e-3, 0.1, 1.0, 30.0}) {
    CellCounter cells;
    cells.begin(Vec3(0.1, -0.2, 0.3), Quat(0.9, 0.1, 0.3, -0.2).normalized().toRotationMatrix(), Vec3(1, 0.5, 0.01));
    double expected = 0.0;
    for (const Triangle& t : random_triangles(7, 2000, 1.0, size)) {
      cells.add(t[0], t[1], t[2]);
      expected += area_of(t);
    }
    EXPECT_NEAR(cells.total_area(), expected, 1e-11 * expected) << size;
  }
}

TEST(WellFilledCells, RotatingBoxAndSurfaceTogetherChangesNothing) {
  const Mat3 turn = Quat(0.2, 0.4, -0.7, 0.5).normalized().toRotationMatrix();
  const Vec3 shift(5, -7, 2);
  const Vec3 half(1.0, 0.7, 0.4);
  CellCounter here;
  CellCounter there;
  here.begin(Vec3::Zero(), Mat3::Identity(), half);
  there.begin(shift, turn, half);
  for (const Triangle& t : random_triangles(3, 500, 0.5, 0.3)) {
    here.add(t[0], t[1], t[2]);
    there.add(turn * t[0] + shift, turn * t[1] + shift, turn * t[2] + shift);
  }
  for (int i = 0; i < 512; ++i) {
    const double expected = here.area(i / 64, i / 8 % 8, i % 8);
    EXPECT_NEAR(there.area(i / 64, i / 8 % 8, i % 8), expected, 1e-12 + 1e-11 * expected);
  }
  EXPECT_EQ(here.count(0.5), there.count(0.5));
}

TEST(WellFilledCells, OrderOfCornersAndSubdivisionDoNotMatter) {
  CellCounter whole;
  CellCounter parts;
  whole.begin(Vec3::Zero(), Mat3::Identity(), Vec3(1, 1, 1));
  parts.begin(Vec3::Zero(), Mat3::Identity(), Vec3(1, 1, 1));
  for (const Triangle& t : random_triangles(11, 200, 0.5, 0.5)) {
    whole.add(t[0], t[1], t[2]);
    const Vec3 middle = 0.2 * t[0] + 0.3 * t[1] + 0.5 * t[2];
    parts.add(middle, t[1], t[0]);
    parts.add(t[2], t[1], middle);
    parts.add(t[0], t[2], middle);
  }
  for (int i = 0; i < 512; ++i) {
    EXPECT_NEAR(parts.area(i / 64, i / 8 % 8, i % 8), whole.area(i / 64, i / 8 % 8, i % 8), 1e-11);
  }
}

TEST(WellFilledCells, AgreesWithSamplingOfTheSurface) {
  const Mat3 axes = Quat(0.6, 0.1, -0.2, 0.5).normalized().toRotationMatrix();
  const Vec3 half(1.0, 0.6, 0.8);
  CellCounter cells;
  cells.begin(Vec3(0.1, 0.1, 0.1), axes, half);
  std::array<double, 512> sampled{};
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (const Triangle& t : random_triangles(19, 20, 0.4, 0.6)) {
    cells.add(t[0], t[1], t[2]);
    constexpr int kSamples = 20000;
    for (int i = 0; i < kSamples; ++i) {
      const double r = std::sqrt(unit(random));
      const double s = unit(random);
      const Vec3 p = (1.0 - r) * t[0] + r * (1.0 - s) * t[1] + r * s * t[2];
      const Vec3 local = axes.transpose() * (p - Vec3(0.1, 0.1, 0.1));
      int index = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const double cell = std::floor(4.0 * (local[axis] / half[axis] + 1.0));
        index = index * 8 + static_cast<int>(std::min(7.0, std::max(0.0, cell)));
      }
      sampled[static_cast<std::size_t>(index)] += area_of(t) / kSamples;
    }
  }
  double difference = 0.0;
  for (int i = 0; i < 512; ++i) {
    difference += std::fabs(sampled[static_cast<std::size_t>(i)] - cells.area(i / 64, i / 8 % 8, i % 8));
  }
  EXPECT_LT(difference, 0.04 * cells.total_area());
}

// What is left of a convex polygon on one side of a plane: sign * (x_axis - offset) <= 0.
std::vector<Vec3> cut(const std::vector<Vec3>& polygon, int axis, double sign, double offset) {
  std::vector<Vec3> left;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3& p = polygon[i];
    const Vec3& q = polygon[(i + 1) % polygon.size()];
    const double height_p = sign * (p[axis] - offset);
    const double height_q = sign * (q[axis] - offset);
    if (height_p <= 0.0) left.push_back(p);
    if ((height_p < 0.0) != (height_q < 0.0)) left.push_back(p + height_p / (height_p - height_q) * (q - p));
  }
  return left;
}

double area_in_cell(const Triangle& t, const Vec3& lower, const Vec3& sides) {
  std::vector<Vec3> polygon(t.begin(), t.end());
  for (int axis = 0; axis < 3; ++axis) {
    polygon = cut(polygon, axis, -1.0, lower[axis]);
    polygon = cut(polygon, axis, 1.0, lower[axis] + sides[axis]);
  }
  Vec3 twice = Vec3::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    twice += (polygon[i - 1] - polygon[0]).cross(polygon[i] - polygon[0]);
  }
  return 0.5 * twice.norm();
}

TEST(WellFilledCells, AgreesWithClippingToEveryCellByItself) {
  const Vec3 half(1.0, 0.3, 0.05);
  const Vec3 sides = half / 4.0;
  for (const double size : {0.02, 0.1, 0.4, 0.9}) {
    for (Triangle t : random_triangles(23, 40, 1.0 - size, size)) {
      for (Vec3& corner : t) corner = corner.cwiseProduct(half);
      if (size > 0.5) t[2][2] = t[1][2] = t[0][2];  // along a layer
      CellCounter cells;
      cells.begin(Vec3::Zero(), Mat3::Identity(), half);
      cells.add(t[0], t[1], t[2]);
      for (int i = 0; i < 512; ++i) {
        const Vec3 lower = Vec3(i / 64, i / 8 % 8, i % 8).cwiseProduct(sides) - half;
        EXPECT_NEAR(cells.area(i / 64, i / 8 % 8, i % 8), area_in_cell(t, lower, sides), 1e-13) << i;
      }
    }
  }
}

TEST(WellFilledCells, CornersAndEdgesOnBordersOfCellsLoseNoArea) {
  std::mt19937 random(29);
  std::uniform_int_distribution<int> coordinate(0, 8);
  for (int i = 0; i < 3000; ++i) {
    Triangle t;
    for (Vec3& corner : t) corner = Vec3(coordinate(random), coordinate(random), coordinate(random));
    CellCounter cells;
    cells.begin(Vec3(4, 4, 4), Mat3::Identity(), Vec3(4, 4, 4));
    cells.add(t[0], t[1], t[2]);
    EXPECT_NEAR(cells.total_area(), area_of(t), 1e-12);
  }
}

TEST(WellFilledCells, TriangleFarBeyondATinyBoxDoesNoHarm) {
  CellCounter cells;
  cells.begin(Vec3::Zero(), Mat3::Identity(), Vec3::Constant(1e-300));
  cells.add(Vec3(1e15, 0, 0), Vec3(0, 1e15, 0), Vec3(0, 0, -1e15));
  EXPECT_EQ(cells.total_area(), 0.0);
  cells.begin(Vec3::Zero(), Mat3::Identity(), Vec3(1, 1, 1));
  cells.add(Vec3(-1, -1, 0.1), Vec3(1, -1, 0.1), Vec3(-1, 1, 0.1));
  EXPECT_NEAR(cells.total_area(), 2.0, 1e-12);
}

TEST(WellFilledCells, FlatBoxKeepsItsSurfaceInOneLayerDespiteRounding) {
  CellCounter cells;
  cells.begin(Vec3(0, 0, 1), Mat3::Identity(), Vec3(1, 1, 0));
  for (int x = 0; x < 8; ++x) {
    for (int y = 0; y < 8; ++y) {
      const double wobble = (x + y) % 2 == 0 ? 1e-7 : -1e-7;
      add_sheet(cells, Vec3(-1 + 0.25 * x, -1 + 0.25 * y, 1 + wobble), Vec3(0.25, 0, 0), Vec3(0, 0.25, 0));
    }
  }
  EXPECT_EQ(cells.count(0.99), 64);
  EXPECT_NEAR(cells.max_area(), 0.0625, 1e-8);
}

TEST(WellFilledCells, NothingIsFilledByPointsSegmentsOrNonFiniteCorners) {
  CellCounter cells;
  cells.begin(Vec3::Zero(), Mat3::Identity(), Vec3::Zero());
  cells.add(Vec3::Zero(), Vec3::Zero(), Vec3::Zero());
  EXPECT_EQ(cells.count(0.01), 0);
  cells.begin(Vec3::Zero(), Mat3::Identity(), Vec3(1, 1, 1));
  cells.add(Vec3(-1, -1, -1), Vec3::Zero(), Vec3(1, 1, 1));
  cells.add(Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0));
  cells.add(Vec3(std::numeric_limits<double>::infinity(), 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0));
  EXPECT_EQ(cells.total_area(), 0.0);
}

TEST(WellFilledCells, BeginForgetsTheNodeBefore) {
  CellCounter cells;
  cells.begin(Vec3::Zero(), Mat3::Identity(), Vec3(1, 1, 1));
  add_sheet(cells, Vec3(-1, -1, 0.1), Vec3(2, 0, 0), Vec3(0, 2, 0));
  EXPECT_EQ(cells.count(0.5), 64);
  cells.begin(Vec3::Zero(), Mat3::Identity(), Vec3(1, 1, 1));
  EXPECT_EQ(cells.count(0.5), 0);
}

}  // namespace
