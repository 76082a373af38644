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
  float inverse_length = 0.0F;  ///< 1 / |half|; 0 of a point
};

/// Writes lower bounds of distances, metres, right but for the rounding of these floats; infinity in lanes that hold
/// nothing.
template <class L>
class NearSegmentKernel {
 public:
  /// By boxes and slabs. `by_boxes`: by boxes alone, as children had best be visited: the slab of one that is far off
  /// may go on to where the segment is, and that of the nearest one does not.
  static void children(const tree::WideNode& node, const SegmentInTree& segment, float (&least)[tree::wide_lanes],
                       float (&by_boxes)[tree::wide_lanes]) noexcept {
    const F center[3] = {L::load(node.center[0]), L::load(node.center[1]), L::load(node.center[2])};
    const F half[3] = {L::load(node.half[0]), L::load(node.half[1]), L::load(node.half[2])};
    const Part part(center, half, segment);
    // Normals are no longer than 1, so heights over the middle of a slab are no more than distances.
    F height = L::load(node.offset);
    F reach = L::all(0.0F);
    for (int axis = 0; axis < 3; ++axis) {
      const F normal = L::load(node.normal[axis]);
      height = height + normal * part.to_center[axis];
      reach = reach + normal * part.half[axis];
    }
    const F from_slab = L::abs(height) - L::abs(reach) - L::load(node.thickness);
    const F from_box = part.from_box(half);
    const unsigned used = L::less_equal(L::all(0.0F), half[0]);
    write(from_box, used, by_boxes);
    write(L::max(from_box, from_slab), used, least);
  }

  /// The first `count` triangles of a leaf, by their boxes and planes; corners are given from `from`.
  static void triangles(const tree::WideLeaf& leaf, unsigned count, const Vec3f& from, const SegmentInTree& segment,
                        float (&least)[tree::wide_lanes]) noexcept {
    F corner[3][3];
    F center[3];
    F half[3];
    F square = L::all(0.0F);  // of how far any corner is from the leaf's centre, or more
    for (int axis = 0; axis < 3; ++axis) {
      for (int c = 0; c < 3; ++c) corner[c][axis] = L::load(leaf.corner[c][axis]);
      const F lower = L::min(L::min(corner[0][axis], corner[1][axis]), corner[2][axis]);
      const F upper = L::max(L::max(corner[0][axis], corner[1][axis]), corner[2][axis]);
      center[axis] = L::all(from[axis]) + L::all(0.5F) * (lower + upper);
      half[axis] = L::all(0.5F) * (upper - lower);
      const F farthest = L::max(L::abs(lower), L::abs(upper));
      square = square + farthest * farthest;
    }
    const Part part(center, half, segment);
    write(L::max(part.from_box(half), from_planes(corner, from, square, part)), (1U << count) - 1U, least);
  }

 private:
  using F = typename L::Float;

  ODDS_LANES_INLINE static F squared_length(const F (&v)[3]) noexcept {
    return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  }

  // Of the segment, what may be nearest to some point of a box: no farther from the point that is nearest to the box's
  // centre than the box's corners are from its centre.
  struct Part {
    ODDS_LANES_INLINE Part(const F (&center)[3], const F (&box_half)[3], const SegmentInTree& segment) noexcept {
      const F one = L::all(1.0F);
      radius = L::root(squared_length(box_half));
      F nearest = L::all(0.0F);
      for (int axis = 0; axis < 3; ++axis) {
        to_center[axis] = center[axis] - L::all(segment.middle[axis]);
        nearest = nearest + to_center[axis] * L::all(segment.half[axis]);
      }
      nearest = L::max(L::min(nearest * L::all(segment.inverse_square), one), L::all(0.0F) - one);
      constexpr float rounded_up = 1.0F + 1e-5F;
      const F around = radius * L::all(rounded_up * segment.inverse_length);
      const F begin = L::max(nearest - around, L::all(0.0F) - one);
      const F end = L::min(nearest + around, one);
      const F along = L::all(0.5F) * (begin + end);
      const F share = L::all(0.5F * rounded_up) * (end - begin);
      F away[3];
      for (int axis = 0; axis < 3; ++axis) {
        const F own = L::all(segment.half[axis]);
        away[axis] = to_center[axis] - nearest * own;
        middle[axis] = L::all(segment.middle[axis]) + along * own;
        to_center[axis] = to_center[axis] - along * own;
        half[axis] = share * own;
      }
      from_ball = L::root(squared_length(away)) - radius;
    }
    // No nearer than the box, nor than the ball around it.
    [[nodiscard]] ODDS_LANES_INLINE F from_box(const F (&box_half)[3]) const noexcept {
      F gap[3];
      for (int axis = 0; axis < 3; ++axis) {
        gap[axis] = L::max(L::abs(to_center[axis]) - box_half[axis] - L::abs(half[axis]), L::all(0.0F));
      }
      return L::max(L::root(squared_length(gap)), from_ball);
    }
    F middle[3];
    F half[3];
    F to_center[3];  // from the middle
    F radius;        // of the ball around the box
    F from_ball;
  };

  // Corners are rounded to single precision about the leaf's centre: by a few roundings of `square` the normals are
  // off, and by more than their length those of slivers, of which nothing is known then.
  ODDS_LANES_INLINE static F from_planes(const F (&corner)[3][3], const Vec3f& from, F square,
                                         const Part& part) noexcept {
    constexpr float lost = 4e-19F;  // of a length, where its squares underflow
    F first[3];
    F second[3];
    F to_corner[3];
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = corner[1][axis] - corner[0][axis];
      second[axis] = corner[2][axis] - corner[0][axis];
      to_corner[axis] = (L::all(from[axis]) - part.middle[axis]) + corner[0][axis];
    }
    const F normal[3] = {first[1] * second[2] - first[2] * second[1], first[2] * second[0] - first[0] * second[2],
                         first[0] * second[1] - first[1] * second[0]};
    const F off = L::all(64.0F * 0x1p-24F) * square;
    const F inverse = L::divide(L::all(1.0F), L::root(squared_length(normal)) + off + L::all(lost));
    F height = L::all(0.0F);
    F reach = L::all(0.0F);
    for (int axis = 0; axis < 3; ++axis) {
      const F direction = normal[axis] * inverse;
      height = height + direction * to_corner[axis];
      reach = reach + direction * part.half[axis];
    }
    const F way = L::root(squared_length(to_corner)) + part.radius;
    return L::abs(height) - L::abs(reach) - (off * inverse) * way;
  }

  ODDS_LANES_INLINE static void write(F nearest, unsigned used, float (&least)[tree::wide_lanes]) noexcept {
    alignas(64) float written[tree::wide_lanes];
    L::store(written, L::choose(used, nearest, L::all(std::numeric_limits<float>::infinity())));
    for (unsigned lane = 0; lane < tree::wide_lanes; ++lane) least[lane] = written[lane];
  }
};

}  // namespace odds::query::wide
