// A sphere with seeded smooth bumps and hollows.
#pragma once

#include <span>

#include "odds/mesh/made/field.hpp"
#include "odds/mesh/triangle_mesh.hpp"

namespace odds::mesh::made {

/// Closed and star-shaped about the origin, so it never meets itself; 20 * frequency^2 triangles. The distance of the
/// surface from the origin lies in radius * scale * (1 - height .. 1 + height).
struct BumpySphere {
  static constexpr std::string_view name = "bumpy_sphere";
  static constexpr std::string_view meaning = "a sphere with seeded smooth bumps and hollows";

  double radius = 0.05;  ///< metres, 1e-6 .. 1e4
  double height = 0.1;   ///< greatest bump, share of the radius, 0 .. 0.5
  double width = 0.25;   ///< of a bump, radians, 0.02 .. 1
  double scale = 1.0;    ///< of the whole shape about the origin, 1e-3 .. 1e3; 0.985 gives the inner one of two shells
  std::uint32_t bumps = 40;      ///< bumps and hollows together, 0 .. 1000
  std::uint32_t frequency = 32;  ///< as of an icosphere, 1 .. 500
  std::uint64_t seed = 1;        ///< of places and signs

  [[nodiscard]] static std::span<const Field<BumpySphere>> fields();
};

/// The mesh, or an error that names the parameter and its range. Thread-safe; same parameters, same bits.
Result<TriangleMesh> make(const BumpySphere& shape);

}  // namespace odds::mesh::made
