// Whether a tree that was not built here is one that no search can leave, overflow or go round in.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "odds/tree/hierarchy.hpp"
#include "odds/tree/wide_tree.hpp"
#include "odds/volume/hull.hpp"
#include "tree/saved_file.hpp"

namespace odds::tree {

/// What is wrong, and in which record. A tree without a defect is safe to search: all references are in range, each
/// node has one parent, which comes before it, and no path is longer than stacks are deep. That volumes enclose what is
/// below them is not looked at: if they do not, answers are wrong, and nothing worse.
struct Defect {
  Section section;
  std::size_t record;
  std::string what;
};

/// Precondition: all floating-point numbers are as `SavedFile::array` gives them: finite, and corners of leaves in
/// range.
[[nodiscard]] std::optional<Defect> find_defect(const WideTree::Parts& parts);

/// The tree's shape below the bounding volumes.
struct BinaryNode {
  std::uint32_t first;
  std::uint32_t count;
};
struct BinaryTree {
  std::vector<BinaryNode> nodes;
  std::span<const NodeStatistics> statistics;
  std::span<const TriangleCorners> corners;
  std::span<const std::uint32_t> order;
  std::size_t triangles;
  std::uint32_t levels;
};
[[nodiscard]] std::optional<Defect> find_defect(const BinaryTree& tree);

/// Whether the whole numbers in a volume are in range.
template <class V>
[[nodiscard]] bool is_sound(const V&) noexcept {
  return true;
}
[[nodiscard]] inline bool is_sound(const volume::Hull& hull) noexcept {
  return hull.count_ >= 1 && hull.count_ <= volume::Hull::most_vertices;
}

/// Precondition as above.
template <class V>
[[nodiscard]] std::optional<Defect> find_defect(const typename Hierarchy<V>::Parts& parts) {
  BinaryTree tree{{}, parts.statistics.span(), parts.corners.span(), parts.order.span(), parts.triangles, parts.levels};
  tree.nodes.reserve(parts.nodes.size());
  for (const auto& node : parts.nodes.span()) {
    if (!is_sound(node.volume)) return Defect{Section::nodes, tree.nodes.size(), "a bounding volume is not one"};
    tree.nodes.push_back({node.first, node.count});
  }
  return find_defect(tree);
}

}  // namespace odds::tree
