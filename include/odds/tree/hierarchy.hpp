// A bounding volume hierarchy over a mesh: immutable flat arrays, statistics beside the nodes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "odds/mesh/shared_array.hpp"
#include "odds/mesh/side_by_side.hpp"
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

  /// What a hierarchy consists of, as it stands in a saved file.
  struct Parts {
    mesh::SharedArray<Node> nodes;                 ///< children after their parents; node 0 is the root
    mesh::SharedArray<NodeStatistics> statistics;  ///< of each node
    mesh::SharedArray<TriangleCorners> corners;    ///< leaf order, this frame; none without polygons
    mesh::SharedArray<std::uint32_t> order;        ///< leaf order -> mesh triangle; none without polygons
    Vec3 origin = Vec3::Zero();                    ///< of this frame, in the mesh's
    double reach = 0.0;                            ///< greatest distance of a corner from the origin, metres
    std::size_t triangles = 0;
    std::uint32_t levels = 0;  ///< root = 1
  };

  [[nodiscard]] static Hierarchy build(const mesh::TriangleMesh& mesh, const BuildOptions& options,
                                       const Progress& progress = {});

  Hierarchy() = default;
  /// Precondition: as `build` makes them (`find_defect` in src/tree/tree_defect.hpp tells).
  explicit Hierarchy(Parts parts) : parts_(std::move(parts)) {}

  [[nodiscard]] const Parts& parts() const noexcept { return parts_; }
  [[nodiscard]] std::span<const Node> nodes() const noexcept { return parts_.nodes.span(); }
  [[nodiscard]] std::span<const NodeStatistics> statistics() const noexcept { return parts_.statistics.span(); }
  [[nodiscard]] std::span<const TriangleCorners> corners() const noexcept {
    return parts_.corners.span();
  }  ///< leaf order, this frame
  [[nodiscard]] std::span<const std::uint32_t> order() const noexcept {
    return parts_.order.span();
  }                                                                            ///< leaf order -> mesh triangle
  [[nodiscard]] const Vec3& origin() const noexcept { return parts_.origin; }  ///< of this frame, in the mesh's
  [[nodiscard]] double reach() const noexcept {
    return parts_.reach;
  }  ///< greatest distance of a corner from the origin
  [[nodiscard]] std::size_t triangle_count() const noexcept { return parts_.triangles; }
  [[nodiscard]] std::uint32_t levels() const noexcept { return parts_.levels; }
  [[nodiscard]] std::size_t bytes() const noexcept {
    return parts_.nodes.bytes() + parts_.statistics.bytes() + parts_.corners.bytes() + parts_.order.bytes();
  }

 private:
  Parts parts_;
};

template <volume::BoundingVolume V>
Hierarchy<V> Hierarchy<V>::build(const mesh::TriangleMesh& mesh, const BuildOptions& options,
                                 const Progress& progress) {
  Parts parts;
  parts.origin = 0.5 * mesh.lower() + 0.5 * mesh.upper();
  parts.triangles = mesh.triangles().size();
  std::vector<TriangleCorners> unordered = corners_about(mesh, parts.origin);
  const Progress first_half = progress ? [&](double share) { progress(0.4 * share); } : Progress{};
  Topology topology = build_topology(unordered, options.leaf_triangles, first_half);
  std::vector<TriangleCorners> corners(unordered.size());
  for (std::size_t i = 0; i < unordered.size(); ++i) corners[i] = unordered[topology.order[i]];
  unordered = {};
  for (const TriangleCorners& triangle : corners) {
    for (const Vec3& corner : triangle) parts.reach = std::max(parts.reach, corner.norm());
  }
  NodeSurface surface = measure_surface(topology, corners);
  if (progress) progress(0.6);

  std::vector<Node> nodes(topology.nodes.size());
  for_parts(topology.nodes.size(), 1024, [&](std::size_t begin, std::size_t end) {
    CellCounter counter;
    for (std::size_t i = begin; i < end; ++i) {
      const TopologyNode& node = topology.nodes[i];
      const auto triangles = std::span(corners).subspan(node.begin, node.end - node.begin);
      const std::span<const Vec3> points(triangles.front().data(), triangles.size() * 3);
      const V volume = V::fit(points, surface.axes[i]);
      nodes[i] = {volume, node.first, node.count, volume.radius()};
      relate_area(surface.statistics[i], volume.volume());
      const volume::OrientedBox box = volume.cell_box();
      counter.begin(box.center, box.axes, box.half_extents);
      for (const TriangleCorners& triangle : triangles) counter.add(triangle[0], triangle[1], triangle[2]);
      surface.statistics[i].well_filled_cells = counter.count(options.tau);
    }
  });
  parts.nodes = std::move(nodes);
  parts.statistics = std::move(surface.statistics);
  parts.corners = std::move(corners);
  parts.order = std::move(topology.order);
  mesh::put_side_by_side(parts.nodes, parts.corners, parts.order, parts.statistics);
  parts.levels = topology.levels;
  if (progress) progress(1.0);
  return Hierarchy(std::move(parts));
}

}  // namespace odds::tree
