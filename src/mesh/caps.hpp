// Triangles without area whose corners lie apart on a line: caps. Private to mesh.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "odds/mesh/triangle_mesh.hpp"

namespace odds::mesh {

/// Flips the long side of each cap with the one triangle beyond it, which has an area: that triangle is cut at the
/// cap's middle corner, and the cap becomes its other part. The surface stays what it was, to the last bit, and what
/// was closed stays closed when triangles without area are dropped. Caps beyond whose long side there is nothing, or
/// more than one triangle, or only caps, stay. Gives how many were flipped.
std::size_t flip_caps(std::span<const Vec3> vertices, std::span<Triangle> triangles);

}  // namespace odds::mesh
