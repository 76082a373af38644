// What tests ask of a mesh, computed the plain way and apart from the library's own find_faults.
#pragma once

#include <cmath>
#include <map>
#include <utility>

#include "odds/mesh/triangle_mesh.hpp"

namespace odds::testing {

struct EdgeCensus {
  std::size_t boundary = 0;      ///< edges with one face
  std::size_t non_manifold = 0;  ///< edges with more than two faces
  std::size_t inconsistent = 0;  ///< edges that two faces run through in the same direction
  std::size_t edges = 0;
};

/// By vertex index: made shapes share indices where they share positions.
inline EdgeCensus edge_census(const mesh::TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<int, int>> uses;  // forwards, backwards
  for (const mesh::Triangle& t : mesh.triangles()) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k];
      const std::uint32_t b = t[(k + 1) % 3];
      auto& use = uses[std::minmax(a, b)];
      ++(a < b ? use.first : use.second);
    }
  }
  EdgeCensus census;
  census.edges = uses.size();
  for (const auto& [edge, use] : uses) {
    const int faces = use.first + use.second;
    if (faces == 1) ++census.boundary;
    if (faces > 2) ++census.non_manifold;
    if (faces == 2 && use.first != 1) ++census.inconsistent;
  }
  return census;
}

/// By the divergence theorem; meaningful for closed meshes.
inline double signed_volume(const mesh::TriangleMesh& mesh) {
  double six_volumes = 0.0;
  const Vec3 origin = 0.5 * (mesh.lower() + mesh.upper());
  for (const mesh::Triangle& t : mesh.triangles()) {
    const Vec3 a = mesh.vertices()[t[0]] - origin;
    const Vec3 b = mesh.vertices()[t[1]] - origin;
    const Vec3 c = mesh.vertices()[t[2]] - origin;
    six_volumes += a.dot(b.cross(c));
  }
  return six_volumes / 6.0;
}

inline double triangle_area(const mesh::TriangleMesh& mesh, std::size_t index) {
  const mesh::Triangle& t = mesh.triangles()[index];
  const Vec3& a = mesh.vertices()[t[0]];
  return 0.5 * (mesh.vertices()[t[1]] - a).cross(mesh.vertices()[t[2]] - a).norm();
}

}  // namespace odds::testing
