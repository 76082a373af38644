// Checks that make a TriangleMesh valid by existing.
#include "odds/mesh/triangle_mesh.hpp"

#include <cmath>
#include <limits>

namespace odds::mesh {

Result<TriangleMesh> TriangleMesh::make(std::vector<Vec3> vertices, std::vector<Triangle> triangles, std::string name) {
  if (triangles.empty()) return Error{name, "", "the mesh has no triangle", "give a file with at least one face"};
  if (vertices.size() > largest_count || triangles.size() > largest_count) {
    return Error{name, "", "the mesh has more than 2^30 vertices or triangles", "split it into several meshes"};
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec3& v = vertices[i];
    if (!v.allFinite()) {
      return Error{name, "vertex " + std::to_string(i), "a coordinate is not finite", "remove or correct that vertex"};
    }
    if (v.cwiseAbs().maxCoeff() > largest_coordinate) {
      return Error{name, "vertex " + std::to_string(i), "a coordinate exceeds 1e15 m",
                   "check the file's unit of length"};
    }
  }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Vec3 lower = Vec3::Constant(infinity);
  Vec3 upper = Vec3::Constant(-infinity);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (const std::uint32_t index : triangles[i]) {
      if (index >= vertices.size()) {
        return Error{name, "triangle " + std::to_string(i),
                     "vertex index " + std::to_string(index) + " is out of range (the mesh has " +
                         std::to_string(vertices.size()) + " vertices)",
                     "correct the face"};
      }
      lower = lower.cwiseMin(vertices[index]);
      upper = upper.cwiseMax(vertices[index]);
    }
  }
  TriangleMesh mesh;
  mesh.vertices_ = std::move(vertices);
  mesh.triangles_ = std::move(triangles);
  mesh.name_ = std::move(name);
  mesh.lower_ = lower;
  mesh.upper_ = upper;
  return mesh;
}

}  // namespace odds::mesh
