// How far what is in a node, or in a leaf, reaches along a direction.
#pragma once

#include "odds/math/types.hpp"
#include "odds/tree/wide_tree.hpp"
#include "query/wide/lanes.hpp"

namespace odds::query::wide {

/// Of direction . x, in the tree's frame, of each child of a node or each triangle of a leaf; off by the rounding of
/// three products and their sum. Of lanes that are not used they say nothing.
struct Extents {
  alignas(64) float least[tree::wide_lanes];
  alignas(64) float greatest[tree::wide_lanes];
};

template <class L>
class ExtentsKernel {
 public:
  static void children(const tree::WideNode& node, const Vec3f& direction, Extents& extents) noexcept {
    F middle = L::all(0.0F);
    F reach = L::all(0.0F);
    for (int i = 0; i < 3; ++i) {
      const F along = L::all(direction[i]);
      middle = middle + along * L::load(node.center[i]);
      reach = reach + L::abs(along) * L::load(node.half[i]);
    }
    L::store(extents.least, middle - reach);
    L::store(extents.greatest, middle + reach);
  }

  /// The corners are given from `center`.
  static void triangles(const tree::WideLeaf& leaf, const Vec3f& center, const Vec3f& direction,
                        Extents& extents) noexcept {
    const F from = L::all(direction[0] * center[0] + direction[1] * center[1] + direction[2] * center[2]);
    F at[3];
    for (int corner = 0; corner < 3; ++corner) {
      at[corner] = from;
      for (int i = 0; i < 3; ++i) at[corner] = at[corner] + L::all(direction[i]) * L::load(leaf.corner[corner][i]);
    }
    L::store(extents.least, L::min(L::min(at[0], at[1]), at[2]));
    L::store(extents.greatest, L::max(L::max(at[0], at[1]), at[2]));
  }

 private:
  using F = typename L::Float;
};

}  // namespace odds::query::wide
