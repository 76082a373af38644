// Reading the triangles of a dTriMesh geom back through ODE's public interface.
#include <algorithm>
#include <array>
#include <exception>
#include <map>
#include <utility>
#include <vector>

#include "ode/last_error.hpp"
#include "ode/mesh_data.hpp"

namespace odds::ode {
namespace {

struct IndexedMesh {
  std::vector<Vec3> vertices;
  std::vector<mesh::Triangle> triangles;
};

// dGeomTriMeshGetTriangle answers in the world frame. A second, space-less geom at the identity on the same data gives
// the mesh frame without a rounding transform. Equal corners become one vertex again.
IndexedMesh read_triangles(dGeomID trimesh) {
  struct Copy {
    dGeomID id;
    ~Copy() { dGeomDestroy(id); }
  } copy = {dCreateTriMesh(nullptr, dGeomTriMeshGetData(trimesh), nullptr, nullptr, nullptr)};
  IndexedMesh result;
  std::map<std::array<double, 3>, std::uint32_t> index_of;
  const int count = dGeomTriMeshGetTriangleCount(copy.id);
  result.triangles.reserve(static_cast<std::size_t>(std::max(count, 0)));
  for (int t = 0; t < count; ++t) {
    std::array<dVector3, 3> corners;
    dGeomTriMeshGetTriangle(copy.id, t, &corners[0], &corners[1], &corners[2]);
    mesh::Triangle triangle;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::array<double, 3> key = {corners[c][0], corners[c][1], corners[c][2]};
      const auto [place, added] = index_of.try_emplace(key, static_cast<std::uint32_t>(result.vertices.size()));
      if (added) result.vertices.emplace_back(key[0], key[1], key[2]);
      triangle[c] = place->second;
    }
    result.triangles.push_back(triangle);
  }
  return result;
}

}  // namespace
}  // namespace odds::ode

int oddsMeshDataBuildFromTriMesh(oddsMeshDataID data, dGeomID trimesh, const oddsBuildParams* params) noexcept {
  using odds::ode::set_last_error;
  if (trimesh == nullptr || dGeomGetClass(trimesh) != dTriMeshClass || dGeomTriMeshGetData(trimesh) == nullptr) {
    set_last_error("oddsMeshDataBuildFromTriMesh: not a dTriMesh geom with data; make one with dCreateTriMesh");
    return 0;
  }
  try {
    odds::ode::IndexedMesh mesh = odds::ode::read_triangles(trimesh);
    return odds::ode::build_mesh_data(data, std::move(mesh.vertices), std::move(mesh.triangles), params);
  } catch (const std::exception& error) {
    set_last_error(std::string_view(error.what()));
  } catch (...) {
    set_last_error("oddsMeshDataBuildFromTriMesh: unknown failure");
  }
  return 0;
}
