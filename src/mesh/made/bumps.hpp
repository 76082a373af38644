// The bumpy sphere's surface, shared by the single one and the nested pair. Private to mesh/made.
#pragma once

#include "mesh/made/surface.hpp"
#include "odds/mesh/made/bumpy_sphere.hpp"

namespace odds::mesh::made {

/// Outward, about the origin, scaled by shape.radius * shape.scale.
Surface bumpy_surface(const BumpySphere& shape);

}  // namespace odds::mesh::made
