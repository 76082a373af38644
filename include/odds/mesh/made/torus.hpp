// A torus.
#pragma once

#include <span>

#include "odds/mesh/made/field.hpp"
#include "odds/mesh/triangle_mesh.hpp"

namespace odds::mesh::made {

/// Closed, genus 1; centred at the origin, axis z; 2 * around * across triangles; volume near 2 pi^2 ring tube^2.
struct Torus {
  static constexpr std::string_view name = "torus";
  static constexpr std::string_view meaning = "a torus";

  double ring = 0.1;          ///< radius of the centre line, metres, 1e-6 .. 1e4
  double tube = 0.03;         ///< radius of the tube, metres, 1e-7 .. 1e4, less than ring
  std::uint32_t around = 96;  ///< sections of the ring, 3 .. 4096
  std::uint32_t across = 48;  ///< points of a section, 3 .. 4096

  [[nodiscard]] static std::span<const Field<Torus>> fields();
};

/// The mesh, or an error that names the parameter and its range. Thread-safe; same parameters, same bits.
Result<TriangleMesh> make(const Torus& shape);

}  // namespace odds::mesh::made
