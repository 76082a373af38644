// A sphere from an icosahedron, nearly equal triangles.
#pragma once

#include <span>

#include "odds/mesh/made/field.hpp"
#include "odds/mesh/triangle_mesh.hpp"

namespace odds::mesh::made {

/// Closed; centred at the origin; 20 * frequency^2 triangles; vertices on the sphere.
struct Icosphere {
  static constexpr std::string_view name = "icosphere";
  static constexpr std::string_view meaning = "a sphere from an icosahedron, nearly equal triangles";

  double radius = 0.05;          ///< metres, 1e-6 .. 1e4
  std::uint32_t frequency = 16;  ///< parts of each edge of the icosahedron, 1 .. 500

  [[nodiscard]] static std::span<const Field<Icosphere>> fields();
};

/// The mesh, or an error that names the parameter and its range. Thread-safe; same parameters, same bits.
Result<TriangleMesh> make(const Icosphere& shape);

}  // namespace odds::mesh::made
