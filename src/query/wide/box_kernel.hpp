// The inner loop of the wide engine: one bounding volume against eight.
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
  float half[3];        ///< along its own axes, the columns of u
  float own_normal[3];  ///< the normal in its own axes
  float offset;
  float thickness;
  float shifted;  ///< where the slab's middle stands from the box's, along the normal
};

ODDS_LANES_INLINE TurnedBox turn(const WideNode& node, std::uint32_t lane, const Turn& turn) noexcept {
  TurnedBox box;
  const Vector(&u)[3] = turn.column;
  const Vector(&au)[3] = turn.abs_column;
  for (int i = 0; i < 3; ++i) {
    box.half[i] = node.half[i][lane];
    box.own_normal[i] = node.normal[i][lane];
  }
  box.center = ((u[0] * node.center[0][lane] + u[1] * node.center[1][lane]) + u[2] * node.center[2][lane]) + turn.t;
  box.extent = (au[0] * box.half[0] + au[1] * box.half[1]) + au[2] * box.half[2];
  box.normal = (u[0] * node.normal[0][lane] + u[1] * node.normal[1][lane]) + u[2] * node.normal[2][lane];
  const Vector along = box.normal * turn.t;
  box.offset = ((along[0] + along[1]) + along[2]) + node.offset[lane];
  box.thickness = node.thickness[lane];
  box.shifted =
      node.offset[lane] - ((box.own_normal[0] * node.center[0][lane] + box.own_normal[1] * node.center[1][lane]) +
                           box.own_normal[2] * node.center[2][lane]);
  return box;
}

/// Size that decides which side to descend into: half the box's diagonal, squared.
ODDS_LANES_INLINE float squared_radius(const WideNode& node, std::uint32_t lane) noexcept {
  const float x = node.half[0][lane];
  const float y = node.half[1][lane];
  const float z = node.half[2][lane];
  return x * x + y * y + z * z;
}

/// Along one slab's normal n the other volume reaches no farther than its own slab and box let it: with its normal m
/// and cosine = n . m, n = cosine m + rest, and it is bounded along m by its slab and along the rest by its box. `c`,
/// `h` are the lanes' centres and half extents.
template <class L>
ODDS_LANES_INLINE typename L::Float slab_gaps(const WideNode& node, const TurnedBox& box, const Turn& turn,
                                              const typename L::Float (&c)[3],
                                              const typename L::Float (&h)[3]) noexcept {
  using F = typename L::Float;
  F n[3];
  for (int i = 0; i < 3; ++i) n[i] = L::load(node.normal[i]);
  const F cosine = (L::all(box.normal[0]) * n[0] + L::all(box.normal[1]) * n[1]) + L::all(box.normal[2]) * n[2];
  const F thickness = L::load(node.thickness);
  F gap;
  {  // the box's slab
    const F along = (L::all(box.normal[0]) * c[0] + L::all(box.normal[1]) * c[1]) + L::all(box.normal[2]) * c[2];
    const F shifted = L::load(node.offset) - ((n[0] * c[0] + n[1] * c[1]) + n[2] * c[2]);
    F reach = L::abs(cosine) * thickness;
    for (int i = 0; i < 3; ++i) reach = reach + L::abs(L::all(box.normal[i]) - cosine * n[i]) * h[i];
    gap = L::abs((along + cosine * shifted) - L::all(box.offset)) - (reach + L::all(box.thickness));
  }
  {  // the lanes' slabs
    const F along = (n[0] * L::all(box.center[0]) + n[1] * L::all(box.center[1])) + n[2] * L::all(box.center[2]);
    F reach = L::abs(cosine) * L::all(box.thickness);
    for (int j = 0; j < 3; ++j) {
      const F own =
          (n[0] * L::all(turn.column[j][0]) + n[1] * L::all(turn.column[j][1])) + n[2] * L::all(turn.column[j][2]);
      reach = reach + L::abs(own - cosine * L::all(box.own_normal[j])) * L::all(box.half[j]);
    }
    const F one = L::abs((along + cosine * L::all(box.shifted)) - L::load(node.offset)) - (reach + thickness);
    return L::max(gap, one);
  }
}

/// Whether slabs are looked at: always, but for programs that measure what they are worth and specialise this.
template <class L>
inline constexpr bool looks_at_slabs = true;

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
  if constexpr (looks_at_slabs<L>) gap = L::max(gap, slab_gaps<L>(node, box, turn, c, h));
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

}  // namespace odds::query::wide
