// A round peg with a chamfered tip.
#pragma once

#include <span>

#include "odds/mesh/made/field.hpp"
#include "odds/mesh/triangle_mesh.hpp"

namespace odds::mesh::made {

/// Closed; axis z, tip at z = 0, to z = length; vertices on the cylinder. Fits made::PlateWithHole of the same radius.
struct Peg {
  static constexpr std::string_view name = "peg";
  static constexpr std::string_view meaning = "a round peg with a chamfered tip";

  double radius = 0.01;       ///< metres, 1e-6 .. 1e3
  double length = 0.06;       ///< metres, 1e-6 .. 1e4
  double chamfer = 0.001;     ///< height and depth at the tip, metres, 1e-8 .. 1e3, less than radius and length
  std::uint32_t around = 64;  ///< 3 .. 8192
  std::uint32_t along = 16;   ///< rows of facets above the chamfer, 1 .. 4096

  [[nodiscard]] static std::span<const Field<Peg>> fields();
};

/// The mesh, or an error that names the parameter and its range. Thread-safe; same parameters, same bits.
Result<TriangleMesh> make(const Peg& shape);

}  // namespace odds::mesh::made
