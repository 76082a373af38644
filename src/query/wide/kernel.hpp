// The two inner loops of the wide engine: one bounding volume against eight, and eight triangles against eight.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "odds/tree/wide_tree.hpp"
#include "query/wide/lanes.hpp"

namespace odds::query::wide {

using tree::Slot;
using tree::wide_lanes;
using tree::WideLeaf;
using tree::WideNode;

/// Four floats that the compiler keeps together; the last is not used.
using Vector = float __attribute__((vector_size(16)));

/// How the other tree's frame stands in this one's: x_this = u x_other + t. Plain floats.
struct Turn {
  Vector column[3];      ///< of u
  Vector abs_column[3];  ///< |u|, rounded up
  Vector t;              ///< metres
};

/// One lane's bounding volume, seen from the other tree's frame.
struct TurnedBox {
  Vector center;
  Vector extent;  ///< of the box along this frame's axes
  Vector normal;
  float half[3];  ///< along its own axes, the columns of u
  float offset;
  float thickness;
};

ODDS_LANES_INLINE TurnedBox turn(const WideNode& node, std::uint32_t lane, const Turn& turn) noexcept {
  TurnedBox box;
  const Vector(&u)[3] = turn.column;
  const Vector(&au)[3] = turn.abs_column;
  for (int i = 0; i < 3; ++i) box.half[i] = node.half[i][lane];
  box.center = ((u[0] * node.center[0][lane] + u[1] * node.center[1][lane]) + u[2] * node.center[2][lane]) + turn.t;
  box.extent = (au[0] * box.half[0] + au[1] * box.half[1]) + au[2] * box.half[2];
  box.normal = (u[0] * node.normal[0][lane] + u[1] * node.normal[1][lane]) + u[2] * node.normal[2][lane];
  const Vector along = box.normal * turn.t;
  box.offset = ((along[0] + along[1]) + along[2]) + node.offset[lane];
  box.thickness = node.thickness[lane];
  return box;
}

/// Size that decides which side to descend into: half the box's diagonal, squared.
ODDS_LANES_INLINE float squared_radius(const WideNode& node, std::uint32_t lane) noexcept {
  const float x = node.half[0][lane];
  const float y = node.half[1][lane];
  const float z = node.half[2][lane];
  return x * x + y * y + z * z;
}

/// Separating axes: the three of each box and the normals of both slabs (the nine edge pairs never paid). The gap along
/// any axis of length at most 1 bounds the distance from below, up to the rounding that `margin` of the encounter
/// covers. `far`: the three gaps of each frame's axes also count together, as the legs of a distance; for boxes that
/// are apart by more than their sizes that is what bounds it.
template <class L, bool far = false>
ODDS_LANES_INLINE typename L::Float gaps(const WideNode& node, const TurnedBox& box, const Turn& turn) noexcept {
  using F = typename L::Float;
  F d[3];
  F c[3];
  F h[3];
  for (int i = 0; i < 3; ++i) {
    c[i] = L::load(node.center[i]);
    h[i] = L::load(node.half[i]);
    d[i] = L::all(box.center[i]) - c[i];
  }
  F gap = L::abs(d[0]) - (h[0] + L::all(box.extent[0]));  // this frame's axes
  const F none = L::all(0.0F);
  F squares = L::max(gap, none) * L::max(gap, none);
  for (int i = 1; i < 3; ++i) {
    const F one = L::abs(d[i]) - (h[i] + L::all(box.extent[i]));
    gap = L::max(gap, one);
    if constexpr (far) squares = squares + L::max(one, none) * L::max(one, none);
  }
  if constexpr (far) gap = L::max(gap, L::root(squares) * L::all(0.999999F));
  {  // the box's slab
    const F along = (L::all(box.normal[0]) * c[0] + L::all(box.normal[1]) * c[1]) + L::all(box.normal[2]) * c[2];
    const F reach = (L::abs(L::all(box.normal[0])) * h[0] + L::abs(L::all(box.normal[1])) * h[1]) +
                    L::abs(L::all(box.normal[2])) * h[2];
    gap = L::max(gap, L::abs(along - L::all(box.offset)) - (reach + L::all(box.thickness)));
  }
  F n[3];
  for (int i = 0; i < 3; ++i) n[i] = L::load(node.normal[i]);
  {  // the lanes' slabs
    const F along = (n[0] * L::all(box.center[0]) + n[1] * L::all(box.center[1])) + n[2] * L::all(box.center[2]);
    F reach = L::load(node.thickness);
    for (int j = 0; j < 3; ++j) {
      const F cosine =
          (n[0] * L::all(turn.column[j][0]) + n[1] * L::all(turn.column[j][1])) + n[2] * L::all(turn.column[j][2]);
      reach = reach + L::abs(cosine) * L::all(box.half[j]);
    }
    gap = L::max(gap, L::abs(along - L::load(node.offset)) - reach);
  }
  for (int j = 0; j < 3; ++j) {  // the box's own axes
    const F along =
        (d[0] * L::all(turn.column[j][0]) + d[1] * L::all(turn.column[j][1])) + d[2] * L::all(turn.column[j][2]);
    const F reach = (h[0] * L::all(turn.abs_column[j][0]) + h[1] * L::all(turn.abs_column[j][1])) +
                    h[2] * L::all(turn.abs_column[j][2]);
    const F one = L::abs(along) - (reach + L::all(box.half[j]));
    gap = L::max(gap, one);
    if constexpr (far)
      squares = j == 0 ? L::max(one, none) * L::max(one, none) : squares + L::max(one, none) * L::max(one, none);
  }
  if constexpr (far) gap = L::max(gap, L::root(squares) * L::all(0.999999F));
  return gap;
}

/// What orders a search: log2 of how deep the volumes of each lane overlap along the axis that nearly separates them,
/// relative to how thick both surfaces are. Surfaces that fill their slabs evenly meet with a probability that grows
/// with it; on near-contact poses it leads to a hit in fewer steps than the kinematic rate does, at a fifth of its
/// cost. Lanes that do not overlap get a very negative number.
template <class L>
ODDS_LANES_INLINE typename L::Float ranks(const WideNode& node, const TurnedBox& box, typename L::Float gap) noexcept {
  constexpr float least = 1e-30F;
  const typename L::Float depth = L::max(L::all(0.0F) - gap, L::all(least));
  const typename L::Float thickness = L::max(L::load(node.thickness) + L::all(box.thickness), L::all(least));
  return lanes::rough_log2<L>(L::divide(depth, thickness));
}

/// For each triangle of leaf B the triangles of leaf A that it may meet, as bits.
struct LeafPairs {
  std::uint8_t lanes_a[wide_lanes];
  std::uint32_t rows = 0;    ///< bits of B's triangles with any
  std::uint32_t tested = 0;  ///< of B's triangles compared with all of A's at once
};

template <class L>
struct EightTriangles {
  using F = typename L::Float;
  F corner[3][3];  // [corner][axis]
  F lower[3];
  F upper[3];
  F normal[3];
  F tolerance;  // of a product with the normal

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
    F longest = L::all(0.0F);
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
    tolerance = L::all(32.0F * delta) * longest * (L::all(2.0F * span) + longest);
  }
};

/// B's triangles one by one, for tests against eight of A at once.
template <class L>
struct Rows {
  alignas(64) float corner[3][3][wide_lanes];
  alignas(64) float lower[3][wide_lanes];
  alignas(64) float upper[3][wide_lanes];
  alignas(64) float normal[3][wide_lanes];
  alignas(64) float tolerance[wide_lanes];

  ODDS_LANES_INLINE explicit Rows(const EightTriangles<L>& b) noexcept {
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) L::store(corner[k][i], b.corner[k][i]);
      L::store(lower[i], b.lower[i]);
      L::store(upper[i], b.upper[i]);
      L::store(normal[i], b.normal[i]);
    }
    L::store(tolerance, b.tolerance);
  }
};

/// How far A's corners stay from the plane of one of B's triangles, times the length of its normal; 0 or less where
/// they are on both sides.
template <class L>
ODDS_LANES_INLINE typename L::Float plane_gap_of_b(const EightTriangles<L>& a, const Rows<L>& b,
                                                   unsigned row) noexcept {
  using F = typename L::Float;
  F low = L::all(0.0F);
  F high = low;
  for (int k = 0; k < 3; ++k) {
    F height = L::all(b.normal[0][row]) * (a.corner[k][0] - L::all(b.corner[0][0][row]));
    height = height + L::all(b.normal[1][row]) * (a.corner[k][1] - L::all(b.corner[0][1][row]));
    height = height + L::all(b.normal[2][row]) * (a.corner[k][2] - L::all(b.corner[0][2][row]));
    low = k == 0 ? height : L::min(low, height);
    high = k == 0 ? height : L::max(high, height);
  }
  return L::max(low, L::all(0.0F) - high);
}

/// The same of B's corners from the planes of A's triangles.
template <class L>
ODDS_LANES_INLINE typename L::Float plane_gap_of_a(const EightTriangles<L>& a, const Rows<L>& b,
                                                   unsigned row) noexcept {
  using F = typename L::Float;
  F low = L::all(0.0F);
  F high = low;
  for (int k = 0; k < 3; ++k) {
    F height = a.normal[0] * (L::all(b.corner[k][0][row]) - a.corner[0][0]);
    height = height + a.normal[1] * (L::all(b.corner[k][1][row]) - a.corner[0][1]);
    height = height + a.normal[2] * (L::all(b.corner[k][2][row]) - a.corner[0][2]);
    low = k == 0 ? height : L::min(low, height);
    high = k == 0 ? height : L::max(high, height);
  }
  return L::max(low, L::all(0.0F) - high);
}

/// One triangle against eight: false lanes are certainly apart. `slack`: error of a difference of coordinates.
template <class L>
ODDS_LANES_INLINE unsigned may_meet(const EightTriangles<L>& a, const Rows<L>& b, unsigned row, float slack) noexcept {
  unsigned mask = 0xFFU;
  for (int i = 0; i < 3; ++i) {
    mask &= L::less_equal(a.lower[i], L::all(b.upper[i][row] + slack)) &
            L::less_equal(L::all(b.lower[i][row] - slack), a.upper[i]);
  }
  if (mask == 0) return 0;
  mask &= L::less_equal(plane_gap_of_b<L>(a, b, row), L::all(b.tolerance[row]));
  if (mask == 0) return 0;
  return mask & L::less_equal(plane_gap_of_a<L>(a, b, row), a.tolerance);
}

/// Two leaves in A's frame, about the centre of A's lane.
template <class L>
struct TwoLeaves {
  EightTriangles<L> a;
  EightTriangles<L> b;
  float delta;  ///< error of a coordinate
  float span;   ///< bound of all coordinates
  unsigned lanes_a;
  unsigned lanes_b;
};

/// `shift`: where B's leaf centre stands from A's, in A's frame; `margin`: that of the encounter. A's corners and all
/// planes are left to the caller.
template <class L>
ODDS_LANES_INLINE void place_b(TwoLeaves<L>& leaves, const WideLeaf& leaf_b, const WideNode& node_a,
                               std::uint32_t lane_a, const WideNode& node_b, std::uint32_t lane_b, const Turn& turn,
                               const float shift[3], float margin) noexcept {
  using F = typename L::Float;
  for (int k = 0; k < 3; ++k) {
    F x[3];
    for (int i = 0; i < 3; ++i) x[i] = L::load(leaf_b.corner[k][i]);
    for (int i = 0; i < 3; ++i) {
      leaves.b.corner[k][i] =
          ((L::all(turn.column[0][i]) * x[0] + L::all(turn.column[1][i]) * x[1]) + L::all(turn.column[2][i]) * x[2]) +
          L::all(shift[i]);
    }
  }
  leaves.b.bound();
  // B's box reaches at most this far from A's centre, and each coordinate errs by at most `delta`: half a rounding of
  // A, half of B and of the rotation times the box, three products and sums.
  float span = 0.0F;
  for (int i = 0; i < 3; ++i) {
    const float extent =
        (turn.abs_column[0][i] * node_b.half[0][lane_b] + turn.abs_column[1][i] * node_b.half[1][lane_b]) +
        turn.abs_column[2][i] * node_b.half[2][lane_b];
    const float away = shift[i] < 0.0F ? -shift[i] : shift[i];
    span = std::max(span, std::max(node_a.half[i][lane_a], away + extent));
  }
  leaves.span = span + margin;
  leaves.delta = 12.0F * 0x1p-24F * leaves.span;
  leaves.lanes_a = (2U << (node_a.child[lane_a].count() - 1U)) - 1U;
  leaves.lanes_b = (2U << (node_b.child[lane_b].count() - 1U)) - 1U;
}

template <class L>
ODDS_LANES_INLINE void place_a(TwoLeaves<L>& leaves, const WideLeaf& leaf_a) noexcept {
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 3; ++i) leaves.a.corner[k][i] = L::load(leaf_a.corner[k][i]);
  }
  leaves.a.bound();
  leaves.a.find_planes(leaves.delta, leaves.span);
  leaves.b.find_planes(leaves.delta, leaves.span);
}

/// Pairs of triangles of two leaves that no box, no plane separates.
template <class L>
ODDS_LANES_INLINE LeafPairs leaf_pairs(const WideLeaf& leaf_a, const WideLeaf& leaf_b, const WideNode& node_a,
                                       std::uint32_t lane_a, const WideNode& node_b, std::uint32_t lane_b,
                                       const Turn& turn, const float shift[3], float margin) noexcept {
  LeafPairs found;
  TwoLeaves<L> leaves;
  place_b(leaves, leaf_b, node_a, lane_a, node_b, lane_b, turn, shift, margin);
  const float delta = leaves.delta;
  unsigned rows = leaves.lanes_b;
  for (int i = 0; i < 3; ++i) {  // only B's triangles that come near A's box
    const float half = node_a.half[i][lane_a] + delta;
    rows &= L::less_equal(leaves.b.lower[i], L::all(half)) & L::less_equal(L::all(-half), leaves.b.upper[i]);
  }
  if (rows == 0) return found;
  place_a(leaves, leaf_a);
  const Rows<L> b(leaves.b);
  for (unsigned left = rows; left != 0; left &= left - 1U) {
    const auto row = static_cast<unsigned>(__builtin_ctz(left));
    const unsigned met = leaves.lanes_a & may_meet<L>(leaves.a, b, row, 2.0F * delta);
    ++found.tested;
    if (met == 0) continue;
    found.lanes_a[row] = static_cast<std::uint8_t>(met);
    found.rows |= 1U << row;
  }
  return found;
}

/// For each of B's triangles (rows) and A's (lanes) a lower bound of their distance, from boxes and planes; 0 or less
/// says nothing. Metres. Lanes and rows beyond the leaves' counts say nothing.
template <class L>
ODDS_LANES_INLINE void triangle_gaps(const WideLeaf& leaf_a, const WideLeaf& leaf_b, const WideNode& node_a,
                                     std::uint32_t lane_a, const WideNode& node_b, std::uint32_t lane_b,
                                     const Turn& turn, const float shift[3], float margin,
                                     float (&gaps)[wide_lanes][wide_lanes]) noexcept {
  using F = typename L::Float;
  TwoLeaves<L> leaves;
  place_b(leaves, leaf_b, node_a, lane_a, node_b, lane_b, turn, shift, margin);
  place_a(leaves, leaf_a);
  const Rows<L> b(leaves.b);
  const EightTriangles<L>& a = leaves.a;
  const F length_a = L::root((a.normal[0] * a.normal[0] + a.normal[1] * a.normal[1]) + a.normal[2] * a.normal[2]);
  const F inverse_a = L::divide(L::all(0.999999F), L::max(length_a, L::all(1e-18F)));
  const F slack = L::all(2.0F * leaves.delta);
  for (unsigned row = 0; row < node_b.child[lane_b].count(); ++row) {
    F squares = L::all(0.0F);  // boxes apart along several axes are apart by their legs
    for (int i = 0; i < 3; ++i) {
      const F leg = L::max(L::all(b.lower[i][row]) - a.upper[i], a.lower[i] - L::all(b.upper[i][row])) - slack;
      squares = squares + L::max(leg, L::all(0.0F)) * L::max(leg, L::all(0.0F));
    }
    F gap = L::root(squares) * L::all(0.999999F);
    const float length_b = std::sqrt((b.normal[0][row] * b.normal[0][row] + b.normal[1][row] * b.normal[1][row]) +
                                     b.normal[2][row] * b.normal[2][row]);
    if (length_b > 1e-18F) {  // shorter ones have lost digits to underflow
      const F planes_b = plane_gap_of_b<L>(a, b, row) - L::all(b.tolerance[row]);
      gap = L::max(gap, planes_b * L::all(0.999999F / length_b));
    }
    const F planes_a = plane_gap_of_a<L>(a, b, row) - a.tolerance;
    gap = L::max(gap, planes_a * inverse_a);
    L::store(gaps[row], gap);
  }
}

/// The least of these.
template <class L>
ODDS_LANES_INLINE float leaf_gap(const WideLeaf& leaf_a, const WideLeaf& leaf_b, const WideNode& node_a,
                                 std::uint32_t lane_a, const WideNode& node_b, std::uint32_t lane_b, const Turn& turn,
                                 const float shift[3], float margin) noexcept {
  alignas(64) float gaps[wide_lanes][wide_lanes];
  triangle_gaps<L>(leaf_a, leaf_b, node_a, lane_a, node_b, lane_b, turn, shift, margin, gaps);
  typename L::Float least = L::load(gaps[0]);
  for (unsigned row = 1; row < node_b.child[lane_b].count(); ++row) least = L::min(least, L::load(gaps[row]));
  alignas(64) float of[wide_lanes];
  L::store(of, least);
  float smallest = of[0];
  for (std::uint32_t lane = 1; lane < node_a.child[lane_a].count(); ++lane) smallest = std::min(smallest, of[lane]);
  return smallest;
}

}  // namespace odds::query::wide
