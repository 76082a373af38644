// Hard cases of triangle against triangle, each in all 72 orders of corners and triangles, and at several scales.
#include "odds/primitive/triangle_triangle.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/triangles.hpp"

namespace {

using odds::Mat3;
using odds::Vec3;
using odds::primitive::intersection_segment;
using odds::primitive::IntersectionSegment;
using odds::test::all_orders;
using odds::test::Corners;
using odds::test::orders_that_meet;

struct Case {
  const char* name;
  Corners a;
  Corners b;
  bool meet;
};

const Corners base = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};

const std::vector<Case> cases = {
    {"crosses through the face", base, {Vec3(1, 1, -1), Vec3(1, 1, 1), Vec3(3, 3, 5)}, true},
    {"crosses the plane beside the face", base, {Vec3(5, 5, -1), Vec3(5, 5, 1), Vec3(9, 9, 5)}, false},
    {"plane crossed, intervals apart", base, {Vec3(2.5, 2.5, -1), Vec3(2.5, 2.5, 1), Vec3(6, 6, 0.5)}, false},
    {"both edges cross both faces", base, {Vec3(1, -1, -1), Vec3(1, -1, 1), Vec3(1, 9, 0)}, true},
    {"above", base, {Vec3(0, 0, 1), Vec3(4, 0, 1), Vec3(0, 4, 2)}, false},

    {"vertex on vertex", base, {Vec3(0, 0, 0), Vec3(-1, -1, 3), Vec3(-2, 1, 3)}, true},
    {"vertex on vertex, one plane", base, {Vec3(0, 0, 0), Vec3(-1, 0, 0), Vec3(0, -1, 0)}, true},
    {"vertex on edge", base, {Vec3(2, 0, 0), Vec3(2, -1, 3), Vec3(1, -1, 3)}, true},
    {"vertex on edge, one plane", base, {Vec3(2, 0, 0), Vec3(1, -1, 0), Vec3(3, -1, 0)}, true},
    {"vertex on face", base, {Vec3(1, 1, 0), Vec3(1, 1, 2), Vec3(2, 2, 2)}, true},
    {"vertex in the plane beside the face", base, {Vec3(3, 3, 0), Vec3(3, 3, 2), Vec3(2, 2, 2)}, false},
    {"vertex on the longest edge", base, {Vec3(2, 2, 0), Vec3(5, 5, 2), Vec3(5, 5, -2)}, true},
    {"vertex just off the longest edge",
     base,
     {Vec3(std::nextafter(2.0, 3.0), 2, 0), Vec3(5, 5, 2), Vec3(5, 5, -2)},
     false},
    {"vertex just on the face", base, {Vec3(std::nextafter(2.0, 1.0), 2, 0), Vec3(5, 5, 2), Vec3(5, 5, -2)}, true},
    {"smallest gap above a vertex", base, {Vec3(1, 1, 0x1p-1074), Vec3(1, 1, 2), Vec3(2, 2, 2)}, false},

    {"edges cross", base, {Vec3(2, 0, -1), Vec3(2, 0, 1), Vec3(2, -5, 0)}, true},
    {"edges share a stretch", base, {Vec3(1, 0, 0), Vec3(3, 0, 0), Vec3(2, -1, 3)}, true},
    {"edges on one line, apart", base, {Vec3(5, 0, 0), Vec3(7, 0, 0), Vec3(6, -1, 3)}, false},
    {"edges on one line, touching", base, {Vec3(4, 0, 0), Vec3(7, 0, 0), Vec3(6, -1, 3)}, true},
    {"equal edge, folded", base, {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 0, 4)}, true},
    {"edge lies in the face", base, {Vec3(1, 1, 0), Vec3(2, 1, 0), Vec3(1, 1, 5)}, true},
    {"edge lies in the plane, passes the corner", base, {Vec3(5, -1, 0), Vec3(5, 5, 0), Vec3(5, 1, 5)}, false},
    {"edge in the plane across the face", base, {Vec3(-1, 1, 0), Vec3(9, 1, 0), Vec3(1, 1, 5)}, true},
    {"edge in the plane touches a corner", base, {Vec3(4, -1, 0), Vec3(4, 9, 0), Vec3(4, 1, 5)}, true},

    {"one plane, equal", base, base, true},
    {"one plane, nested", base, {Vec3(1, 1, 0), Vec3(1.5, 1, 0), Vec3(1, 1.5, 0)}, true},
    {"one plane, overlap", base, {Vec3(1, 1, 0), Vec3(9, 1, 0), Vec3(1, 9, 0)}, true},
    {"one plane, star", base, {Vec3(3, 3, 0), Vec3(-1, 3, 0), Vec3(3, -1, 0)}, true},
    {"one plane, share an edge", base, {Vec3(4, 0, 0), Vec3(0, 4, 0), Vec3(4, 4, 0)}, true},
    {"one plane, apart", base, {Vec3(5, 5, 0), Vec3(6, 5, 0), Vec3(5, 6, 0)}, false},
    {"one plane, boxes overlap, apart", base, {Vec3(3, 3, 0), Vec3(3.5, 2, 0), Vec3(3.5, 3, 0)}, false},
    {"parallel planes", base, {Vec3(0, 0, 1), Vec3(4, 0, 1), Vec3(0, 4, 1)}, false},
    {"one tilted plane, overlap",
     {Vec3(0, 0, 0), Vec3(4, 0, 4), Vec3(0, 4, 8)},
     {Vec3(1, 1, 3), Vec3(5, 1, 7), Vec3(1, 5, 11)},
     true},
    {"one tilted plane, apart",
     {Vec3(0, 0, 0), Vec3(4, 0, 4), Vec3(0, 4, 8)},
     {Vec3(5, 1, 7), Vec3(5, 3, 11), Vec3(7, 1, 9)},
     false},

    {"segment through the face", base, {Vec3(1, 1, -1), Vec3(1, 1, 1), Vec3(1, 1, 0.5)}, true},
    {"segment ends on the face", base, {Vec3(1, 1, 1), Vec3(1, 1, 0), Vec3(1, 1, 0)}, true},
    {"segment ends above the face", base, {Vec3(1, 1, 1), Vec3(1, 1, 2), Vec3(1, 1, 3)}, false},
    {"segment through the plane beside the face", base, {Vec3(3, 3, -1), Vec3(3, 3, 1), Vec3(3, 3, 0)}, false},
    {"segment in the face", base, {Vec3(1, 1, 0), Vec3(2, 1, 0), Vec3(1.5, 1, 0)}, true},
    {"segment in the plane, apart", base, {Vec3(3, 3, 0), Vec3(4, 4, 0), Vec3(5, 5, 0)}, false},
    {"segment in the plane, touches an edge", base, {Vec3(2, 2, 0), Vec3(4, 4, 0), Vec3(3, 3, 0)}, true},
    {"segment along the line of an edge, apart", base, {Vec3(5, 0, 0), Vec3(6, 0, 0), Vec3(9, 0, 0)}, false},
    {"segment through an edge", base, {Vec3(2, 0, -1), Vec3(2, 0, 0.5), Vec3(2, 0, 1)}, true},
    {"point on the face", base, {Vec3(1, 1, 0), Vec3(1, 1, 0), Vec3(1, 1, 0)}, true},
    {"point on an edge", base, {Vec3(2, 2, 0), Vec3(2, 2, 0), Vec3(2, 2, 0)}, true},
    {"point on a corner", base, {Vec3(4, 0, 0), Vec3(4, 0, 0), Vec3(4, 0, 0)}, true},
    {"point in the plane, apart", base, {Vec3(3, 3, 0), Vec3(3, 3, 0), Vec3(3, 3, 0)}, false},
    {"point above", base, {Vec3(1, 1, 1), Vec3(1, 1, 1), Vec3(1, 1, 1)}, false},
    {"segments cross",
     {Vec3(0, 0, 0), Vec3(4, 4, 4), Vec3(2, 2, 2)},
     {Vec3(0, 4, 2), Vec3(4, 0, 2), Vec3(1, 3, 2)},
     true},
    {"segments pass",
     {Vec3(0, 0, 0), Vec3(4, 4, 4), Vec3(2, 2, 2)},
     {Vec3(0, 4, 3), Vec3(4, 0, 3), Vec3(1, 3, 3)},
     false},
    {"segments parallel",
     {Vec3(0, 0, 0), Vec3(4, 4, 4), Vec3(2, 2, 2)},
     {Vec3(1, 0, 0), Vec3(5, 4, 4), Vec3(3, 2, 2)},
     false},
    {"segments on one line, overlap",
     {Vec3(0, 0, 0), Vec3(4, 4, 4), Vec3(2, 2, 2)},
     {Vec3(3, 3, 3), Vec3(5, 5, 5), Vec3(6, 6, 6)},
     true},
    {"segments on one line, touch",
     {Vec3(0, 0, 0), Vec3(4, 4, 4), Vec3(2, 2, 2)},
     {Vec3(4, 4, 4), Vec3(5, 5, 5), Vec3(6, 6, 6)},
     true},
    {"segments on one line, apart",
     {Vec3(0, 0, 0), Vec3(4, 4, 4), Vec3(2, 2, 2)},
     {Vec3(5, 5, 5), Vec3(7, 7, 7), Vec3(6, 6, 6)},
     false},
    {"segments in one plane, apart",
     {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(2, 0, 0)},
     {Vec3(1, 1, 0), Vec3(2, 5, 0), Vec3(1, 1, 0)},
     false},
    {"segment and point on it",
     {Vec3(0, 0, 0), Vec3(4, 4, 4), Vec3(2, 2, 2)},
     {Vec3(3, 3, 3), Vec3(3, 3, 3), Vec3(3, 3, 3)},
     true},
    {"segment and point on its line",
     {Vec3(0, 0, 0), Vec3(4, 4, 4), Vec3(2, 2, 2)},
     {Vec3(5, 5, 5), Vec3(5, 5, 5), Vec3(5, 5, 5)},
     false},
    {"segment and point in its box",
     {Vec3(0, 0, 0), Vec3(4, 4, 4), Vec3(2, 2, 2)},
     {Vec3(1, 2, 3), Vec3(1, 2, 3), Vec3(1, 2, 3)},
     false},
    {"equal points",
     {Vec3(1, 2, 3), Vec3(1, 2, 3), Vec3(1, 2, 3)},
     {Vec3(1, 2, 3), Vec3(1, 2, 3), Vec3(1, 2, 3)},
     true},
    {"different points",
     {Vec3(1, 2, 3), Vec3(1, 2, 3), Vec3(1, 2, 3)},
     {Vec3(1, 2, 3.5), Vec3(1, 2, 3.5), Vec3(1, 2, 3.5)},
     false},
    {"zeros of both signs", {Vec3(0, 0, 0), Vec3(-0.0, 0, -0.0), Vec3(0, -0.0, 0)}, base, true},

    {"nearly parallel, apart", base, {Vec3(0, 0, 0x1p-50), Vec3(4, 0, 0x1p-49), Vec3(0, 4, 0x1p-50)}, false},
    {"nearly parallel, crossing", base, {Vec3(0, 0, -0x1p-50), Vec3(4, 0, 0x1p-49), Vec3(0, 4, 0x1p-50)}, true},
    {"nearly parallel, crossing beside", base, {Vec3(0, 5, -0x1p-50), Vec3(4, 5, 0x1p-49), Vec3(0, 9, 0x1p-50)}, false},
    {"sliver through the face", base, {Vec3(1, 1, -1), Vec3(1 + 0x1p-50, 1, 1), Vec3(1, 1 + 0x1p-51, 0.5)}, true},
    {"sliver beside the longest edge",
     base,
     {Vec3(2, 2 + 0x1p-50, -1), Vec3(2 + 0x1p-50, 2, 1), Vec3(2, 2 + 0x1p-51, 0.5)},
     false},
    {"needles that pass",
     {Vec3(-1e6, 0, 0), Vec3(1e6, 0, 0), Vec3(0, 1e-9, 0)},
     {Vec3(0, -1e6, 1e-9), Vec3(0, 1e6, 1e-9), Vec3(1e-9, 0, 2e-9)},
     false},
    {"needles that meet",
     {Vec3(-1e6, 0, 0), Vec3(1e6, 0, 0), Vec3(0, 1e-9, 0)},
     {Vec3(0, -1e6, -1e-9), Vec3(0, 1e6, 1e-9), Vec3(1e-9, 0, 2e-9)},
     true},
};

Corners moved(const Corners& t, double scale, const Vec3& offset) {
  return {scale * t[0] + offset, scale * t[1] + offset, scale * t[2] + offset};
}

TEST(TriangleTriangleHard, EveryCaseInEveryOrder) {
  for (const Case& c : cases) {
    EXPECT_EQ(orders_that_meet(c.a, c.b), c.meet ? all_orders : 0) << c.name;
  }
}

TEST(TriangleTriangleHard, ReflectedAndWithAxesExchanged) {
  for (const Case& c : cases) {
    for (int axis = 0; axis < 3; ++axis) {
      Mat3 turn = Mat3::Zero();
      for (int i = 0; i < 3; ++i) turn((i + axis) % 3, i) = i == 1 ? -1.0 : 1.0;
      const Corners a = {turn * c.a[0], turn * c.a[1], turn * c.a[2]};
      const Corners b = {turn * c.b[0], turn * c.b[1], turn * c.b[2]};
      EXPECT_EQ(orders_that_meet(a, b), c.meet ? all_orders : 0) << c.name << " axis " << axis;
    }
  }
}

TEST(TriangleTriangleHard, AtEverySize) {
  for (const Case& c : cases) {
    // Powers of two change no digit.
    for (const double scale : {0x1p-30, 0x1p-10, 0x1p40, 0x1p200, 0x1p900}) {
      const Corners a = moved(c.a, scale, Vec3::Zero());
      const Corners b = moved(c.b, scale, Vec3::Zero());
      if (moved(a, 1.0 / scale, Vec3::Zero()) != c.a || moved(b, 1.0 / scale, Vec3::Zero()) != c.b)
        continue;  // underflow
      EXPECT_EQ(orders_that_meet(a, b), c.meet ? all_orders : 0) << c.name << " times " << scale;
    }
  }
}

TEST(TriangleTriangleHard, MillimetresFarFromTheOrigin) {
  // 2^-10 m features at 1e9 m: the sums are exact for the cases made of small whole and half numbers.
  const Vec3 offset(1e9, -1e9, 0.5e9);
  int tried = 0;
  for (const Case& c : cases) {
    const double scale = 0x1p-10;
    const Corners a = moved(c.a, scale, offset);
    const Corners b = moved(c.b, scale, offset);
    bool exact = true;
    for (std::size_t i = 0; i < 3; ++i) {
      exact = exact && (a[i] - offset) / scale == c.a[i] && (b[i] - offset) / scale == c.b[i];
    }
    if (!exact) continue;
    ++tried;
    EXPECT_EQ(orders_that_meet(a, b), c.meet ? all_orders : 0) << c.name;
  }
  EXPECT_GT(tried, 50);
}

TEST(TriangleTriangleHard, SegmentIsFiniteAndInBothBoxesWheneverTheyMeet) {
  for (const Case& c : cases) {
    for (const double scale : {1e-300, 1e-9, 1.0, 1e15, 1e300}) {
      const Corners a = moved(c.a, scale, Vec3::Zero());
      const Corners b = moved(c.b, scale, Vec3::Zero());
      IntersectionSegment segment{Vec3(7, 7, 7), Vec3(7, 7, 7)};
      const bool meet = intersection_segment(a.data(), b.data(), segment);
      ASSERT_EQ(meet, odds::primitive::triangles_intersect(a.data(), b.data())) << c.name << " times " << scale;
      if (!meet) {
        EXPECT_EQ(segment.begin, Vec3(7, 7, 7));
        continue;
      }
      for (const Vec3& end : {segment.begin, segment.end}) {
        ASSERT_TRUE(end.allFinite()) << c.name;
        for (const Corners* t : {&a, &b}) {
          EXPECT_TRUE((end.array() >= (*t)[0].cwiseMin((*t)[1]).cwiseMin((*t)[2]).array()).all()) << c.name;
          EXPECT_TRUE((end.array() <= (*t)[0].cwiseMax((*t)[1]).cwiseMax((*t)[2]).array()).all()) << c.name;
        }
      }
    }
  }
}

void expect_segment(const Corners& a, const Corners& b, const Vec3& p, const Vec3& q) {
  IntersectionSegment s;
  ASSERT_TRUE(intersection_segment(a.data(), b.data(), s));
  const double straight = std::max((s.begin - p).norm(), (s.end - q).norm());
  const double reversed = std::max((s.begin - q).norm(), (s.end - p).norm());
  EXPECT_LT(std::min(straight, reversed), 1e-14) << s.begin.transpose() << " to " << s.end.transpose();
}

TEST(TriangleTriangleHard, SegmentsKnownByHand) {
  expect_segment(base, {Vec3(1, -1, -1), Vec3(1, -1, 1), Vec3(1, 9, 0)}, Vec3(1, 0, 0), Vec3(1, 3, 0));
  expect_segment(base, {Vec3(1, 1, -1), Vec3(1, 1, 1), Vec3(1, 2, 1)}, Vec3(1, 1, 0), Vec3(1, 1.5, 0));
  expect_segment(base, {Vec3(1, 1, 0), Vec3(1, 1, 2), Vec3(2, 2, 2)}, Vec3(1, 1, 0), Vec3(1, 1, 0));
  expect_segment(base, {Vec3(1, 0, 0), Vec3(3, 0, 0), Vec3(2, -1, 3)}, Vec3(1, 0, 0), Vec3(3, 0, 0));
  expect_segment(base, {Vec3(-1, 1, 0), Vec3(9, 1, 0), Vec3(1, 1, 5)}, Vec3(0, 1, 0), Vec3(3, 1, 0));
  expect_segment(base, base, Vec3(4, 0, 0), Vec3(0, 4, 0));
  expect_segment(base, {Vec3(3, 3, 0), Vec3(-1, 3, 0), Vec3(3, -1, 0)}, Vec3(3, 0, 0), Vec3(0, 3, 0));
  expect_segment(base, {Vec3(0, 0, 0), Vec3(-1, 0, 0), Vec3(0, -1, 0)}, Vec3(0, 0, 0), Vec3(0, 0, 0));
  expect_segment(base, {Vec3(1, 1, -1), Vec3(1, 1, 1), Vec3(1, 1, 0.5)}, Vec3(1, 1, 0), Vec3(1, 1, 0));
}

}  // namespace
