// The tree of the wide engine: eight children a node, side by side, so that one test answers for all of them.
#pragma once

#include <cstdint>
#include <utility>

#include "odds/mesh/shared_array.hpp"
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

  ChildRef() = default;  ///< not set: searches have stacks of them
  [[nodiscard]] bool is_nothing() const noexcept { return bits_ == 0; }
  [[nodiscard]] bool is_leaf() const noexcept { return (bits_ & leaf_bit) != 0; }
  /// Of a node: its index; the root's node is 1, for node 0 holds the root itself in its first lane.
  [[nodiscard]] std::uint32_t index() const noexcept {
    return bits_ & (is_leaf() ? (1U << 28U) - 1U : most_nodes - 1U);
  }
  /// The same of what is known to be a node.
  [[nodiscard]] std::uint32_t node_index() const noexcept { return bits_ & (most_nodes - 1U); }
  [[nodiscard]] std::uint32_t count() const noexcept { return ((bits_ >> 28U) & 7U) + 1U; }  ///< triangles of a leaf
  [[nodiscard]] std::uint32_t height() const noexcept { return is_leaf() ? 0U : (bits_ >> 27U) & highest; }

 private:
  explicit ChildRef(std::uint32_t bits) noexcept : bits_(bits) {}
  static constexpr std::uint32_t leaf_bit = 1U << 31U;
  std::uint32_t bits_;
};

/// Half extents and thickness of a lane without a child.
inline constexpr float empty_extent = -1e30F;

/// Bounding volumes of up to eight children: boxes along the tree's axes, each cut by the slab in which its surface is
/// thinnest: {x : |x - center| <= half (by axis) and |normal . (x - center) - offset| <= thickness}. Metres, tree's
/// frame. Every corner below a lane satisfies both exactly. `normal` is at most 1 long. A lane without a child has the
/// extents `empty_extent`, which nothing overlaps, and zeros.
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
  /// Of the numbers of its nodes, 96 floats each, all have an address of 31 bits.
  static constexpr std::uint32_t most_nodes = (1U << 31U) / (sizeof(WideNode) / sizeof(float));
  static_assert(most_nodes <= ChildRef::most_nodes);

  /// What a tree consists of, as it stands in a saved file.
  struct Parts {
    mesh::SharedArray<WideNode> nodes;               ///< children after their parents; lanes in use come first
    mesh::SharedArray<WideLeaf> leaves;              ///< in the order of the lanes; none without polygons
    mesh::SharedArray<NodeStatistics> statistics;    ///< of the lanes in use, node after node
    mesh::SharedArray<std::uint32_t> statistics_at;  ///< of each node's first lane
    Vec3 origin = Vec3::Zero();                      ///< of this frame, in the mesh's
    double reach = 0.0;                              ///< greatest distance of a corner from the origin, metres
    std::size_t triangles = 0;
    std::uint32_t levels = 0;  ///< root = 1, leaves included
  };

  /// `options.leaf_triangles` above 8 counts as 8. A tree without nodes if it would have more than `most_nodes`.
  [[nodiscard]] static WideTree build(const mesh::TriangleMesh& mesh, const BuildOptions& options,
                                      const Progress& progress = {});

  WideTree() = default;
  /// Precondition: as `build` makes them (`find_defect` in src/tree/tree_defect.hpp tells).
  explicit WideTree(Parts parts) : parts_(std::move(parts)) {}

  [[nodiscard]] const Parts& parts() const noexcept { return parts_; }
  [[nodiscard]] const WideNode* nodes() const noexcept { return parts_.nodes.data(); }
  [[nodiscard]] std::size_t node_count() const noexcept { return parts_.nodes.size(); }
  [[nodiscard]] const WideLeaf* leaves() const noexcept { return parts_.leaves.data(); }
  [[nodiscard]] std::size_t leaf_count() const noexcept { return parts_.leaves.size(); }
  [[nodiscard]] std::size_t triangle_count() const noexcept { return parts_.triangles; }
  /// By slot; empty slots have none.
  [[nodiscard]] const NodeStatistics& statistics(Slot slot) const noexcept {
    return parts_.statistics[parts_.statistics_at[slot / wide_lanes] + slot % wide_lanes];
  }
  [[nodiscard]] const Vec3& origin() const noexcept { return parts_.origin; }  ///< of this frame, in the mesh's
  [[nodiscard]] double reach() const noexcept {
    return parts_.reach;
  }  ///< greatest distance of a corner from the origin
  [[nodiscard]] std::uint32_t levels() const noexcept { return parts_.levels; }  ///< root = 1, leaves included
  [[nodiscard]] std::size_t bytes() const noexcept {
    return parts_.nodes.bytes() + parts_.leaves.bytes() + parts_.statistics.bytes() + parts_.statistics_at.bytes();
  }

 private:
  Parts parts_;
};

}  // namespace odds::tree
