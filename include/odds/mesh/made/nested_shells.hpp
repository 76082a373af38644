// A hollow bumpy sphere: an outer surface and its copy scaled down inside it.
#pragma once

#include <span>

#include "odds/mesh/made/field.hpp"
#include "odds/mesh/triangle_mesh.hpp"

namespace odds::mesh::made {

/// Two closed components of 20 * frequency^2 triangles each; the inner one faces inwards, so the solid is the wall
/// between them and the volume is that of the outer one times 1 - ratio^3. Nearly parallel sheets: the hard case of
/// estimates.
struct NestedShells {
  static constexpr std::string_view name = "nested_shells";
  static constexpr std::string_view meaning =
      "a hollow bumpy sphere: an outer surface and its copy scaled down inside it";

  double radius = 0.05;          ///< metres, 1e-6 .. 1e4
  double ratio = 0.985;          ///< inner to outer, 0.1 .. 0.9999
  double height = 0.1;           ///< greatest bump, share of the radius, 0 .. 0.5
  double width = 0.25;           ///< of a bump, radians, 0.02 .. 1
  std::uint32_t bumps = 40;      ///< bumps and hollows together, 0 .. 1000
  std::uint32_t frequency = 32;  ///< as of an icosphere, 1 .. 300
  std::uint64_t seed = 1;        ///< of places and signs

  [[nodiscard]] static std::span<const Field<NestedShells>> fields();
};

/// The mesh, or an error that names the parameter and its range. Thread-safe; same parameters, same bits.
Result<TriangleMesh> make(const NestedShells& shape);

}  // namespace odds::mesh::made
