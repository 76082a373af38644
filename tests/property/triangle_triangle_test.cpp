// What must hold for every pair of triangles: order, exact scaling and shifting, segments, distances, boxes.
#include "odds/primitive/triangle_triangle.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "odds/math/random.hpp"
#include "odds/primitive/triangle_box.hpp"
#include "odds/primitive/triangle_distance.hpp"
#include "support/triangles.hpp"

namespace {

using odds::Mat3;
using odds::Quat;
using odds::Vec3;
using odds::primitive::closest_point_on_triangle;
using odds::primitive::closest_points;
using odds::primitive::closest_points_segment_triangle;
using odds::primitive::ClosestPoints;
using odds::primitive::intersection_segment;
using odds::primitive::IntersectionSegment;
using odds::primitive::triangle_may_overlap_box;
using odds::primitive::triangles_intersect;
using odds::test::all_orders;
using odds::test::Corners;
using odds::test::orders_that_meet;

// Seeded by rapidcheck: grid points (many degenerate cases), general points, and slivers.
class Draw {
 public:
  Draw() : random_(*rc::gen::arbitrary<std::uint32_t>()), kind_(*rc::gen::inRange(0, 4)) {}
  double real() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }
  double grid(int reach) { return std::uniform_int_distribution<int>(-reach, reach)(random_); }
  Vec3 point() {
    switch (kind_) {
      case 0:
        return Vec3(grid(2), grid(2), grid(2));
      case 1:
        return Vec3(grid(1), grid(2), 0);
      case 2:
        return Vec3(real(), real(), 1e-10 * real());
      default:
        return Vec3(real(), real(), real());
    }
  }
  Corners triangle() { return {point(), point(), point()}; }

 private:
  std::mt19937 random_;
  int kind_;
};

Corners mapped(const Corners& t, double scale, const Vec3& shift) {
  return {scale * t[0] + shift, scale * t[1] + shift, scale * t[2] + shift};
}

double size_of(const Corners& a, const Corners& b) {
  double size = 0.0;
  for (const Corners* t : {&a, &b}) {
    for (const Vec3& p : *t) size = std::max(size, (p - a[0]).norm());
  }
  return size;
}

TEST(TriangleTriangleProperty, OrderOfCornersAndTrianglesDoesNotMatter) {
  EXPECT_TRUE(rc::check("72 orders, one answer", [] {
    Draw draw;
    for (int i = 0; i < 10; ++i) {
      const Corners a = draw.triangle();
      const Corners b = draw.triangle();
      const int meeting = orders_that_meet(a, b);
      if (meeting != 0 && meeting != all_orders) RC_FAIL(odds::test::text_of(a, b));
    }
  }));
}

TEST(TriangleTriangleProperty, ExactScalingAndShiftingDoNotMatter) {
  EXPECT_TRUE(rc::check("powers of two, grid offsets", [] {
    Draw draw;
    for (int i = 0; i < 20; ++i) {
      const Corners a = draw.triangle();
      const Corners b = draw.triangle();
      const bool meet = triangles_intersect(a.data(), b.data());
      for (const double scale : {0x1p-700, 0x1p-31, 0x1p3, 0x1p333, 0x1p1000}) {
        const Corners p = mapped(a, scale, Vec3::Zero());
        const Corners q = mapped(b, scale, Vec3::Zero());
        RC_ASSERT(triangles_intersect(p.data(), q.data()) == meet);
      }
      for (const Vec3& shift : {Vec3(0x1p40, -0x1p45, 0x1p30), Vec3(3, -5, 1e9)}) {
        const Corners p = mapped(a, 1.0, shift);
        const Corners q = mapped(b, 1.0, shift);
        if (mapped(p, 1.0, -shift) != a || mapped(q, 1.0, -shift) != b) continue;  // the shift was not exact
        RC_ASSERT(triangles_intersect(p.data(), q.data()) == meet);
      }
    }
  }));
}

TEST(TriangleTriangleProperty, SegmentLiesOnBothTriangles) {
  EXPECT_TRUE(rc::check("ends are near both", [] {
    Draw draw;
    for (int i = 0; i < 50; ++i) {
      const Corners a = draw.triangle();
      const Corners b = draw.triangle();
      IntersectionSegment s;
      const bool meet = intersection_segment(a.data(), b.data(), s);
      RC_ASSERT(meet == triangles_intersect(a.data(), b.data()));
      if (!meet) continue;
      for (const Vec3& end : {s.begin, s.end}) {
        RC_ASSERT(end.allFinite());
        // Slivers 1e-10 high fix their common line only to rounding over their height.
        const double room = 1e-4 * size_of(a, b);
        RC_ASSERT((closest_point_on_triangle(end, a.data()) - end).norm() <= room);
        RC_ASSERT((closest_point_on_triangle(end, b.data()) - end).norm() <= room);
      }
    }
  }));
}

/// Whether the planes of two triangles are all but parallel: which of their points are nearest is a matter of rounding.
bool nearly_parallel(const Corners& a, const Corners& b) {
  const auto normal = [](const Corners& t) -> Vec3 { return (t[1] - t[0]).cross(t[2] - t[0]).stableNormalized(); };
  return normal(a).cross(normal(b)).norm() < 1e-6;
}

// Two convex sets: p, q are closest if and only if no corner of a lies beyond p towards q, nor of b beyond q towards p.
bool certified(const Corners& a, const Corners& b, const ClosestPoints& c, double size) {
  const Vec3 gap = c.on_b - c.on_a;
  const double room = (nearly_parallel(a, b) ? 1e-11 : 1e-13) * size * (gap.norm() + 0.1 * size);
  bool good = std::fabs(gap.norm() - std::sqrt(c.squared_distance)) <= 1e-14 * size;
  for (const Vec3& p : a) good = good && (p - c.on_a).dot(gap) <= room;
  for (const Vec3& p : b) good = good && (c.on_b - p).dot(gap) <= room;
  good = good && (closest_point_on_triangle(c.on_a, a.data()) - c.on_a).norm() <= 1e-13 * size;
  return good && (closest_point_on_triangle(c.on_b, b.data()) - c.on_b).norm() <= 1e-13 * size;
}

TEST(TriangleDistanceProperty, PointsAreClosestAndZeroMeansMeeting) {
  EXPECT_TRUE(rc::check("optimality of closest points", [] {
    Draw draw;
    for (int i = 0; i < 50; ++i) {
      const Corners a = draw.triangle();
      const Corners b = mapped(draw.triangle(), 1.0, Vec3(0, 0, std::floor(2.0 * draw.real())));
      const ClosestPoints c = closest_points(a.data(), b.data());
      const bool meet = triangles_intersect(a.data(), b.data());
      RC_ASSERT((c.squared_distance == 0.0) == meet);
      if (meet) {
        RC_ASSERT(c.on_a == c.on_b);
      } else if (!certified(a, b, c, size_of(a, b))) {
        RC_FAIL(odds::test::text_of(a, b));
      }
      const Corners flat = {b[0], b[1], b[1]};
      const ClosestPoints s = closest_points_segment_triangle(b[0], b[1], a.data());
      RC_ASSERT((s.squared_distance == 0.0) == triangles_intersect(flat.data(), a.data()));
      if (s.squared_distance > 0.0) RC_ASSERT(certified(flat, a, s, size_of(a, flat)));
      if (s.squared_distance == 0.0) {
        RC_ASSERT(s.on_a == s.on_b);
        // On both, but for rounding.
        const double off = (closest_point_on_triangle(s.on_a, a.data()) - s.on_a).norm();
        RC_ASSERT(off <= 1e-11 * size_of(a, flat));
        RC_ASSERT((closest_point_on_triangle(s.on_a, flat.data()) - s.on_a).norm() <= 1e-11 * size_of(a, flat));
      }
      RC_ASSERT(c.squared_distance <= s.squared_distance * (1.0 + 1e-9) + 1e-28);
    }
  }));
}

// Found at random: planes parallel to within 3e-10, 2 apart, and another corner is nearer by 1.4e-12.
TEST(TriangleDistanceProperty, OfNearlyParallelTrianglesIsRightToTwelveDigits) {
  const Corners a = {Vec3{0x1.b6f45fb44d998p-3, 0x1.da2246ebe0edap-1, -0x1.6158fa8966c52p-34},
                     Vec3{0x1.1e855156cd04p-3, -0x1.c03d5fa98b0cp-4, 0x1.7fc58311138b9p-39},
                     Vec3{-0x1.7d697e9755c02p-1, 0x1.78fdb6035c4p-5, -0x1.7d2e3b36a45p-36}};
  const Corners b = {Vec3{0x1.634a8c00a60fp-4, -0x1.99d358f60b228p-4, -0x1.ffffffffd1858p+0},
                     Vec3{-0x1.3ca73f74fb04p-4, 0x1.b277f121f682p-2, -0x1.000000002a54cp+1},
                     Vec3{0x1.c11dcaebecd8p-6, -0x1.0696fb3f26a1p-1, -0x1.ffffffffac03ap+0}};
  const ClosestPoints points = closest_points(a.data(), b.data());
  ASSERT_TRUE(nearly_parallel(a, b));
  EXPECT_TRUE(certified(a, b, points, size_of(a, b)));
  EXPECT_NEAR(std::sqrt(points.squared_distance), 2.0, 1e-9);
}

// Two points that are so far apart, and no farther, are known; the nearest are no farther apart than they.
TEST(TriangleDistanceProperty, OfSliversAndAlongEdgesIsRightToFourteenDigits) {
  odds::math::Random random(4);
  const auto exponent = [&random](double least) { return std::pow(10.0, random.uniform(least, 0.0)); };
  double worst = 0.0;
  for (int i = 0; i < 40000; ++i) {
    const Mat3 turn = random.rotation().toRotationMatrix();
    const double gap = exponent(-12.0);
    Corners a = {Vec3(-0.5, 0.0, 0.0), Vec3(0.5, 0.0, 0.0), Vec3(i % 4 == 0 ? 0.5 : random.uniform(-0.4, 0.4), 1, 0)};
    Corners b;
    Vec3 on_a;
    Vec3 on_b;
    if (i % 2 == 0) {  // a corner above a needle or a flat triangle
      a[2].y() = exponent(-12.0);
      on_a = 0.3 * a[0] + 0.3 * a[1] + 0.4 * a[2];
      on_b = on_a + gap * Vec3::UnitZ();
      b = {on_b, on_b + Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0, 1)),
           on_b + Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0, 1))};
    } else {  // edges that cross at a small angle
      const double angle = exponent(-14.0);
      const Vec3 along(0.5 * std::cos(angle), 0.5 * std::sin(angle), 0.0);
      on_a = {random.uniform(-0.4, 0.4), 0.0, 0.0};
      on_b = on_a + gap * Vec3::UnitZ();
      a[2].z() = -random.uniform(0, 1);
      b = {on_b - along, on_b + along, on_b + Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0, 1))};
    }
    for (Vec3& corner : a) corner = turn * corner;
    for (Vec3& corner : b) corner = turn * corner;
    const ClosestPoints points = closest_points(a.data(), b.data());
    worst = std::max(worst, std::sqrt(points.squared_distance) - (turn * on_b - turn * on_a).norm());
  }
  EXPECT_LT(worst, 1e-14);
}

TEST(TriangleDistanceProperty, HoldsAtExtremeSizesWithoutNaN) {
  EXPECT_TRUE(rc::check("scaled", [] {
    Draw draw;
    const Corners a = draw.triangle();
    const Corners b = mapped(draw.triangle(), 1.0, Vec3(0, 0, 3));
    const ClosestPoints here = closest_points(a.data(), b.data());
    for (const double scale : {0x1p-900, 0x1p-200, 0x1p200, 0x1p900}) {
      const Corners p = mapped(a, scale, Vec3::Zero());
      const Corners q = mapped(b, scale, Vec3::Zero());
      const ClosestPoints there = closest_points(p.data(), q.data());
      RC_ASSERT(!std::isnan(there.squared_distance));
      RC_ASSERT((there.on_a / scale - here.on_a).norm() <= 1e-12);
      RC_ASSERT((there.on_b / scale - here.on_b).norm() <= 1e-12);
    }
  }));
}

TEST(TriangleDistanceProperty, KnownByHand) {
  const Corners t = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};
  const auto closest = [&t](double x, double y, double z) {
    return closest_point_on_triangle(Vec3(x, y, z), t.data());
  };
  EXPECT_EQ(closest(1, 1, 5), Vec3(1, 1, 0));
  EXPECT_EQ(closest(-1, -2, 5), Vec3(0, 0, 0));
  EXPECT_EQ(closest(2, -2, 5), Vec3(2, 0, 0));
  EXPECT_EQ(closest(3, 3, -1), Vec3(2, 2, 0));
  EXPECT_EQ(closest(9, -1, 0), Vec3(4, 0, 0));
  const Corners edge_on = {Vec3(1, 1, 2), Vec3(1, 1, 5), Vec3(2, 1, 5)};
  EXPECT_EQ(closest_points(t.data(), edge_on.data()).squared_distance, 4.0);
  const Corners crossing_edges = {Vec3(2, -1, 1), Vec3(2, 5, -7), Vec3(9, 9, 9)};
  EXPECT_EQ(triangles_intersect(t.data(), crossing_edges.data()), true);
  const Corners point = {Vec3(1, 1, 3), Vec3(1, 1, 3), Vec3(1, 1, 3)};
  EXPECT_EQ(closest_points(point.data(), t.data()).squared_distance, 9.0);
}

// The 12 triangles of a box, and whether a triangle meets the solid box: exact on grid coordinates.
bool meets_box(const Corners& t, const Vec3& center, const Vec3& half) {
  for (const Vec3& p : t) {
    if (((p - center).cwiseAbs().array() <= half.array()).all()) return true;
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Vec3 corner[4];
      for (int k = 0; k < 4; ++k) {
        corner[k][axis] = side;
        corner[k][(axis + 1) % 3] = (k & 1) != 0 ? 1.0 : -1.0;
        corner[k][(axis + 2) % 3] = (k & 2) != 0 ? 1.0 : -1.0;
        corner[k] = center + corner[k].cwiseProduct(half);
      }
      const Corners lower = {corner[0], corner[1], corner[2]};
      const Corners upper = {corner[1], corner[3], corner[2]};
      if (triangles_intersect(t.data(), lower.data()) || triangles_intersect(t.data(), upper.data())) return true;
    }
  }
  return false;
}

TEST(TriangleBoxProperty, AgreesOnTheGridWithTheBoxMadeOfTriangles) {
  EXPECT_TRUE(rc::check("axis-aligned boxes on the grid, also flat ones", [] {
    std::mt19937 random(*rc::gen::arbitrary<std::uint32_t>());
    const auto draw = [&](int low, int high) {
      return static_cast<double>(std::uniform_int_distribution<int>(low, high)(random));
    };
    for (int i = 0; i < 50; ++i) {
      Corners t;
      for (Vec3& p : t) p = Vec3(draw(-4, 4), draw(-4, 4), draw(-4, 4));
      const Vec3 center(draw(-2, 2), draw(-2, 2), draw(-2, 2));
      const Vec3 half(draw(0, 2), draw(0, 2), draw(0, 2));
      const bool may = triangle_may_overlap_box(t.data(), center, Mat3::Identity(), half);
      if (may != meets_box(t, center, half)) RC_FAIL(odds::test::text_of(t, {center, half, half}));
    }
  }));
}

TEST(TriangleBoxProperty, NeverSaysApartWhenAPointIsShared) {
  EXPECT_TRUE(rc::check("a triangle through a point on the turned box's surface", [] {
    Draw draw;
    const Mat3 axes = Quat(draw.real(), draw.real(), draw.real(), 1.5).normalized().toRotationMatrix();
    const Vec3 center(0.1, -0.2, 0.05);
    const Vec3 half(0.5 + std::fabs(draw.real()), std::fabs(draw.real()), *rc::gen::element(0.0, 1e-9, 1.0));
    for (int i = 0; i < 50; ++i) {
      Vec3 local = Vec3(draw.real(), draw.real(), draw.real()).cwiseProduct(half);
      const int axis = i % 3;
      local[axis] = half[axis];
      const Vec3 shared = center + axes * local;
      Vec3 outward = axes.col(axis);
      const Vec3 along = axes.col((axis + 1) % 3);
      // Touches the face from outside in a corner, or in an edge.
      const Corners t = {shared, shared + outward + along, shared + (i % 2 == 0 ? outward : along)};
      RC_ASSERT(triangle_may_overlap_box(t.data(), center, axes, half));
      const Vec3 off = 1e-6 * outward;
      const Corners lifted = {t[0] + off, t[1] + off, t[2] + off};
      RC_ASSERT(!triangle_may_overlap_box(lifted.data(), center, axes, half));
    }
  }));
}

}  // namespace
