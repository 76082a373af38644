// The object behind oddsMeshDataID.
#pragma once

#include <memory>

#include "odds/ode/odds_ode.h"
#include "ode/mesh/prepared_mesh.hpp"

/// A container that is filled by one of the build functions; geoms share what it holds.
struct oddsMeshData {
  std::shared_ptr<const odds::ode::PreparedMesh> prepared;  // null until built
};

namespace odds::ode {

/// Builds the shape of an indexed mesh with the caller's parameters (null: defaults) and puts it into `data`.
/// Returns 1, or 0 with the last error set; `data` is then unchanged. May throw std::bad_alloc.
int build_mesh_data(oddsMeshDataID data, std::vector<Vec3> vertices, std::vector<mesh::Triangle> triangles,
                    const oddsBuildParams* params);

}  // namespace odds::ode
