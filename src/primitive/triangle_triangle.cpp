// Triangle against triangle: plane rejection, then two orientations; the rare rest goes to exact simplices.
#include "odds/primitive/triangle_triangle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "odds/primitive/predicates.hpp"
#include "primitive/overlap_polygon.hpp"
#include "primitive/simplex.hpp"

namespace odds::primitive {
namespace {

struct Signs {
  int of[3];
  [[nodiscard]] bool strictly_one_side() const noexcept { return of[0] != 0 && of[0] == of[1] && of[1] == of[2]; }
  [[nodiscard]] bool all_zero() const noexcept { return of[0] == 0 && of[1] == 0 && of[2] == 0; }
};

// Exact sides of the corners of q to the plane of p; one error bound serves all three.
Signs sides(const Vec3 p[3], const Vec3 q[3]) noexcept {
  const Vec3 u = p[1] - p[0];
  const Vec3 v = p[2] - p[0];
  const double nx = u.y() * v.z() - u.z() * v.y();
  const double ny = u.z() * v.x() - u.x() * v.z();
  const double nz = u.x() * v.y() - u.y() * v.x();
  Vec3 d[3];
  double height[3];
  Vec3 largest = u.cwiseAbs().cwiseMax(v.cwiseAbs());
  for (int i = 0; i < 3; ++i) {
    d[i] = q[i] - p[0];
    height[i] = nx * d[i].x() + ny * d[i].y() + nz * d[i].z();
    largest = largest.cwiseMax(d[i].cwiseAbs());
  }
  const double bound = orient3d_error_bound(largest.x(), largest.y(), largest.z());
  // Nobody could predict on which side a corner is; that it is clear is the rule.
  Signs signs;
  bool clear = true;
  for (int i = 0; i < 3; ++i) {
    signs.of[i] = (height[i] > bound ? 1 : 0) - (height[i] < -bound ? 1 : 0);
    clear = clear && signs.of[i] != 0;
  }
  if (clear) [[likely]]
    return signs;
  for (int i = 0; i < 3; ++i) {
    if (signs.of[i] == 0) signs.of[i] = orient3d(p[0], p[1], p[2], q[i]);
  }
  return signs;
}

// The corner whose two edges both reach the other plane: alone on its side, or alone in the plane. Precondition: the
// signs are neither all zero nor strictly of one side.
constexpr int find_apex(const Signs& signs) noexcept {
  for (int i = 0; i < 3; ++i) {
    const int here = signs.of[i];
    const int next = signs.of[(i + 1) % 3];
    const int last = signs.of[(i + 2) % 3];
    if (here > 0 && next <= 0 && last <= 0) return i;
    if (here < 0 && next >= 0 && last >= 0) return i;
    if (here == 0 && next * last > 0) return i;
  }
  return 0;
}

// The apex, and whether it lies below the plane of the other triangle, or the other corners above.
struct Apex {
  std::int8_t corner;
  bool below;
};
constexpr int signs_of_three = 27;
constexpr auto apexes = [] {
  std::array<Apex, signs_of_three> found{};
  for (int code = 0; code < signs_of_three; ++code) {
    const Signs signs{{code / 9 - 1, code / 3 % 3 - 1, code % 3 - 1}};
    const int apex = find_apex(signs);
    const bool below = signs.of[apex] < 0 || (signs.of[apex] == 0 && signs.of[(apex + 1) % 3] > 0);
    found[static_cast<std::size_t>(code)] = {static_cast<std::int8_t>(apex), below};
  }
  return found;
}();

// From a table, for every branch on signs would be a guess.
Apex apex_of(const Signs& signs) noexcept {
  return apexes[static_cast<std::size_t>(9 * signs.of[0] + 3 * signs.of[1] + signs.of[2] + 13)];
}

// A pair in different planes, corners renamed: a[0] and b[0] are the apexes, a[0] lies not below the plane of b, its
// other corners not above, and likewise for b. On the common line, oriented so, `a` covers the interval from edge
// a[0]a[1] to edge a[0]a[2], and `b` from edge b[0]b[2] to edge b[0]b[1].
struct ArrangedPair {
  const Vec3* a[3];
  const Vec3* b[3];
};

ArrangedPair arrange(const Vec3 a[3], const Signs& a_signs, const Vec3 b[3], const Signs& b_signs) noexcept {
  constexpr int corner_after[] = {1, 2, 0, 1};
  const Apex i = apex_of(a_signs);
  const Apex j = apex_of(b_signs);
  // Turning a triangle over exchanges the sides of its plane.
  const int turned_b = i.below ? 1 : 0;
  const int turned_a = j.below ? 1 : 0;
  return {{&a[i.corner], &a[corner_after[i.corner + turned_a]], &a[corner_after[i.corner + 1 - turned_a]]},
          {&b[j.corner], &b[corner_after[j.corner + turned_b]], &b[corner_after[j.corner + 1 - turned_b]]}};
}

bool intervals_meet(const ArrangedPair& pair) noexcept {
  const auto& [a, b] = pair;
  return orient3d(*a[0], *a[1], *b[0], *b[1]) <= 0 && orient3d(*a[0], *a[2], *b[0], *b[2]) >= 0;
}

IntersectionSegment common_interval(const ArrangedPair& pair) noexcept {
  const auto& [a, b] = pair;
  const bool a_begins_last = orient3d(*a[0], *a[1], *b[0], *b[2]) >= 0;
  const bool a_ends_first = orient3d(*a[0], *a[2], *b[0], *b[1]) <= 0;
  const auto through_b = [&pair](const Vec3& p, const Vec3& q) noexcept {
    return detail::edge_through_plane(p, q, *pair.b[0], *pair.b[1], *pair.b[2]);
  };
  const auto through_a = [&pair](const Vec3& p, const Vec3& q) noexcept {
    return detail::edge_through_plane(p, q, *pair.a[0], *pair.a[1], *pair.a[2]);
  };
  return {a_begins_last ? through_b(*a[0], *a[1]) : through_a(*b[0], *b[2]),
          a_ends_first ? through_b(*a[0], *a[2]) : through_a(*b[0], *b[1])};
}

enum class Kind { apart, arranged, flat };

// The cheap rejections, and the arrangement of what remains; `flat` if one triangle fixes no plane or both share one.
Kind classify(const Vec3 a[3], const Vec3 b[3], ArrangedPair& pair) noexcept {
  const Signs b_signs = sides(a, b);
  if (b_signs.strictly_one_side()) return Kind::apart;
  const Signs a_signs = sides(b, a);
  if (a_signs.strictly_one_side()) return Kind::apart;
  if (a_signs.all_zero() || b_signs.all_zero()) return Kind::flat;
  pair = arrange(a, a_signs, b, b_signs);
  return Kind::arranged;
}

// Between these no product of three coordinates overflows, nor underflows to where it matters.
constexpr double kSafeSmallest = 0x1p-300;
constexpr double kSafeLargest = 0x1p300;

double largest_coordinate(const Vec3 t[3]) noexcept {
  return t[0].cwiseAbs().cwiseMax(t[1].cwiseAbs()).cwiseMax(t[2].cwiseAbs()).maxCoeff();
}

// Positions for coordinates whose products leave the doubles: computed near one, then scaled back. Precondition: the
// triangles meet.
IntersectionSegment scaled_segment(const Vec3 a[3], const Vec3 b[3], int exponent) noexcept {
  const auto down = [=](double x) { return std::ldexp(x, -exponent); };
  const auto up = [=](double x) { return std::ldexp(x, exponent); };
  const Vec3 a_near[3] = {a[0].unaryExpr(down), a[1].unaryExpr(down), a[2].unaryExpr(down)};
  const Vec3 b_near[3] = {b[0].unaryExpr(down), b[1].unaryExpr(down), b[2].unaryExpr(down)};
  ArrangedPair pair;
  const bool arranged = classify(a_near, b_near, pair) == Kind::arranged && intervals_meet(pair);
  const IntersectionSegment segment = arranged ? common_interval(pair) : detail::flat_overlap(a_near, b_near);
  return {segment.begin.unaryExpr(up), segment.end.unaryExpr(up)};
}

// What both triangles share lies in both their boxes; rounding may not move it out.
void keep_in_boxes(const Vec3 a[3], const Vec3 b[3], IntersectionSegment& segment) noexcept {
  const auto low = [](const Vec3 t[3]) -> Vec3 { return t[0].cwiseMin(t[1]).cwiseMin(t[2]); };
  const auto high = [](const Vec3 t[3]) -> Vec3 { return t[0].cwiseMax(t[1]).cwiseMax(t[2]); };
  const Vec3 smallest = low(a).cwiseMax(low(b));
  const Vec3 largest = high(a).cwiseMin(high(b));
  segment.begin = segment.begin.cwiseMax(smallest).cwiseMin(largest);
  segment.end = segment.end.cwiseMax(smallest).cwiseMin(largest);
}

}  // namespace

bool triangles_intersect(const Vec3 a[3], const Vec3 b[3]) noexcept {
  ArrangedPair pair;
  switch (classify(a, b, pair)) {
    case Kind::apart:
      return false;
    case Kind::arranged:
      return intervals_meet(pair);
    case Kind::flat:
      break;
  }
  return detail::simplices_intersect(detail::simplex_of(a), detail::simplex_of(b));
}

bool intersection_segment(const Vec3 a[3], const Vec3 b[3], IntersectionSegment& segment) noexcept {
  const double largest = std::max(largest_coordinate(a), largest_coordinate(b));
  if (largest != 0.0 && !(largest >= kSafeSmallest && largest <= kSafeLargest)) {
    if (!triangles_intersect(a, b)) return false;
    segment = scaled_segment(a, b, std::ilogb(largest));
  } else {
    ArrangedPair pair;
    const Kind kind = classify(a, b, pair);
    if (kind == Kind::apart) return false;
    if (kind == Kind::arranged && !intervals_meet(pair)) return false;
    if (kind == Kind::flat && !detail::simplices_intersect(detail::simplex_of(a), detail::simplex_of(b))) return false;
    segment = kind == Kind::arranged ? common_interval(pair) : detail::flat_overlap(a, b);
  }
  keep_in_boxes(a, b, segment);
  return true;
}

}  // namespace odds::primitive
