// What leaves ask: eight triangles against eight, in single precision; pairs that may meet go to the exact test.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "query/wide/box_kernel.hpp"

namespace odds::query::wide {

using tree::WideLeaf;

/// A leaf: the node and lane that hold its box, and its triangles.
struct PlacedLeaf {
  const WideNode& node;
  std::uint32_t lane;
  const WideLeaf& leaf;

  [[nodiscard]] std::uint32_t count() const noexcept { return node.child[lane].count(); }
};

/// For each triangle of leaf B the triangles of leaf A that it may meet, as bits.
struct LeafPairs {
  std::uint8_t lanes_a[wide_lanes];
  std::uint32_t rows = 0;    ///< bits of B's triangles with any
  std::uint32_t tested = 0;  ///< of B's triangles compared with all of A's at once
  std::uint32_t parted = 0;  ///< of these finely, too
};

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

/// How far three points stay from a plane, times the length of its normal; 0 or less where they are on both sides.
template <class L>
class PlaneGap {
 public:
  using F = typename L::Float;
  ODDS_LANES_INLINE void add(const F (&normal)[3], const F (&foot)[3], const F (&point)[3], bool first) noexcept {
    F height = normal[0] * (point[0] - foot[0]);
    height = height + normal[1] * (point[1] - foot[1]);
    height = height + normal[2] * (point[2] - foot[2]);
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

/// One triangle and eight along the nine directions across a side of each: false lanes are certainly apart. With both
/// planes these are all that can part triangles that do not share one.
///
/// With sides s and t, m = s x t, n the normals: along m A's triangle reaches from its side by -n_A . t, B's by n_B .
/// s.
template <class L>
ODDS_LANES_INLINE unsigned sides_meet(const EightTriangles<L>& a, const Rows<L>& b, unsigned row, float delta,
                                      float span) noexcept {
  using F = typename L::Float;
  const F zero = L::all(0.0F);
  // With E the longest of each: a component of m is at most 8 E_A E_B and errs by 8 delta (E_A + E_B), its product with
  // a difference of points by 48 delta span (E_A + E_B) + 64 delta E_A E_B; the reaches by 54 delta E_A E_B + 12 delta
  // E^2 each.
  const F longest_b = L::all(b.longest[row]);
  const F tolerance = L::all(96.0F * delta * span) * (a.longest + longest_b) +
                      L::all(224.0F * delta) * (a.longest * longest_b) + L::all(least_product);
  F s[3][3];
  F t[3][3];
  F corner_b[3][3];
  F reach_a[3];
  F reach_b[3];
  for (int c = 0; c < 3; ++c) b.spread_corner(row, c, corner_b[c]);
  F normal_b[3];
  b.spread_normal(row, normal_b);
  for (int c = 0; c < 3; ++c) {
    const int d = c == 2 ? 0 : c + 1;
    for (int i = 0; i < 3; ++i) {
      s[c][i] = a.corner[d][i] - a.corner[c][i];
      t[c][i] = corner_b[d][i] - corner_b[c][i];
    }
    reach_a[c] = zero - ((a.normal[0] * t[c][0] + a.normal[1] * t[c][1]) + a.normal[2] * t[c][2]);
    reach_b[c] = (normal_b[0] * s[c][0] + normal_b[1] * s[c][1]) + normal_b[2] * s[c][2];
  }
  unsigned apart = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const F m[3] = {s[i][1] * t[j][2] - s[i][2] * t[j][1], s[i][2] * t[j][0] - s[i][0] * t[j][2],
                      s[i][0] * t[j][1] - s[i][1] * t[j][0]};
      const F from = (m[0] * (corner_b[j][0] - a.corner[i][0]) + m[1] * (corner_b[j][1] - a.corner[i][1])) +
                     m[2] * (corner_b[j][2] - a.corner[i][2]);
      const F to = from + reach_b[i];
      const F above = L::min(from, to) - L::max(zero, reach_a[j]);
      const F below = L::min(zero, reach_a[j]) - L::max(from, to);
      apart |= L::less_equal(tolerance, L::max(above, below));
    }
  }
  return ~apart & 0xFFU;
}

/// Two leaves in A's frame, about the centre of A's lane, times `scale`.
template <class L>
struct TwoLeaves {
  EightTriangles<L> a;
  EightTriangles<L> b;
  float scale = 1.0F;  ///< a power of two; 1 unless the leaves are so large or small that products of lengths suffer
  float delta;         ///< error of a coordinate
  float span;          ///< bound of all coordinates
  unsigned lanes_a;
  unsigned lanes_b;

  /// Bounds the coordinates: B's box reaches at most this far from A's centre, and each coordinate errs by at most
  /// `delta`: half a rounding of A, half of B and of the rotation times the box, three products and sums.
  ODDS_LANES_INLINE void measure(const PlacedLeaf& in_a, const PlacedLeaf& in_b, const Turn& turn, const float shift[3],
                                 float margin) noexcept {
    const LaneNumbers box_a(in_a.node, in_a.lane);
    const LaneNumbers box_b(in_b.node, in_b.lane);
    const Vector extent =
        (turn.abs_column[0] * box_b.half(0) + turn.abs_column[1] * box_b.half(1)) + turn.abs_column[2] * box_b.half(2);
    span = 0.0F;
    for (int i = 0; i < 3; ++i) {
      const float away = shift[i] < 0.0F ? -shift[i] : shift[i];
      span = std::max(span, std::max(box_a.half(i), away + extent[i]));
    }
    span = span + margin;
    delta = 12.0F * 0x1p-24F * span + std::numeric_limits<float>::min();
    if (!(span >= least_span && span <= greatest_span)) [[unlikely]] {
      scale = std::ldexp(1.0F, -std::clamp(std::ilogb(span), -126, 126));
      span *= scale;
      delta *= scale;
    }
    lanes_a = (2U << (in_a.count() - 1U)) - 1U;
    lanes_b = (2U << (in_b.count() - 1U)) - 1U;
  }

  /// `shift`: where B's leaf centre stands from A's, in A's frame.
  ODDS_LANES_INLINE void place_b(const WideLeaf& leaf, const Turn& turn, const float shift[3]) noexcept {
    using F = typename L::Float;
    for (int k = 0; k < 3; ++k) {
      F x[3];
      for (int i = 0; i < 3; ++i) x[i] = L::load(leaf.corner[k][i]);
      for (int i = 0; i < 3; ++i) {
        b.corner[k][i] =
            ((L::all(turn.column[0][i]) * x[0] + L::all(turn.column[1][i]) * x[1]) + L::all(turn.column[2][i]) * x[2]) +
            L::all(shift[i]);
      }
    }
    if (scale != 1.0F) [[unlikely]]
      b.scale(scale);
    b.bound();
  }

  ODDS_LANES_INLINE void place_a(const WideLeaf& leaf) noexcept {
    for (int k = 0; k < 3; ++k) {
      for (int i = 0; i < 3; ++i) a.corner[k][i] = L::load(leaf.corner[k][i]);
    }
    if (scale != 1.0F) [[unlikely]]
      a.scale(scale);
    a.bound();
  }

  ODDS_LANES_INLINE void find_planes() noexcept {
    a.find_planes(delta, span);
    b.find_planes(delta, span);
  }
};

/// Takes away what outlines or directions across sides part. Not inlined: where a hit is near it is in the way.
template <class L>
[[gnu::noinline]] void part_finely(const TwoLeaves<L>& leaves, const Rows<L>& b, LeafPairs& found) noexcept {
  found.parted = static_cast<std::uint32_t>(std::popcount(found.rows));
  for (unsigned left = found.rows; left != 0; left &= left - 1U) {
    const auto row = static_cast<unsigned>(__builtin_ctz(left));
    unsigned met = found.lanes_a[row] & outlines_meet<L>(leaves.a, b, row);
    if (met != 0) met &= sides_meet<L>(leaves.a, b, row, leaves.delta, leaves.span);
    found.lanes_a[row] = static_cast<std::uint8_t>(met);
    found.rows &= met != 0 ? ~0U : ~(1U << row);
  }
}

/// Pairs of triangles of two leaves that no box and no plane separates and, `finely`, no side of theirs. `shift`: where
/// B's leaf centre stands from A's, in A's frame; `margin`: that of the encounter.
template <class L>
ODDS_LANES_INLINE LeafPairs leaf_pairs(const PlacedLeaf& in_a, const PlacedLeaf& in_b, const Turn& turn,
                                       const float shift[3], float margin, bool finely) noexcept {
  LeafPairs found;
  TwoLeaves<L> leaves;
  leaves.measure(in_a, in_b, turn, shift, margin);
  leaves.place_b(in_b.leaf, turn, shift);
  const float delta = leaves.delta;
  unsigned rows = leaves.lanes_b;
  for (int i = 0; i < 3; ++i) {  // only B's triangles that come near A's box
    const float half = in_a.node.half[i][in_a.lane] * leaves.scale + delta;
    rows &= L::less_equal(leaves.b.lower[i], L::all(half)) & L::less_equal(L::all(-half), leaves.b.upper[i]);
  }
  if (rows == 0) return found;
  leaves.place_a(in_a.leaf);
  Rows<L> b;
  b.keep_boxes(leaves.b, 2.0F * delta);
  found.tested = static_cast<std::uint32_t>(std::popcount(rows));
  for (unsigned left = rows; left != 0; left &= left - 1U) {
    const auto row = static_cast<unsigned>(__builtin_ctz(left));
    const unsigned met = leaves.lanes_a & boxes_meet<L>(leaves.a, b, row);
    found.lanes_a[row] = static_cast<std::uint8_t>(met);
    rows &= met != 0 ? ~0U : ~(1U << row);
  }
  if (rows == 0) return found;
  leaves.find_planes();
  b.keep_planes(leaves.b);
  for (unsigned left = rows; left != 0; left &= left - 1U) {
    const auto row = static_cast<unsigned>(__builtin_ctz(left));
    const unsigned met = found.lanes_a[row] & planes_meet<L>(leaves.a, b, row);
    found.lanes_a[row] = static_cast<std::uint8_t>(met);
    rows &= met != 0 ? ~0U : ~(1U << row);
  }
  found.rows = rows;
  if (finely && rows != 0) part_finely<L>(leaves, b, found);
  return found;
}

/// For each of B's triangles (rows) and A's (lanes) a lower bound of their distance, from boxes and planes and, where
/// those say nothing, from outlines; 0 or less says nothing. Metres. Lanes and rows beyond the leaves' counts say
/// nothing.
template <class L>
ODDS_LANES_INLINE void triangle_gaps(const PlacedLeaf& in_a, const PlacedLeaf& in_b, const Turn& turn,
                                     const float shift[3], float margin,
                                     float (&gaps)[wide_lanes][wide_lanes]) noexcept {
  using F = typename L::Float;
  constexpr float shortest_normal = 1e-18F;  // shorter ones have lost digits to underflow
  constexpr float below = 0.999999F;         // covers the rounding of roots and quotients
  TwoLeaves<L> leaves;
  leaves.measure(in_a, in_b, turn, shift, margin);
  leaves.place_b(in_b.leaf, turn, shift);
  leaves.place_a(in_a.leaf);
  leaves.find_planes();
  Rows<L> b;
  b.keep_boxes(leaves.b, 0.0F);
  b.keep_planes(leaves.b);
  const EightTriangles<L>& a = leaves.a;
  const F inverse_a = L::divide(L::all(below), L::max(a.lengths_of_normals(), L::all(shortest_normal)));
  alignas(64) float lengths_b[wide_lanes];
  L::store(lengths_b, leaves.b.lengths_of_normals());
  const F slack = L::all(2.0F * leaves.delta);
  const F unscale = L::all(1.0F / leaves.scale);
  for (unsigned row = 0; row < in_b.count(); ++row) {
    F squares = L::all(0.0F);  // boxes apart along several axes are apart by their legs
    for (int i = 0; i < 3; ++i) {
      const F leg = L::max(L::all(b.lower[i][row]) - a.upper[i], a.lower[i] - L::all(b.upper[i][row])) - slack;
      squares = squares + L::max(leg, L::all(0.0F)) * L::max(leg, L::all(0.0F));
    }
    F gap = L::root(squares) * L::all(below);
    if (lengths_b[row] > shortest_normal) {
      const F planes_b = plane_gap_of_b<L>(a, b, row) - L::all(b.tolerance[row]);
      gap = L::max(gap, planes_b * L::all(below / lengths_b[row]));
    }
    const F planes_a = plane_gap_of_a<L>(a, b, row) - a.tolerance;
    gap = L::max(gap, planes_a * inverse_a);
    if ((L::less_equal(gap, L::all(0.0F)) & leaves.lanes_a) != 0) {
      gap = L::max(gap, outline_gap<L, true>(a, b, row, 6.0F * leaves.delta) * L::all(below));
    }
    L::store(gaps[row], gap * unscale);
  }
}

/// The least of these.
template <class L>
ODDS_LANES_INLINE float leaf_gap(const PlacedLeaf& in_a, const PlacedLeaf& in_b, const Turn& turn, const float shift[3],
                                 float margin) noexcept {
  alignas(64) float gaps[wide_lanes][wide_lanes];
  triangle_gaps<L>(in_a, in_b, turn, shift, margin, gaps);
  typename L::Float least = L::load(gaps[0]);
  for (unsigned row = 1; row < in_b.count(); ++row) least = L::min(least, L::load(gaps[row]));
  alignas(64) float of[wide_lanes];
  L::store(of, least);
  float smallest = of[0];
  for (std::uint32_t lane = 1; lane < in_a.count(); ++lane) smallest = std::min(smallest, of[lane]);
  return smallest;
}

}  // namespace odds::query::wide
