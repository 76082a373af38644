// The kernels of every instruction set, on the nodes and leaves of one tree.
#pragma once

#include <gtest/gtest.h>

#include <set>

#include "query/wide/searches.hpp"
#include "support/instruction_sets.hpp"
#include "support/wavy_tree.hpp"

namespace odds::testing {

/// `check(searches)` with those of each instruction set that this processor has. Expects that `kernel` is another one
/// in each.
template <class Kernel, class Check>
void for_each_instruction_set(Kernel query::wide::Searches::*kernel, const Check& check) {
  std::set<Kernel> kernels;
  for (const query::InstructionSet set : instruction_sets) {
    const query::wide::Searches* const searches = query::wide::searches_for(set);
    if (searches == nullptr) continue;  // not on this processor
    EXPECT_TRUE(kernels.insert(searches->*kernel).second);
    check(*searches);
  }
}

/// With the searches of each instruction set that this processor has, for each node of a wavy sphere's tree:
/// `of_node(searches, node)`, then for each of its leaves `of_leaf(searches, leaf, count, center)`, with the triangles'
/// number and the place from which corners are given. Expects that `kernel` is another one in each set.
template <class Kernel, class OfNode, class OfLeaf>
void for_each_kernel(Kernel query::wide::Searches::*kernel, const OfNode& of_node, const OfLeaf& of_leaf) {
  const WavyTree sphere(Vec3::Zero());
  const tree::WideTree& tree = *sphere.tree;
  for_each_instruction_set(kernel, [&](const query::wide::Searches& searches) {
    for (std::size_t n = 0; n < tree.node_count(); ++n) {
      const tree::WideNode& node = tree.nodes()[n];
      of_node(searches, node);
      for (unsigned lane = 0; lane < tree::wide_lanes && !node.child[lane].is_nothing(); ++lane) {
        const tree::ChildRef child = node.child[lane];
        if (!child.is_leaf()) continue;
        const Vec3f center(node.center[0][lane], node.center[1][lane], node.center[2][lane]);
        of_leaf(searches, tree.leaves()[child.index()], child.count(), center);
      }
    }
  });
}

}  // namespace odds::testing
