// Half-spaces that bound a convex region, against the boxes of a node and the triangles of a leaf.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "odds/math/types.hpp"
#include "odds/tree/wide_tree.hpp"
#include "query/wide/lanes.hpp"

namespace odds::query::wide {

/// {x : normal . x <= offset}, in the tree's frame, metres; normals at most 1 long. What is beyond one by no more than
/// `margin`, which holds the rounding of these floats, counts as within.
struct HalfSpaces {
  static constexpr std::size_t most = 63;
  /// A bit for each.
  using Sides = std::uint64_t;

  float normal[most][3];
  float offset[most];
  std::size_t count = 0;
  float margin = 0.0F;       ///< >= 0
  float well_within = 0.0F;  ///< >= margin; what is as far within as this is surely within

  [[nodiscard]] Sides all() const noexcept { return (Sides{1} << count) - 1; }
};

/// Which lanes are not beyond, and which half-spaces may still cut each of those.
struct LanesWithin {
  unsigned lanes;
  HalfSpaces::Sides sides[tree::wide_lanes];
};

template <class L>
class HalfSpaceKernel {
 public:
  /// The children of a node against those half-spaces of `sides`.
  static void children(const tree::WideNode& node, const HalfSpaces& spaces, HalfSpaces::Sides sides,
                       LanesWithin& within) noexcept {
    const F center[3] = {L::load(node.center[0]), L::load(node.center[1]), L::load(node.center[2])};
    const F half[3] = {L::load(node.half[0]), L::load(node.half[1]), L::load(node.half[2])};
    const unsigned used = L::less_equal(L::all(0.0F), half[0]);
    sift(spaces, sides, used, within, [&](const float* normal, const F& offset) -> Reach {
      const F n[3] = {L::all(normal[0]), L::all(normal[1]), L::all(normal[2])};
      const F middle = n[0] * center[0] + n[1] * center[1] + n[2] * center[2] - offset;
      const F reach = L::abs(n[0]) * half[0] + L::abs(n[1]) * half[1] + L::abs(n[2]) * half[2];
      return {middle - reach, middle + reach};
    });
  }

  /// The first `count` triangles of a leaf, whose corners are given from `center`.
  static void triangles(const tree::WideLeaf& leaf, unsigned count, const Vec3f& center, const HalfSpaces& spaces,
                        HalfSpaces::Sides sides, LanesWithin& within) noexcept {
    const unsigned used = (1U << count) - 1U;
    sift(spaces, sides, used, within, [&](const float* normal, const F& offset) -> Reach {
      const F n[3] = {L::all(normal[0]), L::all(normal[1]), L::all(normal[2])};
      const F from = L::all(normal[0] * center[0] + normal[1] * center[1] + normal[2] * center[2]) - offset;
      F height[3];
      for (int corner = 0; corner < 3; ++corner) {
        height[corner] = n[0] * L::load(leaf.corner[corner][0]) + n[1] * L::load(leaf.corner[corner][1]) +
                         n[2] * L::load(leaf.corner[corner][2]);
      }
      return {from + L::min(L::min(height[0], height[1]), height[2]),
              from + L::max(L::max(height[0], height[1]), height[2])};
    });
  }

 private:
  using F = typename L::Float;
  /// Above the plane of a half-space.
  struct Reach {
    F least;
    F greatest;
  };

  template <class Above>
  ODDS_LANES_INLINE static void sift(const HalfSpaces& spaces, HalfSpaces::Sides sides, unsigned lanes,
                                     LanesWithin& within, const Above& above) noexcept {
    for (HalfSpaces::Sides& of_lane : within.sides) of_lane = sides;
    const F margin = L::all(spaces.margin);
    const F well_within = L::all(-spaces.well_within);
    for (HalfSpaces::Sides left = sides; left != 0 && lanes != 0; left &= left - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(left));
      const Reach reach = above(spaces.normal[i], L::all(spaces.offset[i]));
      lanes &= L::less_equal(reach.least, margin);
      for (unsigned inner = lanes & L::less_equal(reach.greatest, well_within); inner != 0; inner &= inner - 1U) {
        within.sides[std::countr_zero(inner)] &= ~(HalfSpaces::Sides{1} << i);
      }
    }
    within.lanes = lanes;
  }
};

}  // namespace odds::query::wide
