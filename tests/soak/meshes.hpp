// The pairs of meshes that the long comparisons run on: small enough for brute force, unlike in what is hard about
// them.
#pragma once

#include <memory>
#include <vector>

#include "odds/mesh/triangle_mesh.hpp"

namespace odds::soak {

using Mesh = std::shared_ptr<const mesh::TriangleMesh>;

struct MeshPair {
  const char* name;
  Mesh a;
  Mesh b;
};

/// A made shape that must exist.
[[nodiscard]] Mesh made(const char* description);

/// Bumps against bumps, a knot in a knot, sheets against sheets, one closed shell within another, slivers, solids with
/// flat faces that meet in planes.
[[nodiscard]] std::vector<MeshPair> mesh_pairs();

}  // namespace odds::soak
