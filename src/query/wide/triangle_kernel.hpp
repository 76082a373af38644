// What leaves ask: eight triangles against eight, in single precision; pairs that may meet go to the exact test.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "query/wide/box_kernel.hpp"
#include "query/wide/eight_triangles.hpp"

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
  std::uint8_t certain_a[wide_lanes];  ///< those that it certainly meets; nothing unless `parted`
  std::uint32_t rows = 0;              ///< bits of B's triangles with any
  std::uint32_t tested = 0;  ///< of B's triangles those near A's box, parted by a slab or compared with all of A's
  std::uint32_t parted = 0;  ///< of these finely, too

  /// Whether the exact test has nothing to say.
  [[nodiscard]] ODDS_LANES_INLINE bool certainly_meet(unsigned row, unsigned lane) const noexcept {
    return parted != 0 && (certain_a[row] >> lane & 1U) != 0;
  }
};

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

/// Takes away what sides or outlines part, and notes what certainly meets. Not inlined: where a hit is near it is in
/// the way.
template <class L>
[[gnu::noinline]] void part_finely(const TwoLeaves<L>& leaves, const Rows<L>& b, LeafPairs& found) noexcept {
  found.parted = static_cast<std::uint32_t>(std::popcount(found.rows));
  for (unsigned left = found.rows; left != 0; left &= left - 1U) {
    const auto row = static_cast<unsigned>(__builtin_ctz(left));
    const Certain certain = sides_pierce<L>(leaves.a, b, row, leaves.delta, leaves.span);
    unsigned met = found.lanes_a[row] & ~certain.apart;
    if ((met & ~certain.meet) != 0) met &= certain.meet | outlines_meet<L>(leaves.a, b, row);
    found.lanes_a[row] = static_cast<std::uint8_t>(met);
    found.certain_a[row] = static_cast<std::uint8_t>(certain.meet);
    found.rows &= met != 0 ? ~0U : ~(1U << row);
  }
}

/// Of eight triangles those that reach another leaf's slab: all |normal . x - offset| <= thickness. Where two sheets
/// lie over each other the slabs of both part most of what their boxes do not, and what bounds a slab in the search,
/// the other's box and slab, is not as near as its triangles: of the leaves of two
/// knots or bumpy spheres that touch two thirds are parted, and four fifths of the rows. Planes of triangles would part
/// most of them, one row at a time.
template <class L>
[[nodiscard]] ODDS_LANES_INLINE unsigned reach_slab(const EightTriangles<L>& eight, const float (&normal)[3],
                                                    float offset, float thickness) noexcept {
  using F = typename L::Float;
  const F n[3] = {L::all(normal[0]), L::all(normal[1]), L::all(normal[2])};
  F along[3];
  for (int k = 0; k < 3; ++k) {
    const F(&x)[3] = eight.corner[k];
    along[k] = (n[0] * x[0] + n[1] * x[1]) + n[2] * x[2];
  }
  const F lowest = L::min(L::min(along[0], along[1]), along[2]);
  const F highest = L::max(L::max(along[0], along[1]), along[2]);
  return L::less_equal(lowest, L::all(offset + thickness)) & L::less_equal(L::all(offset - thickness), highest);
}

/// Pairs of triangles of two leaves that no box, no slab and no plane separates and, `finely`, no side of theirs.
/// `shift`: where B's leaf centre stands from A's, in A's frame; `margin`: that of the encounter.
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
  found.tested = static_cast<std::uint32_t>(std::popcount(rows));
  // What of either reaches the other's slab. A corner along a normal errs by sqrt(3) delta, its sum's rounding, B's
  // normal in A's frame and B's centre along it by less than 1.5 delta each, and a pose that is only just rigid enough
  // tilts B's slab by up to 8 delta.
  [[maybe_unused]] const float slack = 16.0F * delta;
  [[maybe_unused]] const float scale = leaves.scale;
  if constexpr (looks_at_slabs<L>) {
    const LaneNumbers box(in_a.node, in_a.lane);
    const float normal[3] = {box.normal(0), box.normal(1), box.normal(2)};
    rows &= reach_slab<L>(leaves.b, normal, box.offset() * scale, box.thickness() * scale + slack);
    if (rows == 0) return found;
  }
  leaves.place_a(in_a.leaf);
  if constexpr (looks_at_slabs<L>) {
    const LaneNumbers box(in_b.node, in_b.lane);
    const Vector m = (turn.column[0] * box.normal(0) + turn.column[1] * box.normal(1)) + turn.column[2] * box.normal(2);
    const float normal[3] = {m[0], m[1], m[2]};
    const float center = (m[0] * shift[0] + m[1] * shift[1]) + m[2] * shift[2];
    leaves.lanes_a &= reach_slab<L>(leaves.a, normal, (center + box.offset()) * scale, box.thickness() * scale + slack);
    if (leaves.lanes_a == 0) return found;
  }
  Rows<L> b;
  b.keep_boxes(leaves.b, 2.0F * delta);
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

/// Shorter normals have lost digits to underflow.
inline constexpr float shortest_normal = 1e-18F;
/// Covers the rounding of roots and quotients.
inline constexpr float just_below_one = 0.999999F;

/// Two leaves with all that is compared of their triangles, B's one by one.
template <class L>
struct SpreadLeaves {
  TwoLeaves<L> leaves;
  Rows<L> rows_of_b;

  ODDS_LANES_INLINE SpreadLeaves(const PlacedLeaf& in_a, const PlacedLeaf& in_b, const Turn& turn, const float shift[3],
                                 float margin) noexcept {
    leaves.measure(in_a, in_b, turn, shift, margin);
    leaves.place_b(in_b.leaf, turn, shift);
    leaves.place_a(in_a.leaf);
    leaves.find_planes();
    rows_of_b.keep_boxes(leaves.b, 0.0F);
    rows_of_b.keep_planes(leaves.b);
  }
};

/// For each of B's triangles (rows) and A's (lanes) a lower bound of their distance, from boxes and planes and, where
/// those say nothing, from outlines; 0 or less says nothing. Metres. Lanes beyond A's count repeat its first
/// triangle's; rows beyond B's are not written.
template <class L>
ODDS_LANES_INLINE void triangle_gaps(const SpreadLeaves<L>& spread, std::uint32_t rows,
                                     float (&gaps)[wide_lanes][wide_lanes]) noexcept {
  using F = typename L::Float;
  const TwoLeaves<L>& leaves = spread.leaves;
  const EightTriangles<L>& a = leaves.a;
  const Rows<L>& b = spread.rows_of_b;
  const F inverse_a = L::divide(L::all(just_below_one), L::max(a.lengths_of_normals(), L::all(shortest_normal)));
  alignas(64) float lengths_b[wide_lanes];
  L::store(lengths_b, leaves.b.lengths_of_normals());
  const F slack = L::all(2.0F * leaves.delta);
  const F unscale = L::all(1.0F / leaves.scale);
  for (unsigned row = 0; row < rows; ++row) {
    F squares = L::all(0.0F);  // boxes apart along several axes are apart by their legs
    for (int i = 0; i < 3; ++i) {
      const F leg = L::max(L::all(b.lower[i][row]) - a.upper[i], a.lower[i] - L::all(b.upper[i][row])) - slack;
      squares = squares + L::max(leg, L::all(0.0F)) * L::max(leg, L::all(0.0F));
    }
    F gap = L::root(squares) * L::all(just_below_one);
    if (lengths_b[row] > shortest_normal) {
      const F planes_b = plane_gap_of_b<L>(a, b, row) - L::all(b.tolerance[row]);
      gap = L::max(gap, planes_b * L::all(just_below_one / lengths_b[row]));
    }
    const F planes_a = plane_gap_of_a<L>(a, b, row) - a.tolerance;
    gap = L::max(gap, planes_a * inverse_a);
    if ((L::less_equal(gap, L::all(0.0F)) & leaves.lanes_a) != 0) {
      gap = L::max(gap, outline_gap<L, true>(a, b, row, 6.0F * leaves.delta) * L::all(just_below_one));
    }
    L::store(gaps[row], gap * unscale);
  }
}

}  // namespace odds::query::wide
