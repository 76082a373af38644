// The tree of the wide engine: eight children a node, side by side, so that one test answers for all of them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "odds/mesh/triangle_mesh.hpp"
#include "odds/tree/hierarchy.hpp"
#include "odds/tree/node_statistics.hpp"

namespace odds::tree {

inline constexpr std::uint32_t wide_lanes = 8;

/// What a lane of a node leads to.
class ChildRef {
 public:
  static constexpr std::uint32_t most_nodes = 1U << 27U;
  static constexpr std::uint32_t highest = 15;

  [[nodiscard]] static ChildRef nothing() noexcept { return ChildRef(0); }
  /// `height`: levels of nodes below, 1 or more; above 15 counts as 15.
  [[nodiscard]] static ChildRef node(std::uint32_t index, std::uint32_t height) noexcept {
    return ChildRef(index | ((height < highest ? height : highest) << 27U));
  }
  /// `count` 1 .. 8.
  [[nodiscard]] static ChildRef leaf(std::uint32_t index, std::uint32_t count) noexcept {
    return ChildRef(leaf_bit | ((count - 1U) << 28U) | index);
  }

  ChildRef() = default;
  [[nodiscard]] bool is_nothing() const noexcept { return bits_ == 0; }
  [[nodiscard]] bool is_leaf() const noexcept { return (bits_ & leaf_bit) != 0; }
  /// Of a node: its index; the root's node is 1, for node 0 holds the root itself in its first lane.
  [[nodiscard]] std::uint32_t index() const noexcept {
    return bits_ & (is_leaf() ? (1U << 28U) - 1U : most_nodes - 1U);
  }
  [[nodiscard]] std::uint32_t count() const noexcept { return ((bits_ >> 28U) & 7U) + 1U; }  ///< triangles of a leaf
  [[nodiscard]] std::uint32_t height() const noexcept { return is_leaf() ? 0U : (bits_ >> 27U) & highest; }

 private:
  explicit ChildRef(std::uint32_t bits) noexcept : bits_(bits) {}
  static constexpr std::uint32_t leaf_bit = 1U << 31U;
  std::uint32_t bits_ = 0;
};

/// Bounding volumes of up to eight children: boxes along the tree's axes, each cut by the slab in which its surface is
/// thinnest: {x : |x - center| <= half (by axis) and |normal . x - offset| <= thickness}. Metres, tree's frame. Every
/// corner below a lane satisfies both exactly. `normal` is at most 1 long. A lane without a child has extents of -1e30,
/// which nothing overlaps.
struct alignas(64) WideNode {
  float center[3][wide_lanes];
  float half[3][wide_lanes];
  float normal[3][wide_lanes];
  float offset[wide_lanes];
  float thickness[wide_lanes];
  ChildRef child[wide_lanes];
};
static_assert(sizeof(WideNode) == 384);

/// Up to eight triangles. Corners are relative to the center of the leaf's lane, so that their rounding is relative to
/// the leaf's size. Lanes beyond the leaf's count repeat its first triangle.
struct alignas(64) WideLeaf {
  float corner[3][3][wide_lanes];      ///< [corner][axis][lane], metres
  std::uint32_t triangle[wide_lanes];  ///< index into the mesh
};
static_assert(sizeof(WideLeaf) == 320);

/// A child of a node: node * 8 + lane.
using Slot = std::uint32_t;

/// Immutable after `build`; shareable among threads. Its frame is the mesh's, moved so that the centre of the bounding
/// box is the origin (as that of `Hierarchy`).
class WideTree {
 public:
  static constexpr Slot root = 0;

  /// `options.leaf_triangles` above 8 counts as 8.
  [[nodiscard]] static WideTree build(const mesh::TriangleMesh& mesh, const BuildOptions& options,
                                      const Progress& progress = {});

  [[nodiscard]] const WideNode* nodes() const noexcept { return nodes_.data(); }
  [[nodiscard]] std::size_t node_count() const noexcept { return nodes_.size(); }
  [[nodiscard]] const WideLeaf* leaves() const noexcept { return leaves_.data(); }
  [[nodiscard]] std::size_t leaf_count() const noexcept { return leaves_.size(); }
  [[nodiscard]] std::size_t triangle_count() const noexcept { return triangle_count_; }
  /// By slot; empty slots have none.
  [[nodiscard]] const NodeStatistics& statistics(Slot slot) const noexcept {
    return statistics_[statistics_at_[slot / wide_lanes] + slot % wide_lanes];
  }
  [[nodiscard]] const Vec3& origin() const noexcept { return origin_; }  ///< of this frame, in the mesh's
  [[nodiscard]] double reach() const noexcept { return reach_; }  ///< greatest distance of a corner from the origin
  [[nodiscard]] std::uint32_t levels() const noexcept { return levels_; }  ///< root = 1, leaves included
  [[nodiscard]] std::size_t bytes() const noexcept {
    return nodes_.size() * (sizeof(WideNode) + sizeof(std::uint32_t)) + leaves_.size() * sizeof(WideLeaf) +
           statistics_.size() * sizeof(NodeStatistics);
  }

 private:
  std::vector<WideNode> nodes_;
  std::vector<WideLeaf> leaves_;
  std::vector<NodeStatistics> statistics_;    // of the lanes in use, node after node
  std::vector<std::uint32_t> statistics_at_;  // of each node's first lane; lanes in use come first
  Vec3 origin_ = Vec3::Zero();
  double reach_ = 0.0;
  std::size_t triangle_count_ = 0;
  std::uint32_t levels_ = 0;
};

}  // namespace odds::tree
