// The surface of a box along the axes: what stands for a mesh whose polygons were dropped.
#pragma once

#include <string>

#include "odds/mesh/triangle_mesh.hpp"

namespace odds::query {

/// Eight vertices, twelve triangles, outward; flat where the box is.
[[nodiscard]] inline Result<mesh::TriangleMesh> box_mesh(const Vec3& lower, const Vec3& upper, std::string name) {
  std::vector<Vec3> corners;
  for (unsigned i = 0; i < 8; ++i) {
    corners.emplace_back((i & 1U) != 0 ? upper.x() : lower.x(), (i & 2U) != 0 ? upper.y() : lower.y(),
                         (i & 4U) != 0 ? upper.z() : lower.z());
  }
  std::vector<mesh::Triangle> triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                           {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh::TriangleMesh::adopt(std::move(corners), std::move(triangles), std::move(name), lower, upper);
}

}  // namespace odds::query
