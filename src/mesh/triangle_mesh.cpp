// Checks that make a TriangleMesh valid by existing.
#include "odds/mesh/triangle_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "odds/mesh/side_by_side.hpp"

namespace odds::mesh {
namespace {

bool is_in_range(const Vec3& vertex) noexcept {
  return (vertex.array().abs() <= TriangleMesh::largest_coordinate).all();  // false for a NaN too
}

std::optional<Error> find_bad_vertex(std::span<const Vec3> vertices, const std::string& name) {
  const auto bad = std::find_if_not(vertices.begin(), vertices.end(), is_in_range);
  if (bad == vertices.end()) return std::nullopt;
  const std::string place = "vertex " + std::to_string(bad - vertices.begin());
  if (!bad->allFinite()) return Error{name, place, "a coordinate is not finite", "remove or correct that vertex"};
  return Error{name, place, "a coordinate exceeds 1e15 m", "check the file's unit of length"};
}

std::optional<Error> find_bad_triangle(std::span<const Triangle> triangles, std::size_t vertices,
                                       const std::string& name) {
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Triangle& triangle = triangles[i];
    const std::uint32_t highest = std::max({triangle[0], triangle[1], triangle[2]});
    if (highest < vertices) continue;
    return Error{name, "triangle " + std::to_string(i),
                 "vertex index " + std::to_string(highest) + " is out of range (the mesh has " +
                     std::to_string(vertices) + " vertices)",
                 "correct the face"};
  }
  return std::nullopt;
}

/// Everything that a mesh promises of its arrays.
std::optional<Error> find_defect(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                                 const std::string& name) {
  if (triangles.empty()) return Error{name, "", "the mesh has no triangle", "give a file with at least one face"};
  if (vertices.size() > TriangleMesh::largest_count || triangles.size() > TriangleMesh::largest_count) {
    return Error{name, "", "the mesh has more than 2^30 vertices or triangles", "split it into several meshes"};
  }
  if (auto error = find_bad_vertex(vertices, name)) return error;
  return find_bad_triangle(triangles, vertices.size(), name);
}

}  // namespace

Result<TriangleMesh> TriangleMesh::make(std::vector<Vec3> vertices, std::vector<Triangle> triangles, std::string name) {
  if (auto error = find_defect(vertices, triangles, name)) return *std::move(error);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  TriangleMesh mesh;
  mesh.lower_ = Vec3::Constant(infinity);
  mesh.upper_ = Vec3::Constant(-infinity);
  for (const Triangle& triangle : triangles) {
    for (const std::uint32_t index : triangle) {
      mesh.lower_ = mesh.lower_.cwiseMin(vertices[index]);
      mesh.upper_ = mesh.upper_.cwiseMax(vertices[index]);
    }
  }
  mesh.vertices_ = std::move(vertices);
  mesh.triangles_ = std::move(triangles);
  put_side_by_side(mesh.triangles_, mesh.vertices_);
  mesh.name_ = std::move(name);
  return mesh;
}

Result<TriangleMesh> TriangleMesh::adopt(SharedArray<Vec3> vertices, SharedArray<Triangle> triangles, std::string name,
                                         const Vec3& lower, const Vec3& upper) {
  if (auto error = find_defect(vertices.span(), triangles.span(), name)) return *std::move(error);
  if (!is_in_range(lower) || !is_in_range(upper) || !(lower.array() <= upper.array()).all()) {
    return Error{name, "", "the bounding box is inside out or not finite", "give the one of the used vertices"};
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
