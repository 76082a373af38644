// How near the boxes of a node, and the triangles of a leaf, may be to a segment.
#pragma once

#include <cstdint>
#include <limits>

#include "odds/math/types.hpp"
#include "odds/tree/wide_tree.hpp"
#include "query/wide/lanes.hpp"

namespace odds::query::wide {

/// {middle + t * half, -1 <= t <= 1}, in the tree's frame, metres; a point where `half` is zero.
struct SegmentInTree {
  Vec3f middle;
  Vec3f half;
  float inverse_square = 0.0F;  ///< 1 / |half|^2; 0 of a point
};

/// Writes lower bounds of distances, metres, right but for the rounding of these floats; infinity in lanes that hold
/// nothing.
template <class L>
class NearSegmentKernel {
 public:
  static void children(const tree::WideNode& node, const SegmentInTree& segment,
                       float (&least)[tree::wide_lanes]) noexcept {
    const F center[3] = {L::load(node.center[0]), L::load(node.center[1]), L::load(node.center[2])};
    const F half[3] = {L::load(node.half[0]), L::load(node.half[1]), L::load(node.half[2])};
    write(center, half, L::less_equal(L::all(0.0F), half[0]), segment, least);
  }

  /// The first `count` triangles of a leaf, by their boxes; corners are given from `from`.
  static void triangles(const tree::WideLeaf& leaf, unsigned count, const Vec3f& from, const SegmentInTree& segment,
                        float (&least)[tree::wide_lanes]) noexcept {
    F center[3];
    F half[3];
    for (int axis = 0; axis < 3; ++axis) {
      const F corner[3] = {L::load(leaf.corner[0][axis]), L::load(leaf.corner[1][axis]), L::load(leaf.corner[2][axis])};
      const F lower = L::min(L::min(corner[0], corner[1]), corner[2]);
      const F upper = L::max(L::max(corner[0], corner[1]), corner[2]);
      center[axis] = L::all(from[axis]) + L::all(0.5F) * (lower + upper);
      half[axis] = L::all(0.5F) * (upper - lower);
    }
    write(center, half, (1U << count) - 1U, segment, least);
  }

 private:
  using F = typename L::Float;

  ODDS_LANES_INLINE static F squared_length(const F (&v)[3]) noexcept {
    return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  }

  // No nearer than their boxes are, nor than the balls around the boxes to the nearest points of the segment.
  ODDS_LANES_INLINE static void write(const F (&center)[3], const F (&half)[3], unsigned used,
                                      const SegmentInTree& segment, float (&least)[tree::wide_lanes]) noexcept {
    const F zero = L::all(0.0F);
    const F one = L::all(1.0F);
    F along = zero;
    F away[3];
    F gap[3];
    for (int axis = 0; axis < 3; ++axis) {
      const F own = L::all(segment.half[axis]);
      away[axis] = center[axis] - L::all(segment.middle[axis]);
      gap[axis] = L::max(L::abs(away[axis]) - half[axis] - L::abs(own), zero);
      along = along + away[axis] * own;
    }
    along = L::max(L::min(along * L::all(segment.inverse_square), one), zero - one);
    for (int axis = 0; axis < 3; ++axis) away[axis] = away[axis] - along * L::all(segment.half[axis]);
    const F from_ball = L::root(squared_length(away)) - L::root(squared_length(half));
    const F nearest = L::max(L::root(squared_length(gap)), from_ball);
    alignas(64) float written[tree::wide_lanes];
    L::store(written, L::choose(used, nearest, L::all(std::numeric_limits<float>::infinity())));
    for (unsigned lane = 0; lane < tree::wide_lanes; ++lane) least[lane] = written[lane];
  }
};

}  // namespace odds::query::wide
