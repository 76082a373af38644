// Every triangle with every triangle: what searches are judged by.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "odds/math/pose.hpp"
#include "odds/mesh/triangle_mesh.hpp"
#include "odds/primitive/triangle_triangle.hpp"

namespace odds::testing {

/// The mesh scaled, then moved, with its triangles counted from another one on. Exact for scales of powers of two and a
/// pose that only they follow.
inline std::shared_ptr<const mesh::TriangleMesh> changed(const mesh::TriangleMesh& mesh, double scale,
                                                         const math::Pose& pose, std::size_t rotate_triangles) {
  std::vector<Vec3> vertices(mesh.vertices().begin(), mesh.vertices().end());
  for (Vec3& vertex : vertices) vertex = pose * Vec3(scale * vertex);
  std::vector<mesh::Triangle> triangles(mesh.triangles().begin(), mesh.triangles().end());
  std::rotate(
      triangles.begin(),
      triangles.begin() + static_cast<std::ptrdiff_t>(rotate_triangles % std::max<std::size_t>(triangles.size(), 1)),
      triangles.end());
  return std::make_shared<const mesh::TriangleMesh>(
      std::move(mesh::TriangleMesh::make(std::move(vertices), std::move(triangles), mesh.name())).value());
}

/// Whether any triangles meet, by the exact test; boxes of triangles that are apart save it.
inline bool brute_force(const mesh::TriangleMesh& a, const mesh::TriangleMesh& b, const math::Pose& b_in_a) {
  struct Placed {
    Vec3 corners[3];
    Vec3 lower;
    Vec3 upper;
  };
  const auto place = [](const mesh::TriangleMesh& mesh, const math::Pose* pose) {
    std::vector<Placed> all;
    for (const mesh::Triangle& triangle : mesh.triangles()) {
      Placed placed;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& vertex = mesh.vertices()[triangle[k]];
        placed.corners[k] = pose == nullptr ? vertex : *pose * vertex;
      }
      placed.lower = placed.corners[0].cwiseMin(placed.corners[1]).cwiseMin(placed.corners[2]);
      placed.upper = placed.corners[0].cwiseMax(placed.corners[1]).cwiseMax(placed.corners[2]);
      all.push_back(placed);
    }
    return all;
  };
  const std::vector<Placed> all_a = place(a, nullptr);
  const std::vector<Placed> all_b = place(b, &b_in_a);
  for (const Placed& tb : all_b) {
    for (const Placed& ta : all_a) {
      if ((ta.lower.array() > tb.upper.array()).any() || (tb.lower.array() > ta.upper.array()).any()) continue;
      if (primitive::triangles_intersect(ta.corners, tb.corners)) return true;
    }
  }
  return false;
}

}  // namespace odds::testing
