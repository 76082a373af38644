// A stack of thin plates or of sheets without thickness.
#pragma once

#include <span>

#include "odds/mesh/made/field.hpp"
#include "odds/mesh/triangle_mesh.hpp"

namespace odds::mesh::made {

/// Plates lie in planes of constant z, the lowest from z = 0 on, `gap` apart. With thickness > 0 each is closed (4
/// cells^2 triangles on the large faces and 8 cells on the rim); with 0 each is an open sheet facing up.
struct Plates {
  static constexpr std::string_view name = "plates";
  static constexpr std::string_view meaning = "a stack of thin plates or of sheets without thickness";

  double side = 0.2;          ///< of a square plate, metres, 1e-6 .. 1e4
  double thickness = 0.0005;  ///< metres, 0 or 1e-9 .. 1e3
  double gap = 0.002;         ///< between neighbours, metres, 1e-9 .. 1e3
  double wave = 0.0;          ///< height of a wave that all plates share, metres, 0 .. 1e3
  std::uint32_t count = 8;    ///< plates, 1 .. 1000
  std::uint32_t cells = 16;   ///< along each side, 1 .. 1000

  [[nodiscard]] static std::span<const Field<Plates>> fields();
};

/// The mesh, or an error that names the parameter and its range. Thread-safe; same parameters, same bits.
Result<TriangleMesh> make(const Plates& shape);

}  // namespace odds::mesh::made
