// A tube along a knot that winds on a torus.
#pragma once

#include <span>

#include "odds/mesh/made/field.hpp"
#include "odds/mesh/triangle_mesh.hpp"

namespace odds::mesh::made {

/// Closed, genus 1; 2 * along * across triangles. p and q without a common divisor. A tube so thick that it would meet
/// itself is refused.
struct TorusKnot {
  static constexpr std::string_view name = "torus_knot";
  static constexpr std::string_view meaning = "a tube along a knot that winds on a torus";

  double ring = 0.1;          ///< radius of the torus's centre line, metres, 1e-6 .. 1e4
  double winding = 0.04;      ///< radius of the torus on which the knot winds, metres, 1e-7 .. 1e4, less than ring
  double tube = 0.012;        ///< radius of the knot's tube, metres, 1e-7 .. 1e4
  std::uint32_t p = 2;        ///< turns about the axis, 1 .. 16
  std::uint32_t q = 3;        ///< turns about the centre line, 1 .. 16
  std::uint32_t along = 512;  ///< sections, 16 .. 65536
  std::uint32_t across = 24;  ///< points of a section, 3 .. 512

  [[nodiscard]] static std::span<const Field<TorusKnot>> fields();
};

/// The mesh, or an error that names the parameter and its range. Thread-safe; same parameters, same bits.
Result<TriangleMesh> make(const TorusKnot& shape);

}  // namespace odds::mesh::made
