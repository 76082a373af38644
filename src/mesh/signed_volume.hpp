// The sum behind the volume of a mesh. Private to mesh.
#pragma once

#include "odds/mesh/triangle_mesh.hpp"

namespace odds::mesh {

/// Cubic metres within a closed mesh, positive if it faces outwards; of another one a number without a meaning. Exactly
/// 0 where it is no more than rounding: of a sheet whose triangles are there twice, once for each side.
[[nodiscard]] double signed_volume(const TriangleMesh& mesh);

}  // namespace odds::mesh
