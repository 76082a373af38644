// Tells the processor what a search of a wide tree will look at soon.
#pragma once

#include <bit>
#include <cstdint>

#include "odds/mesh/triangle_mesh.hpp"
#include "odds/tree/wide_tree.hpp"
#include "query/wide/lanes.hpp"

namespace odds::query {

/// Boxes and children of a node, all of a leaf. A search that goes down a tree of megabytes waits for memory most of
/// its time; what it has put off comes meanwhile.
ODDS_LANES_INLINE void prefetch(const tree::WideTree& tree, tree::ChildRef child) noexcept {
  if (child.is_leaf()) {
    const tree::WideLeaf& leaf = tree.leaves()[child.index()];
    for (int corner = 0; corner < 3; ++corner) {
      __builtin_prefetch(&leaf.corner[corner][0]);
      __builtin_prefetch(&leaf.corner[corner][2]);
    }
    return;
  }
  const tree::WideNode& node = tree.nodes()[child.node_index()];
  __builtin_prefetch(&node.center[0]);
  __builtin_prefetch(&node.center[2]);
  __builtin_prefetch(&node.half[2]);
  __builtin_prefetch(&node.child);
}

/// What a leaf's triangles have as corners: when it is opened. A mesh's arrays are larger than its tree.
ODDS_LANES_INLINE void prefetch_triangles(const mesh::TriangleMesh& mesh, const tree::WideLeaf& leaf,
                                          std::uint32_t count) noexcept {
  for (std::uint32_t lane = 0; lane < count; ++lane) __builtin_prefetch(&mesh.triangles()[leaf.triangle[lane]]);
}

/// And where these are: of those triangles, one bit each, that are to be looked at.
ODDS_LANES_INLINE void prefetch_corners(const mesh::TriangleMesh& mesh, const tree::WideLeaf& leaf,
                                        unsigned lanes) noexcept {
  for (; lanes != 0; lanes &= lanes - 1) {
    for (const std::uint32_t vertex : mesh.triangles()[leaf.triangle[std::countr_zero(lanes)]]) {
      __builtin_prefetch(&mesh.vertices()[vertex]);
    }
  }
}

}  // namespace odds::query
