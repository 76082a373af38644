// How two leaves are parted: by what they are apart, and by a plane.
#pragma once

#include <limits>

#include "query/wide/parting_plane.hpp"
#include "query/wide/triangle_kernel.hpp"

namespace odds::query::wide {

/// Of two corners, as seen along a direction at most 1 long: either errs by sqrt(3) delta, and the sum of three
/// products by less than delta.
template <class L>
[[nodiscard]] ODDS_LANES_INLINE float slack_of(const TwoLeaves<L>& leaves) noexcept {
  return 8.0F * leaves.delta;
}

/// See `triangle_gaps`; and the least of them, and whose it is.
template <class L>
struct GapsOfTriangles {
  alignas(64) float of[wide_lanes][wide_lanes];
  unsigned rows;
  float least;
  unsigned row = 0;
  unsigned lane = 0;

  ODDS_LANES_INLINE GapsOfTriangles(const SpreadLeaves<L>& leaves, unsigned count_of_b) noexcept : rows(count_of_b) {
    triangle_gaps<L>(leaves, rows, of);
    least = of[0][0];
    for (unsigned of_b = 0; of_b < rows; ++of_b) {
      const unsigned of_a = L::least(L::load(of[of_b])) % wide_lanes;  // 8 stands for none, if all are NaN
      if (of[of_b][of_a] < least) {
        least = of[of_b][of_a];
        row = of_b;
        lane = of_a;
      }
    }
  }
};

/// One leaf's corners along eight normals.
template <class L>
struct Reach {
  typename L::Float low;
  typename L::Float high;

  /// `triangles`: how many of the leaf's lanes are used.
  ODDS_LANES_INLINE Reach(const float (&corner)[3][3][wide_lanes], unsigned triangles,
                          const typename L::Float (&normal)[3]) noexcept {
    for (unsigned i = 0; i < triangles; ++i) {
      for (int k = 0; k < 3; ++k) {
        const typename L::Float along = (normal[0] * L::all(corner[k][0][i]) + normal[1] * L::all(corner[k][1][i])) +
                                        normal[2] * L::all(corner[k][2][i]);
        const bool first = i == 0 && k == 0;
        low = first ? along : L::min(low, along);
        high = first ? along : L::max(high, along);
      }
    }
  }
};

/// Of the planes of both leaves' triangles the one that parts all of both most, if one does.
template <class L>
ODDS_LANES_INLINE void part_by_triangles(const SpreadLeaves<L>& spread, unsigned count_a, unsigned count_b,
                                         Parting& parting) noexcept {
  using F = typename L::Float;
  const TwoLeaves<L>& leaves = spread.leaves;
  alignas(64) float corner_a[3][3][wide_lanes];
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 3; ++i) L::store(corner_a[k][i], leaves.a.corner[k][i]);
  }
  const F zero = L::all(0.0F);
  alignas(64) float of[wide_lanes];
  float best = 0.0F;
  for (const EightTriangles<L>* eight : {&leaves.a, &leaves.b}) {
    const F length = eight->lengths_of_normals();
    const F inverse = L::divide(L::all(just_below_one), L::max(length, L::all(shortest_normal)));
    const Reach<L> a(corner_a, count_a, eight->normal);
    const Reach<L> b(spread.rows_of_b.corner, count_b, eight->normal);
    const F above = b.low - a.high;
    const F gap =
        L::choose(L::less_equal(L::all(shortest_normal), length), L::max(above, a.low - b.high) * inverse, zero);
    const unsigned lane = L::least(zero - gap);
    L::store(of, gap);
    if (!(of[lane] > best)) continue;
    best = of[lane];
    const bool upwards = (L::less_equal(zero, above) >> lane & 1U) != 0;
    for (int i = 0; i < 3; ++i) {
      L::store(of, eight->normal[i] * inverse);
      parting.normal[i] = upwards ? of[lane] : -of[lane];
    }
  }
  parting.along = (best - slack_of(leaves)) / leaves.scale;
  parting.beside = std::numeric_limits<float>::max();
  parting.parts = parting.along > 0.0F;
}

/// The plane normal to the shortest way from A to B between the two nearest triangles. It need not part all pairs of
/// triangles: the others count with what they are apart, whatever way B moves.
template <class L>
ODDS_LANES_INLINE void part_by_nearest(const SpreadLeaves<L>& spread, const GapsOfTriangles<L>& gaps,
                                       const Vec3& shortest_way, Parting& parting) noexcept {
  using F = typename L::Float;
  constexpr float most = std::numeric_limits<float>::max();
  constexpr double enough = 0.5;  // of what the nearest are apart
  const double length = shortest_way.norm();
  if (!(length > 0.0)) return;
  F normal[3];
  for (int i = 0; i < 3; ++i) {
    parting.normal[i] = static_cast<float>(shortest_way[i] / length * (1.0 - 0x1p-22));
    normal[i] = L::all(parting.normal[i]);
  }
  const auto along = [&normal](const F(&x)[3]) noexcept {
    return (normal[0] * x[0] + normal[1] * x[1]) + normal[2] * x[2];
  };
  const TwoLeaves<L>& leaves = spread.leaves;
  const F(&a)[3][3] = leaves.a.corner;
  const F(&b)[3][3] = leaves.b.corner;
  const F highest = L::max(L::max(along(a[0]), along(a[1])), along(a[2]));
  alignas(64) float lowest[wide_lanes];
  L::store(lowest, L::min(L::min(along(b[0]), along(b[1])), along(b[2])));
  const F slack = L::all(slack_of(leaves));
  const F unscale = L::all(1.0F / leaves.scale);
  const F least = L::all(static_cast<float>(enough * length));
  F parted = L::all(most);
  F beside = L::all(most);
  for (unsigned row = 0; row < gaps.rows; ++row) {
    const F plane = ((L::all(lowest[row]) - highest) - slack) * unscale;
    const unsigned by_plane = L::less_equal(least, plane);
    parted = L::min(parted, L::choose(by_plane, plane, L::all(most)));
    beside = L::min(beside, L::choose(by_plane, L::all(most), L::load(gaps.of[row])));
  }
  parting.along = L::least_value(parted);
  parting.beside = L::least_value(beside);
  parting.parts = parting.along > 0.0F && parting.beside > 0.0F;
}

}  // namespace odds::query::wide
