// A sphere of circles of latitude, thin triangles at the poles.
#pragma once

#include <span>

#include "odds/mesh/made/field.hpp"
#include "odds/mesh/triangle_mesh.hpp"

namespace odds::mesh::made {

/// Closed; centred at the origin, poles on z; 2 * around * (down - 1) triangles; vertices on the sphere. The poles are
/// single vertices: no triangle has zero area.
struct UvSphere {
  static constexpr std::string_view name = "uv_sphere";
  static constexpr std::string_view meaning = "a sphere of circles of latitude, thin triangles at the poles";

  double radius = 0.05;       ///< metres, 1e-6 .. 1e4
  std::uint32_t around = 64;  ///< meridians, 3 .. 4096
  std::uint32_t down = 32;    ///< bands of latitude, 2 .. 4096

  [[nodiscard]] static std::span<const Field<UvSphere>> fields();
};

/// The mesh, or an error that names the parameter and its range. Thread-safe; same parameters, same bits.
Result<TriangleMesh> make(const UvSphere& shape);

}  // namespace odds::mesh::made
