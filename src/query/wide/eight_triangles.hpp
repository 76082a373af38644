// Eight triangles and one, in single precision: what their boxes, planes, outlines and sides say.
#pragma once

#include <cmath>
#include <cstdint>

#include "query/wide/box_kernel.hpp"

namespace odds::query::wide {

/// Products of three lengths between these bounds neither overflow nor lose more to underflow than `least_product`.
inline constexpr float least_span = 1e-9F;
inline constexpr float greatest_span = 1e12F;
inline constexpr float least_product = 1e-37F;

template <class L>
struct EightTriangles {
  using F = typename L::Float;
  F corner[3][3];  // [corner][axis]
  F lower[3];
  F upper[3];
  F normal[3];
  F tolerance;          // of a product with the normal
  F outline_tolerance;  // of the side of a point to a side of the triangle, in a projection
  F longest;            // bounds half of each coordinate of a side

  ODDS_LANES_INLINE void scale(float factor) noexcept {
    for (auto& point : corner) {
      for (F& x : point) x = x * L::all(factor);
    }
  }
  ODDS_LANES_INLINE void bound() noexcept {
    for (int i = 0; i < 3; ++i) {
      lower[i] = L::min(L::min(corner[0][i], corner[1][i]), corner[2][i]);
      upper[i] = L::max(L::max(corner[0][i], corner[1][i]), corner[2][i]);
    }
  }
  /// `delta`: error of a coordinate; `span`: bound of all coordinates.
  ODDS_LANES_INLINE void find_planes(float delta, float span) noexcept {
    F u[3];
    F v[3];
    longest = L::all(0.0F);
    for (int i = 0; i < 3; ++i) {
      u[i] = corner[1][i] - corner[0][i];
      v[i] = corner[2][i] - corner[0][i];
      longest = L::max(longest, L::max(L::abs(u[i]), L::abs(v[i])));
    }
    normal[0] = u[1] * v[2] - u[2] * v[1];
    normal[1] = u[2] * v[0] - u[0] * v[2];
    normal[2] = u[0] * v[1] - u[1] * v[0];
    // A normal's component errs by 9 delta E, a difference of points by 2 delta and is at most 2 span long: the sum of
    // three products errs by less than 32 delta E (2 span + E), their own rounding included.
    tolerance = L::all(32.0F * delta) * longest * (L::all(2.0F * span) + longest) + L::all(least_product);
    // A side is at most 2 E long and errs by 2 delta, as does what it is multiplied with: twice such a product errs by
    // less than 8 delta (span + E) and its rounding by 3 delta E, the area, which says where the inside is, by 10 delta
    // E.
    outline_tolerance = L::all(16.0F * delta) * (L::all(span) + (longest + longest)) + L::all(least_product);
  }
  [[nodiscard]] ODDS_LANES_INLINE F lengths_of_normals() const noexcept {
    return L::root((normal[0] * normal[0] + normal[1] * normal[1]) + normal[2] * normal[2]);
  }
};

/// B's triangles one by one, for tests against eight of A at once: first of their boxes, then of their planes.
template <class L>
struct Rows {
  using F = typename L::Float;
  alignas(64) float corner[3][3][wide_lanes];
  alignas(64) float lower[3][wide_lanes];  ///< of the box widened by `slack`
  alignas(64) float upper[3][wide_lanes];
  alignas(64) float normal[3][wide_lanes];
  alignas(64) float tolerance[wide_lanes];
  alignas(64) float outline_tolerance[wide_lanes];
  alignas(64) float longest[wide_lanes];

  /// `slack`: error of a difference of coordinates.
  ODDS_LANES_INLINE void keep_boxes(const EightTriangles<L>& b, float slack) noexcept {
    for (int i = 0; i < 3; ++i) {
      L::store(lower[i], b.lower[i] - L::all(slack));
      L::store(upper[i], b.upper[i] + L::all(slack));
    }
  }
  ODDS_LANES_INLINE void keep_planes(const EightTriangles<L>& b) noexcept {
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) L::store(corner[k][i], b.corner[k][i]);
      L::store(normal[i], b.normal[i]);
    }
    L::store(tolerance, b.tolerance);
    L::store(outline_tolerance, b.outline_tolerance);
    L::store(longest, b.longest);
  }
  ODDS_LANES_INLINE void spread_corner(unsigned row, int k, F (&point)[3]) const noexcept {
    for (int i = 0; i < 3; ++i) point[i] = L::all(corner[k][i][row]);
  }
  ODDS_LANES_INLINE void spread_normal(unsigned row, F (&direction)[3]) const noexcept {
    for (int i = 0; i < 3; ++i) direction[i] = L::all(normal[i][row]);
  }
};

/// Of a point above a plane, times the length of its normal.
template <class L>
ODDS_LANES_INLINE typename L::Float height_above(const typename L::Float (&normal)[3],
                                                 const typename L::Float (&foot)[3],
                                                 const typename L::Float (&point)[3]) noexcept {
  return (normal[0] * (point[0] - foot[0]) + normal[1] * (point[1] - foot[1])) + normal[2] * (point[2] - foot[2]);
}

/// How far three points stay from a plane, times the length of its normal; 0 or less where they are on both sides.
template <class L>
class PlaneGap {
 public:
  using F = typename L::Float;
  ODDS_LANES_INLINE void add(const F (&normal)[3], const F (&foot)[3], const F (&point)[3], bool first) noexcept {
    const F height = height_above<L>(normal, foot, point);
    low_ = first ? height : L::min(low_, height);
    high_ = first ? height : L::max(high_, height);
  }
  [[nodiscard]] ODDS_LANES_INLINE F value() const noexcept { return L::max(low_, L::all(0.0F) - high_); }

 private:
  F low_ = L::all(0.0F);
  F high_ = L::all(0.0F);
};

/// A's corners from the plane of one of B's triangles.
template <class L>
ODDS_LANES_INLINE typename L::Float plane_gap_of_b(const EightTriangles<L>& a, const Rows<L>& b,
                                                   unsigned row) noexcept {
  typename L::Float normal[3];
  typename L::Float foot[3];
  b.spread_normal(row, normal);
  b.spread_corner(row, 0, foot);
  PlaneGap<L> gap;
  for (int k = 0; k < 3; ++k) gap.add(normal, foot, a.corner[k], k == 0);
  return gap.value();
}

/// B's corners from the planes of A's triangles.
template <class L>
ODDS_LANES_INLINE typename L::Float plane_gap_of_a(const EightTriangles<L>& a, const Rows<L>& b,
                                                   unsigned row) noexcept {
  PlaneGap<L> gap;
  for (int k = 0; k < 3; ++k) {
    typename L::Float point[3];
    b.spread_corner(row, k, point);
    gap.add(a.normal, a.corner[0], point, k == 0);
  }
  return gap.value();
}

/// One triangle's box against those of eight: false lanes are certainly apart.
template <class L>
ODDS_LANES_INLINE unsigned boxes_meet(const EightTriangles<L>& a, const Rows<L>& b, unsigned row) noexcept {
  unsigned mask = 0xFFU;
  for (int i = 0; i < 3; ++i) {
    mask &= L::less_equal(a.lower[i], L::all(b.upper[i][row])) & L::less_equal(L::all(b.lower[i][row]), a.upper[i]);
  }
  return mask;
}

/// One triangle's plane against eight triangles, and their planes against it: false lanes are certainly apart.
template <class L>
ODDS_LANES_INLINE unsigned planes_meet(const EightTriangles<L>& a, const Rows<L>& b, unsigned row) noexcept {
  return L::less_equal(plane_gap_of_b<L>(a, b, row), L::all(b.tolerance[row])) &
         L::less_equal(plane_gap_of_a<L>(a, b, row), a.tolerance);
}

/// A side of a triangle in a projection, directed.
template <class L>
struct OutlineSide {
  using F = typename L::Float;
  F x;
  F y;
  F along_x;
  F along_y;

  ODDS_LANES_INLINE OutlineSide(const F& from_x, const F& from_y, const F& to_x, const F& to_y) noexcept
      : x(from_x), y(from_y), along_x(to_x - from_x), along_y(to_y - from_y) {}
  /// How far a point lies to the left, times the side's length.
  [[nodiscard]] ODDS_LANES_INLINE F left(const F& point_x, const F& point_y) const noexcept {
    return along_x * (point_y - y) - along_y * (point_x - x);
  }
  [[nodiscard]] ODDS_LANES_INLINE F length() const noexcept { return L::root(along_x * along_x + along_y * along_y); }
};

/// One triangle's outline and eight others' as seen along the axis that is nearest to the one's normal: how far a side
/// of one has all of the other on its outside, the most of all sides; 0 or less says nothing. Times the side's length
/// or, `in_metres`, over at least that: then it is a distance. `slack`: error of a length.
///
/// Triangles that share a plane, as those of flush faces do, are mostly apart in it. No box, no plane sees that, and
/// the exact test takes its longest arithmetic to.
template <class L, bool in_metres>
ODDS_LANES_INLINE typename L::Float outline_gap(const EightTriangles<L>& a, const Rows<L>& b, unsigned row,
                                                float slack) noexcept {
  using F = typename L::Float;
  const float n[3] = {std::abs(b.normal[0][row]), std::abs(b.normal[1][row]), std::abs(b.normal[2][row])};
  const int k = n[0] >= n[1] ? (n[0] >= n[2] ? 0 : 2) : (n[1] >= n[2] ? 1 : 2);
  const int i = k == 2 ? 0 : k + 1;
  const int j = k == 0 ? 2 : k - 1;
  F x[3];
  F y[3];
  for (int c = 0; c < 3; ++c) {
    x[c] = L::all(b.corner[c][i][row]);
    y[c] = L::all(b.corner[c][j][row]);
  }
  const F zero = L::all(0.0F);
  const F inwards_a = L::choose(L::less_equal(zero, a.normal[k]), L::all(1.0F), L::all(-1.0F));
  const F inwards_b = L::all(b.normal[k][row] >= 0.0F ? 1.0F : -1.0F);
  const F tolerance_b = L::all(b.outline_tolerance[row]);
  F gap = L::all(-1.0F);
  for (int c = 0; c < 3; ++c) {
    const int d = c == 2 ? 0 : c + 1;
    const OutlineSide<L> side(a.corner[c][i], a.corner[c][j], a.corner[d][i], a.corner[d][j]);
    const F inmost = L::max(L::max(inwards_a * side.left(x[0], y[0]), inwards_a * side.left(x[1], y[1])),
                            inwards_a * side.left(x[2], y[2]));
    const F outside = (zero - inmost) - a.outline_tolerance;
    gap = L::max(gap, in_metres ? L::divide(outside, side.length() + L::all(slack)) : outside);
  }
  for (int c = 0; c < 3; ++c) {
    const int d = c == 2 ? 0 : c + 1;
    const OutlineSide<L> side(x[c], y[c], x[d], y[d]);
    F inmost = inwards_b * side.left(a.corner[0][i], a.corner[0][j]);
    for (int p = 1; p < 3; ++p) inmost = L::max(inmost, inwards_b * side.left(a.corner[p][i], a.corner[p][j]));
    const F outside = (zero - inmost) - tolerance_b;
    gap = L::max(gap, in_metres ? L::divide(outside, side.length() + L::all(slack)) : outside);
  }
  return gap;
}

/// Outlines of one triangle and of eight: false lanes are certainly apart.
template <class L>
ODDS_LANES_INLINE unsigned outlines_meet(const EightTriangles<L>& a, const Rows<L>& b, unsigned row) noexcept {
  return ~L::less_equal(L::all(0.0F), outline_gap<L, false>(a, b, row, 0.0F)) & 0xFFU;
}

/// Lanes of eight triangles by what is certain of each and one other. The rest is neither.
struct Certain {
  unsigned meet;
  unsigned apart;
};

/// What is certain of the sides of triangles that may pierce one plane each.
template <class L>
class Piercing {
 public:
  using F = typename L::Float;
  /// Of one side: between which heights its ends lie, and on which sides of the other triangle's sides its line runs.
  ODDS_LANES_INLINE void add(const F& height, const F& other_height, const F& height_tolerance, const F& low,
                             const F& high, const F& tolerance) noexcept {
    const F zero = L::all(0.0F);
    const F lowest = L::min(height, other_height);
    const F highest = L::max(height, other_height);
    const unsigned through = L::less_equal(tolerance, L::max(low, zero - high));
    const unsigned across = L::less_equal(height_tolerance, L::min(highest, zero - lowest));
    const unsigned past = L::less_equal(tolerance, L::min(high, zero - low));
    const unsigned beside = L::less_equal(height_tolerance, L::max(lowest, zero - highest));
    certain_.meet |= through & across;
    certain_.apart &= past | beside;
  }
  [[nodiscard]] ODDS_LANES_INLINE Certain certain() const noexcept { return certain_; }

 private:
  Certain certain_{0U, 0xFFU};
};

/// One triangle and eight by their sides: they meet where a side of one pierces the other, and are apart where none
/// does. The line of a side s pierces a triangle if it runs past that one's sides t on the same side of each: by the
/// sign of (s x t) . (from s to t).
template <class L>
ODDS_LANES_INLINE Certain sides_pierce(const EightTriangles<L>& a, const Rows<L>& b, unsigned row, float delta,
                                       float span) noexcept {
  using F = typename L::Float;
  // With E the longest of each: a component of s x t is at most 8 E_A E_B and errs by 8 delta (E_A + E_B), its product
  // with a difference of points by 48 delta span (E_A + E_B) + 64 delta E_A E_B.
  const F longest_b = L::all(b.longest[row]);
  const F tolerance = L::all(96.0F * delta * span) * (a.longest + longest_b) +
                      L::all(128.0F * delta) * (a.longest * longest_b) + L::all(least_product);
  F s[3][3];
  F t[3][3];
  F corner_b[3][3];
  F normal_b[3];
  b.spread_normal(row, normal_b);
  for (int c = 0; c < 3; ++c) b.spread_corner(row, c, corner_b[c]);
  F height_a[3];  // of A's corners above the plane of B's triangle
  F height_b[3];  // of B's corners above the planes of A's
  for (int c = 0; c < 3; ++c) {
    const int d = c == 2 ? 0 : c + 1;
    for (int i = 0; i < 3; ++i) {
      s[c][i] = a.corner[d][i] - a.corner[c][i];
      t[c][i] = corner_b[d][i] - corner_b[c][i];
    }
    height_a[c] = height_above<L>(normal_b, corner_b[0], a.corner[c]);
    height_b[c] = height_above<L>(a.normal, a.corner[0], corner_b[c]);
  }
  F low_a[3];
  F high_a[3];
  F low_b[3];
  F high_b[3];
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const F m[3] = {s[i][1] * t[j][2] - s[i][2] * t[j][1], s[i][2] * t[j][0] - s[i][0] * t[j][2],
                      s[i][0] * t[j][1] - s[i][1] * t[j][0]};
      const F turn = (m[0] * (corner_b[j][0] - a.corner[i][0]) + m[1] * (corner_b[j][1] - a.corner[i][1])) +
                     m[2] * (corner_b[j][2] - a.corner[i][2]);
      low_a[i] = j == 0 ? turn : L::min(low_a[i], turn);
      high_a[i] = j == 0 ? turn : L::max(high_a[i], turn);
      low_b[j] = i == 0 ? turn : L::min(low_b[j], turn);
      high_b[j] = i == 0 ? turn : L::max(high_b[j], turn);
    }
  }
  Piercing<L> piercing;
  const F tolerance_b = L::all(b.tolerance[row]);
  for (int c = 0; c < 3; ++c) {
    const int d = c == 2 ? 0 : c + 1;
    piercing.add(height_a[c], height_a[d], tolerance_b, low_a[c], high_a[c], tolerance);
    piercing.add(height_b[c], height_b[d], a.tolerance, low_b[c], high_b[c], tolerance);
  }
  return piercing.certain();
}

}  // namespace odds::query::wide
