// A dTriMesh with the arrays that ODE refers to, from a made mesh.
#pragma once

#include <vector>

#include "ode/ode_fixture.hpp"

namespace odds::test {

/// Forgets and destroys its geom; the geom may be in a space.
struct TriMesh {
  explicit TriMesh(const mesh::TriangleMesh& mesh, dSpaceID space) : data(dGeomTriMeshDataCreate()) {
    for (const Vec3& v : mesh.vertices()) vertices.insert(vertices.end(), {v.x(), v.y(), v.z()});
    for (const mesh::Triangle& t : mesh.triangles()) indices.insert(indices.end(), {t[0], t[1], t[2]});
    dGeomTriMeshDataBuildDouble(data, vertices.data(), 3 * sizeof(double), static_cast<int>(mesh.vertices().size()),
                                indices.data(), static_cast<int>(indices.size()), 3 * sizeof(dTriIndex));
    geom = dCreateTriMesh(space, data, nullptr, nullptr, nullptr);
  }
  ~TriMesh() {
    oddsForgetGeom(geom);
    dGeomDestroy(geom);
    dGeomTriMeshDataDestroy(data);
  }
  TriMesh(const TriMesh&) = delete;
  TriMesh& operator=(const TriMesh&) = delete;

  std::vector<double> vertices;
  std::vector<dTriIndex> indices;
  dTriMeshDataID data;
  dGeomID geom = nullptr;
};

}  // namespace odds::test
