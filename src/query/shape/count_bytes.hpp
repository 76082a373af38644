// What a shape takes of the memory, with its polygons and without.
#pragma once

#include <variant>

#include "query/shape_data.hpp"

namespace odds::query {

template <volume::BoundingVolume V>
[[nodiscard]] std::size_t polygon_bytes(const tree::Hierarchy<V>& hierarchy) noexcept {
  return hierarchy.parts().corners.bytes() + hierarchy.parts().order.bytes();
}

[[nodiscard]] inline std::size_t polygon_bytes(const tree::WideTree& tree) noexcept {
  return tree.parts().leaves.bytes();
}

/// Fills in the sizes of a summary: bytes, numbers of nodes and levels.
inline void count_bytes(const AnyTree& any_tree, const mesh::TriangleMesh& mesh, ShapeSummary& summary) noexcept {
  std::visit(
      [&summary](const auto& tree) {
        summary.nodes = tree.parts().nodes.size();
        summary.depth = tree.levels();
        summary.bytes = tree.bytes();
        summary.polygon_free_bytes = tree.bytes() - polygon_bytes(tree);
      },
      any_tree);
  summary.mesh_bytes = mesh.vertex_array().bytes() + mesh.triangle_array().bytes();
}

}  // namespace odds::query
