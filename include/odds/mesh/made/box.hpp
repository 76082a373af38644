// A box whose faces are divided into cells.
#pragma once

#include <span>

#include "odds/mesh/made/field.hpp"
#include "odds/mesh/triangle_mesh.hpp"

namespace odds::mesh::made {

/// Closed; centred at the origin; 12 * cells^2 triangles; volume x * y * z.
struct Box {
  static constexpr std::string_view name = "box";
  static constexpr std::string_view meaning = "a box whose faces are divided into cells";

  double x = 0.1;           ///< metres, 1e-6 .. 1e4
  double y = 0.1;           ///< metres, 1e-6 .. 1e4
  double z = 0.1;           ///< metres, 1e-6 .. 1e4
  std::uint32_t cells = 1;  ///< along each edge, 1 .. 1000

  [[nodiscard]] static std::span<const Field<Box>> fields();
};

/// The mesh, or an error that names the parameter and its range. Thread-safe; same parameters, same bits.
Result<TriangleMesh> make(const Box& shape);

}  // namespace odds::mesh::made
