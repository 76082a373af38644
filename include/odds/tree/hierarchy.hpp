// A bounding volume hierarchy over a mesh: immutable flat arrays, statistics beside the nodes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "odds/mesh/triangle_mesh.hpp"
#include "odds/tree/for_parts.hpp"
#include "odds/tree/node_statistics.hpp"
#include "odds/tree/topology.hpp"
#include "odds/tree/well_filled_cells.hpp"
#include "odds/volume/concept.hpp"

namespace odds::tree {

struct BuildOptions {
  std::uint32_t leaf_triangles = 4;  ///< 1 .. 16
  double tau = 0.25;                 ///< a cell is well filled from tau * MaxArea on, (0, 1]
};

/// Surface of all nodes, filled before any volume is fitted; `axes` are the principal axes, thinnest first.
struct NodeSurface {
  std::vector<NodeStatistics> statistics;
  std::vector<volume::PrincipalAxes> axes;
};

/// Area, centroid, normals, slab of every node of `topology`, or of those for which `wanted` is not 0 if it is not
/// empty. `corners` in the order of the leaves.
[[nodiscard]] NodeSurface measure_surface(const Topology& topology, std::span<const TriangleCorners> corners,
                                          std::span<const std::uint8_t> wanted = {});

/// Fills in what relates the node's area to its bounding volume (m^3).
void relate_area(NodeStatistics& node, double volume) noexcept;

/// Corners of the mesh's triangles relative to `origin`, in the mesh's order.
[[nodiscard]] std::vector<TriangleCorners> corners_about(const mesh::TriangleMesh& mesh, const Vec3& origin);

/// Binary hierarchy over volumes of one kind. Its frame is the mesh's, moved so that the centre of the bounding box is
/// the origin: single precision then resolves the mesh wherever it stands. Immutable after `build`; shareable among
/// threads.
template <volume::BoundingVolume V>
class Hierarchy {
 public:
  /// Inner: children at first, first + 1, count 0. Leaf: triangles [first, first + count).
  struct Node {
    V volume;
    std::uint32_t first;
    std::uint32_t count;
    float radius;  ///< volume.radius(), kept: every visit of an inner pair compares two of them
    [[nodiscard]] bool is_leaf() const noexcept { return count != 0; }
  };

  [[nodiscard]] static Hierarchy build(const mesh::TriangleMesh& mesh, const BuildOptions& options,
                                       const Progress& progress = {});

  [[nodiscard]] std::span<const Node> nodes() const noexcept { return nodes_; }
  [[nodiscard]] std::span<const NodeStatistics> statistics() const noexcept { return statistics_; }
  [[nodiscard]] std::span<const TriangleCorners> corners() const noexcept {
    return corners_;
  }  ///< leaf order, this frame
  [[nodiscard]] std::span<const std::uint32_t> order() const noexcept {
    return order_;
  }                                                                      ///< leaf order -> mesh triangle
  [[nodiscard]] const Vec3& origin() const noexcept { return origin_; }  ///< of this frame, in the mesh's
  [[nodiscard]] double reach() const noexcept { return reach_; }  ///< greatest distance of a corner from the origin
  [[nodiscard]] std::uint32_t levels() const noexcept { return levels_; }
  [[nodiscard]] std::size_t bytes() const noexcept {
    return nodes_.size() * (sizeof(Node) + sizeof(NodeStatistics)) + corners_.size() * sizeof(TriangleCorners) +
           order_.size() * sizeof(std::uint32_t);
  }

 private:
  std::vector<Node> nodes_;
  std::vector<NodeStatistics> statistics_;
  std::vector<TriangleCorners> corners_;
  std::vector<std::uint32_t> order_;
  Vec3 origin_ = Vec3::Zero();
  double reach_ = 0.0;
  std::uint32_t levels_ = 0;
};

template <volume::BoundingVolume V>
Hierarchy<V> Hierarchy<V>::build(const mesh::TriangleMesh& mesh, const BuildOptions& options,
                                 const Progress& progress) {
  Hierarchy hierarchy;
  hierarchy.origin_ = 0.5 * mesh.lower() + 0.5 * mesh.upper();
  std::vector<TriangleCorners> unordered = corners_about(mesh, hierarchy.origin_);
  const Progress first_half = progress ? [&](double share) { progress(0.4 * share); } : Progress{};
  Topology topology = build_topology(unordered, options.leaf_triangles, first_half);
  hierarchy.corners_.resize(unordered.size());
  for (std::size_t i = 0; i < unordered.size(); ++i) hierarchy.corners_[i] = unordered[topology.order[i]];
  unordered = {};
  for (const TriangleCorners& triangle : hierarchy.corners_) {
    for (const Vec3& corner : triangle) hierarchy.reach_ = std::max(hierarchy.reach_, corner.norm());
  }
  NodeSurface surface = measure_surface(topology, hierarchy.corners_);
  if (progress) progress(0.6);

  hierarchy.nodes_.resize(topology.nodes.size());
  for_parts(topology.nodes.size(), 1024, [&](std::size_t begin, std::size_t end) {
    CellCounter counter;
    for (std::size_t i = begin; i < end; ++i) {
      const TopologyNode& node = topology.nodes[i];
      const auto triangles = std::span(hierarchy.corners_).subspan(node.begin, node.end - node.begin);
      const std::span<const Vec3> points(triangles.front().data(), triangles.size() * 3);
      const V volume = V::fit(points, surface.axes[i]);
      hierarchy.nodes_[i] = {volume, node.first, node.count, volume.radius()};
      relate_area(surface.statistics[i], volume.volume());
      const volume::OrientedBox box = hierarchy.nodes_[i].volume.cell_box();
      counter.begin(box.center, box.axes, box.half_extents);
      for (const TriangleCorners& triangle : triangles) counter.add(triangle[0], triangle[1], triangle[2]);
      surface.statistics[i].well_filled_cells = counter.count(options.tau);
    }
  });
  hierarchy.statistics_ = std::move(surface.statistics);
  hierarchy.order_ = std::move(topology.order);
  hierarchy.levels_ = topology.levels;
  if (progress) progress(1.0);
  return hierarchy;
}

}  // namespace odds::tree
