// A height field from seeded noise.
#pragma once

#include <span>

#include "odds/mesh/made/field.hpp"
#include "odds/mesh/triangle_mesh.hpp"

namespace odds::mesh::made {

/// A sheet over the square |x|, |y| <= side / 2, facing up, 2 * cells^2 triangles, open; with depth > 0 a solid that
/// reaches depth below z = -height (then closed). Heights in -height .. height.
struct Terrain {
  static constexpr std::string_view name = "terrain";
  static constexpr std::string_view meaning = "a height field from seeded noise";

  double side = 2.0;          ///< metres, 1e-5 .. 1e5
  double height = 0.15;       ///< metres, 0 .. 1e4
  double feature = 0.5;       ///< size of the largest hills, share of the side, 0.01 .. 1
  double roughness = 0.5;     ///< amplitude from one octave to the next, 0 .. 0.9
  double depth = 0.0;         ///< metres, 0 .. 1e4; 0: open sheet
  std::uint32_t cells = 128;  ///< along each side, 1 .. 3000
  std::uint32_t octaves = 5;  ///< 1 .. 12
  std::uint64_t seed = 1;

  [[nodiscard]] static std::span<const Field<Terrain>> fields();
};

/// The mesh, or an error that names the parameter and its range. Thread-safe; same parameters, same bits.
Result<TriangleMesh> make(const Terrain& shape);

}  // namespace odds::mesh::made
