// Triangle against triangle, compared with CGAL's exact kernel on distributions that are rich in degenerate cases.
#include <array>
#include <cstdint>
#include <random>
#include <sstream>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/intersections.h>
#include <gtest/gtest.h>

#include "odds/primitive/triangle_triangle.hpp"

namespace {

using odds::Vec3;
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Point = Kernel::Point_3;
using Segment = Kernel::Segment_3;
using Triangle = Kernel::Triangle_3;
using Corners = std::array<Vec3, 3>;

Point exact(const Vec3& p) { return Point(p.x(), p.y(), p.z()); }

// CGAL asks for triangles with area; a degenerate one is handed over as the segment or point that it is.
struct ExactShape {
  std::array<Point, 3> p;
  int count;

  explicit ExactShape(const Corners& t) : p{exact(t[0]), exact(t[1]), exact(t[2])}, count(3) {
    if (!CGAL::collinear(p[0], p[1], p[2])) return;
    std::sort(p.begin(), p.end());
    p[1] = p[2];
    count = p[0] == p[1] ? 1 : 2;
  }
  [[nodiscard]] Triangle triangle() const { return Triangle(p[0], p[1], p[2]); }
  [[nodiscard]] Segment segment() const { return Segment(p[0], p[1]); }
};

bool meet_in_cgal(const Corners& a, const Corners& b) {
  const ExactShape s(a);
  const ExactShape t(b);
  const ExactShape& big = s.count >= t.count ? s : t;
  const ExactShape& small = s.count >= t.count ? t : s;
  if (big.count == 3 && small.count == 3) return CGAL::do_intersect(big.triangle(), small.triangle());
  if (big.count == 3 && small.count == 2) return CGAL::do_intersect(big.triangle(), small.segment());
  if (big.count == 3) return big.triangle().has_on(small.p[0]);
  if (big.count == 2 && small.count == 2) return CGAL::do_intersect(big.segment(), small.segment());
  if (big.count == 2) return big.segment().has_on(small.p[0]);
  return big.p[0] == small.p[0];
}

class Draw {
 public:
  explicit Draw(std::uint32_t seed) : random_(seed) {}
  double real() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  Vec3 grid(int reach) { return Vec3(integer(-reach, reach), integer(-reach, reach), integer(-reach, reach)); }
  Vec3 point() { return Vec3(real(), real(), real()); }
  // A few units in the last place.
  double nudged(double x) { return integer(0, 1) == 0 ? x : x * (1.0 + integer(-2, 2) * 0x1p-52); }

 private:
  std::mt19937 random_;
};

template <class Make>
void compare(const char* what, std::uint32_t seed, int pairs, const Make& make) {
  Draw draw(seed);
  int meeting = 0;
  int wrong = 0;
  for (int i = 0; i < pairs; ++i) {
    Corners a;
    Corners b;
    make(draw, a, b);
    const bool expected = meet_in_cgal(a, b);
    const bool got = odds::primitive::triangles_intersect(a.data(), b.data());
    meeting += expected ? 1 : 0;
    if (got == expected) continue;
    if (++wrong > 5) break;
    std::ostringstream corners;
    corners << std::hexfloat;
    for (const Corners& t : {a, b}) {
      for (const Vec3& p : t) corners << "{" << p.x() << "," << p.y() << "," << p.z() << "}, ";
    }
    ADD_FAILURE() << what << " pair " << i << ": CGAL says " << expected << "; " << corners.str();
  }
  // A distribution that nearly always gives one answer would test little.
  EXPECT_GT(meeting, pairs / 50) << what;
  EXPECT_LT(meeting, pairs - pairs / 50) << what;
}

TEST(TriangleTriangleAgainstCgal, SmallIntegerGrid) {
  for (const int reach : {1, 2}) {
    compare("grid", static_cast<std::uint32_t>(reach), 40000, [reach](Draw& draw, Corners& a, Corners& b) {
      for (Vec3& p : a) p = draw.grid(reach);
      for (Vec3& p : b) p = draw.grid(reach);
    });
  }
}

TEST(TriangleTriangleAgainstCgal, OnePlaneOfTheGrid) {
  compare("plane", 3, 30000, [](Draw& draw, Corners& a, Corners& b) {
    const Vec3 u(1, 2, -1);
    const Vec3 v(0, 3, 1);
    for (Corners* t : {&a, &b}) {
      for (Vec3& p : *t) p = Vec3(5, -7, 3) + draw.integer(-2, 2) * u + draw.integer(-2, 2) * v;
    }
  });
}

TEST(TriangleTriangleAgainstCgal, GridNudgedByUnitsInTheLastPlace) {
  compare("nudged", 4, 40000, [](Draw& draw, Corners& a, Corners& b) {
    for (Corners* t : {&a, &b}) {
      for (Vec3& p : *t) p = draw.grid(2).unaryExpr([&](double x) { return draw.nudged(x + 0.3); });
    }
  });
}

TEST(TriangleTriangleAgainstCgal, CornersOnTheOtherTriangleUpToRounding) {
  compare("touching", 5, 40000, [](Draw& draw, Corners& a, Corners& b) {
    for (Vec3& p : a) p = draw.point();
    for (Vec3& p : b) p = draw.point();
    const int touching = draw.integer(1, 3);
    for (int k = 0; k < touching; ++k) {
      double s = 0.5 * (1.0 + draw.real());
      double t = draw.integer(0, 3) == 0 ? 0.0 : 0.5 * (1.0 + draw.real());
      if (s + t > 1.0) {
        s = 1.0 - s;
        t = t == 0.0 ? 0.0 : 1.0 - t;
      }
      b[static_cast<std::size_t>(k)] = a[0] + s * (a[1] - a[0]) + t * (a[2] - a[0]);
    }
  });
}

TEST(TriangleTriangleAgainstCgal, SharedCornersAndEdges) {
  compare("shared", 6, 30000, [](Draw& draw, Corners& a, Corners& b) {
    for (Vec3& p : a) p = draw.point();
    for (Vec3& p : b) p = draw.point();
    const int shared = draw.integer(0, 2);
    for (int k = 0; k < shared; ++k) {
      b[static_cast<std::size_t>(k)] = a[static_cast<std::size_t>(draw.integer(0, 2))];
    }
  });
}

TEST(TriangleTriangleAgainstCgal, SliversAndNearlyParallelPlanesFarFromTheOrigin) {
  compare("slivers", 7, 40000, [](Draw& draw, Corners& a, Corners& b) {
    const Vec3 offset(1e9, -1e9, 3e8);
    const double thickness = draw.integer(0, 1) == 0 ? 1e-6 : 1e-7;
    for (Corners* t : {&a, &b}) {
      for (Vec3& p : *t) p = offset + Vec3(1e-3 * draw.real(), draw.real(), thickness * draw.real());
    }
  });
}

TEST(TriangleTriangleAgainstCgal, ExtremeScales) {
  for (const double scale : {0x1p-1060, 0x1p-400, 1e-9, 1e15, 0x1p400, 0x1p1000}) {
    compare("scales", 8, 2000, [scale](Draw& draw, Corners& a, Corners& b) {
      for (Corners* t : {&a, &b}) {
        for (Vec3& p : *t) p = scale * draw.grid(2);
      }
    });
  }
  compare("mixed scales", 9, 4000, [](Draw& draw, Corners& a, Corners& b) {
    const double scales[] = {0.0, 0x1p-1074, 0x1p-700, 0x1p-52, 1.0, 0x1p700};
    for (Corners* t : {&a, &b}) {
      for (Vec3& p : *t) {
        p = draw.grid(1);
        p[draw.integer(0, 2)] *= scales[draw.integer(0, 5)];
      }
    }
  });
}

TEST(TriangleTriangleAgainstCgal, GeneralPosition) {
  compare("general", 10, 40000, [](Draw& draw, Corners& a, Corners& b) {
    for (Vec3& p : a) p = draw.point();
    for (Vec3& p : b) p = draw.point();
  });
}

}  // namespace
