// Tells the processor what a search of a wide tree will look at soon.
#pragma once

#include "odds/tree/wide_tree.hpp"

namespace odds::query {

/// Boxes and children of a node, all of a leaf. A search that goes down a tree of megabytes waits for memory most of
/// its time; what it has put off comes meanwhile.
inline void prefetch(const tree::WideTree& tree, tree::ChildRef child) noexcept {
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

}  // namespace odds::query
