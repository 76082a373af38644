// Triangles of the shapes that descriptions name.
#pragma once

#include <vector>

#include "odds/mesh/triangle_mesh.hpp"
#include "scene/import/description.hpp"

namespace odds::scene {

/// Half of the side of the slab that stands for a plane, and its thickness, metres.
inline constexpr double plane_half_side_m = 10.0;
inline constexpr double plane_thickness_m = 1.0;

/// Vertices and triangles, not yet a mesh.
struct Soup {
  std::vector<Vec3> vertices;
  std::vector<mesh::Triangle> triangles;

  /// Adds a part, moved by `pose` after scaling; a scale that mirrors turns its triangles round.
  void add(const std::vector<Vec3>& more, const std::vector<mesh::Triangle>& faces, const math::Pose& pose,
           const Vec3& scale);
  /// What the triangles from `first` on enclose, m^3, told from a point near to them, whichever way they face; of an
  /// open surface meaningless.
  [[nodiscard]] double volume(std::size_t first, const Vec3& from) const;
};

/// A closed solid about the origin, of any kind but a mesh; curved ones have 48 sides.
[[nodiscard]] Soup solid_of(const Geometry& geometry);

}  // namespace odds::scene
