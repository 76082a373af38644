// The inner loop of the wide engine: one bounding volume against eight.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
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

/// The numbers of one lane, found by the address of the first: arrays of a node follow each other.
class LaneNumbers {
 public:
  ODDS_LANES_INLINE LaneNumbers(const WideNode& node, std::uint32_t lane) noexcept
      : first_(&node.center[0][0] + lane) {}
  ODDS_LANES_INLINE explicit LaneNumbers(const float* first) noexcept : first_(first) {}

  [[nodiscard]] ODDS_LANES_INLINE float center(int i) const noexcept { return at(offsetof(WideNode, center), i); }
  [[nodiscard]] ODDS_LANES_INLINE float half(int i) const noexcept { return at(offsetof(WideNode, half), i); }
  [[nodiscard]] ODDS_LANES_INLINE float normal(int i) const noexcept { return at(offsetof(WideNode, normal), i); }
  [[nodiscard]] ODDS_LANES_INLINE float offset() const noexcept { return at(offsetof(WideNode, offset), 0); }
  [[nodiscard]] ODDS_LANES_INLINE float thickness() const noexcept { return at(offsetof(WideNode, thickness), 0); }
  [[nodiscard]] ODDS_LANES_INLINE tree::ChildRef child() const noexcept {
    return *reinterpret_cast<const tree::ChildRef*>(first_ + offsetof(WideNode, child) / sizeof(float));
  }

 private:
  [[nodiscard]] ODDS_LANES_INLINE float at(std::size_t array, int i) const noexcept {
    return first_[array / sizeof(float) + static_cast<std::size_t>(i) * wide_lanes];
  }

  const float* first_;
};

/// The numbers of a turn, each put in every lane where it is used.
template <class L>
struct TurnNumbers {
  using F = typename L::Float;
  const Turn& turn;

  [[nodiscard]] ODDS_LANES_INLINE F of(int j, int i) const noexcept { return L::all(turn.column[j][i]); }
  [[nodiscard]] ODDS_LANES_INLINE F abs_of(int j, int i) const noexcept { return L::all(turn.abs_column[j][i]); }
  [[nodiscard]] ODDS_LANES_INLINE F t(int i) const noexcept { return L::all(turn.t[i]); }
};

/// The same for a search that opens many pairs: they stand in every lane in memory, where kernels read them as
/// operands.
template <class L>
struct alignas(64) TurnLanes {
  using F = typename L::Float;
  float column[3][3][wide_lanes];  ///< [j][i]: i-th component of the j-th column
  float abs_column[3][3][wide_lanes];
  float translation[3][wide_lanes];

  ODDS_LANES_INLINE explicit TurnLanes(const Turn& turn) noexcept {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        L::store(column[j][i], L::all(turn.column[j][i]));
        L::store(abs_column[j][i], L::all(turn.abs_column[j][i]));
      }
      L::store(translation[i], L::all(turn.t[i]));
    }
  }
  [[nodiscard]] ODDS_LANES_INLINE F of(int j, int i) const noexcept { return L::load(column[j][i]); }
  [[nodiscard]] ODDS_LANES_INLINE F abs_of(int j, int i) const noexcept { return L::load(abs_column[j][i]); }
  [[nodiscard]] ODDS_LANES_INLINE F t(int i) const noexcept { return L::load(translation[i]); }
};

/// What a kernel compares: a box with the lanes of one node. Everything of the box and of the turn into the node's tree
/// is one number in all lanes. See two_pairs.hpp for two boxes, each with a node of its own.
template <class L, class TurnOf = TurnNumbers<L>>
struct OnePair {
  using F = typename L::Float;
  using Lanes = L;
  using Turned = TurnOf;

  /// In the box's own tree frame.
  struct Boxes {
    LaneNumbers numbers;

    [[nodiscard]] ODDS_LANES_INLINE F center(int i) const noexcept { return L::all(numbers.center(i)); }
    [[nodiscard]] ODDS_LANES_INLINE F half(int i) const noexcept { return L::all(numbers.half(i)); }
    [[nodiscard]] ODDS_LANES_INLINE F normal(int i) const noexcept { return L::all(numbers.normal(i)); }
    [[nodiscard]] ODDS_LANES_INLINE F offset() const noexcept { return L::all(numbers.offset()); }
    [[nodiscard]] ODDS_LANES_INLINE F thickness() const noexcept { return L::all(numbers.thickness()); }
  };
  struct Nodes {
    const WideNode& node;

    [[nodiscard]] ODDS_LANES_INLINE F center(int i) const noexcept { return L::load(node.center[i]); }
    [[nodiscard]] ODDS_LANES_INLINE F half(int i) const noexcept { return L::load(node.half[i]); }
    [[nodiscard]] ODDS_LANES_INLINE F normal(int i) const noexcept { return L::load(node.normal[i]); }
    [[nodiscard]] ODDS_LANES_INLINE F offset() const noexcept { return L::load(node.offset); }
    [[nodiscard]] ODDS_LANES_INLINE F thickness() const noexcept { return L::load(node.thickness); }
  };
};

/// Size that decides which side to descend into: half the box's diagonal, squared.
ODDS_LANES_INLINE float squared_radius(const LaneNumbers& lane) noexcept {
  return (lane.half(0) * lane.half(0) + lane.half(1) * lane.half(1)) + lane.half(2) * lane.half(2);
}

/// Where boxes stand in the frame of the nodes that they are compared with.
template <class K>
struct Placed {
  using F = typename K::F;
  F d[3];      ///< the boxes' centres from the lanes'
  F h[3];      ///< half extents of the lanes
  F own_h[3];  ///< half extents of the boxes, along their own axes

  ODDS_LANES_INLINE Placed(const typename K::Nodes& nodes, const typename K::Boxes& boxes,
                           const typename K::Turned& turn) noexcept {
    F center[3];
    for (int j = 0; j < 3; ++j) {
      center[j] = boxes.center(j);
      own_h[j] = boxes.half(j);
    }
    for (int i = 0; i < 3; ++i) {
      h[i] = nodes.half(i);
      d[i] = ((turn.of(0, i) * center[0] + turn.of(1, i) * center[1]) + (turn.of(2, i) * center[2] + turn.t(i))) -
             nodes.center(i);
    }
  }
};

/// Along one slab's normal n the other volume reaches no farther than its own slab and box let it: with its normal m
/// and cosine = n . m, n = cosine m + rest, and it is bounded along m by its slab and along the rest by its box.
template <class K>
ODDS_LANES_INLINE typename K::F slab_gaps(const typename K::Nodes& nodes, const typename K::Boxes& boxes,
                                          const typename K::Turned& turn, const Placed<K>& placed) noexcept {
  using F = typename K::F;
  using L = typename K::Lanes;
  F own_m[3];
  F m[3];
  F n[3];
  for (int j = 0; j < 3; ++j) own_m[j] = boxes.normal(j);
  for (int i = 0; i < 3; ++i) {
    m[i] = (turn.of(0, i) * own_m[0] + turn.of(1, i) * own_m[1]) + turn.of(2, i) * own_m[2];
    n[i] = nodes.normal(i);
  }
  const F cosine = (m[0] * n[0] + m[1] * n[1]) + m[2] * n[2];
  const F steep = L::abs(cosine);
  const F thickness = nodes.thickness();
  const F box_thickness = boxes.thickness();
  const F offset = nodes.offset();
  const F box_offset = boxes.offset();
  const F(&d)[3] = placed.d;
  F rest[3];
  // The boxes' slabs.
  for (int i = 0; i < 3; ++i) rest[i] = L::abs(m[i] - cosine * n[i]) * placed.h[i];
  const F along_m = ((m[0] * d[0] + m[1] * d[1]) + (m[2] * d[2] + box_offset)) - cosine * offset;
  const F gap = L::abs(along_m) - ((steep * thickness + box_thickness) + ((rest[0] + rest[1]) + rest[2]));
  // The lanes' slabs.
  for (int j = 0; j < 3; ++j) {
    const F own = (n[0] * turn.of(j, 0) + n[1] * turn.of(j, 1)) + n[2] * turn.of(j, 2);
    rest[j] = L::abs(own - cosine * own_m[j]) * placed.own_h[j];
  }
  const F along_n = ((n[0] * d[0] + n[1] * d[1]) + (n[2] * d[2] - offset)) + cosine * box_offset;
  return L::max(gap, L::abs(along_n) - ((steep * box_thickness + thickness) + ((rest[0] + rest[1]) + rest[2])));
}

/// Whether slabs are looked at: always, but for programs that measure what they are worth and specialise this.
template <class L>
inline constexpr bool looks_at_slabs = true;

/// Separating axes: the three of each box and the normals of both slabs (the nine edge pairs never paid). The gap along
/// any axis of length at most 1 bounds the distance from below, up to the rounding that `margin` of the encounter
/// covers. `far`: the three gaps of each frame's axes also count together, as the legs of a distance; for boxes that
/// are apart by more than their sizes that is what bounds it.
template <class K, bool far = false>
ODDS_LANES_INLINE typename K::F gaps(const typename K::Nodes& nodes, const typename K::Boxes& boxes,
                                     const typename K::Turned& turn, const Placed<K>& placed) noexcept {
  using F = typename K::F;
  using L = typename K::Lanes;
  const F(&d)[3] = placed.d;
  const F(&h)[3] = placed.h;
  const F(&own_h)[3] = placed.own_h;
  // The longest chain of sums first: what ends a search's wait for a pair is the end of that.
  F of_slabs = L::all(0.0F);
  if constexpr (looks_at_slabs<L>) of_slabs = slab_gaps<K>(nodes, boxes, turn, placed);
  F one[3];
  const auto legs = [&one]() noexcept {
    const F none = L::all(0.0F);
    F squares = L::max(one[0], none) * L::max(one[0], none);
    for (int i = 1; i < 3; ++i) squares = squares + L::max(one[i], none) * L::max(one[i], none);
    return L::root(squares) * L::all(0.999999F);
  };
  for (int i = 0; i < 3; ++i) {  // the lanes' axes
    const F extent = (turn.abs_of(0, i) * own_h[0] + turn.abs_of(1, i) * own_h[1]) + turn.abs_of(2, i) * own_h[2];
    one[i] = L::abs(d[i]) - (h[i] + extent);
  }
  F gap = L::max(L::max(one[0], one[1]), one[2]);
  if constexpr (far) gap = L::max(gap, legs());
  for (int j = 0; j < 3; ++j) {  // the boxes' own axes
    const F along = (d[0] * turn.of(j, 0) + d[1] * turn.of(j, 1)) + d[2] * turn.of(j, 2);
    const F reach = (h[0] * turn.abs_of(j, 0) + h[1] * turn.abs_of(j, 1)) + (h[2] * turn.abs_of(j, 2) + own_h[j]);
    one[j] = L::abs(along) - reach;
  }
  gap = L::max(gap, L::max(L::max(one[0], one[1]), one[2]));
  if constexpr (far) gap = L::max(gap, legs());
  if constexpr (looks_at_slabs<L>) gap = L::max(gap, of_slabs);
  return gap;
}

/// What orders a search: log2 of how deep the volumes of each lane overlap along the axis that nearly separates them,
/// relative to how thick both surfaces are. Surfaces that fill their slabs evenly meet with a probability that grows
/// with it; on near-contact poses it leads to a hit in fewer steps than the kinematic rate does, at a fifth of its
/// cost. Lanes that do not overlap get a very negative number.
template <class K>
ODDS_LANES_INLINE typename K::F ranks(const typename K::Nodes& nodes, const typename K::Boxes& boxes,
                                      typename K::F gap) noexcept {
  using F = typename K::F;
  using L = typename K::Lanes;
  constexpr float least = 1e-30F;
  const F depth = L::max(L::all(0.0F) - gap, L::all(least));
  const F thickness = L::max(nodes.thickness() + boxes.thickness(), L::all(least));
  return lanes::rough_log2<L>(L::divide(depth, thickness));
}

}  // namespace odds::query::wide
