// The unit sphere divided after the icosahedron; what icospheres and bumpy spheres start from. Private to mesh/made.
#pragma once

#include "mesh/made/surface.hpp"

namespace odds::mesh::made {

/// 20 * frequency^2 triangles, 10 * frequency^2 + 2 vertices of length 1, outward.
Surface geodesic_sphere(std::uint32_t frequency);

}  // namespace odds::mesh::made
