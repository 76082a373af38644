// Cutting polygons that are not convex into triangles. Private to mesh.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "odds/mesh/triangle_mesh.hpp"

namespace odds::mesh {

/// A corner of a polygon that is being cut, in a ring of those that are left.
struct RingCorner {
  std::uint32_t vertex;
  std::uint32_t next;  ///< its place in the ring
};

/// Whether the fan of a polygon folds: a triangle of it faces against the polygon, seen along the axis that the polygon
/// faces most. Then it covers what lies outside of the polygon. False too where it faces nowhere, as a bow tie.
[[nodiscard]] bool fan_folds(std::span<const Vec3> vertices, std::span<const Triangle> fan);

/// Replaces the fan by as many triangles that cover the polygon: ears are cut off, each a corner that turns as the
/// polygon does and whose triangle holds no other (Meisters 1975). That looks at each pair of corners; looks come out
/// of `looks_left`, some 2 ns each. A polygon that crosses itself keeps its fan, and so does one for which too few are
/// left. `ring` needs a capacity of fan.size() + 2.
void cut_ears(std::span<const Vec3> vertices, std::span<Triangle> fan, std::vector<RingCorner>& ring,
              std::uint64_t& looks_left);

}  // namespace odds::mesh
