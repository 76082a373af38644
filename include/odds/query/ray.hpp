// Where does a ray first meet a mesh?
#pragma once

#include <cstdint>
#include <optional>

#include "odds/math/types.hpp"
#include "odds/query/shape.hpp"

namespace odds::query {

struct RayHit {
  double distance = 0.0;       ///< metres from the origin
  std::uint32_t triangle = 0;  ///< index into the mesh
};

/// The nearest crossing of the shape's surface (both sides count) by origin + t * direction, t in [0, max_distance];
/// frame of the mesh, metres, `direction` of unit length. The crossing is computed by Moeller and Trumbore 1997 in
/// doubles with closed edges, so a ray through a shared edge meets one of its triangles. Nothing for a NaN, a negative
/// length, a shape without polygons, or when `budget_nodes` nodes were visited without a crossing. noexcept, no
/// allocation; thread-safe.
[[nodiscard]] std::optional<RayHit> cast_ray(const Shape& shape, const Vec3& origin, const Vec3& direction,
                                             double max_distance, std::uint64_t budget_nodes = UINT64_MAX) noexcept;

}  // namespace odds::query
