// Whether a point lies within a closed part of a mesh. Private to mesh.
#pragma once

#include <cstdint>
#include <span>

#include "odds/mesh/triangle_mesh.hpp"

namespace odds::mesh {

/// Whether a ray from the point along x crosses those of the `triangles` that are `chosen` an odd number of times: they
/// surround it if no edge of theirs is open, whichever way they face. Where its line goes through an edge or a corner,
/// neighbours agree, exactly, on whose crossing that is; on which side a point of the surface lies is up to rounding.
/// Some 5 ns a triangle.
[[nodiscard]] bool surrounds(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                             std::span<const std::uint32_t> chosen, const Vec3& point);

}  // namespace odds::mesh
