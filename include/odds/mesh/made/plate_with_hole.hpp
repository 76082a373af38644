// A square plate with a round hole for the peg.
#pragma once

#include <span>

#include "odds/mesh/made/field.hpp"
#include "odds/mesh/triangle_mesh.hpp"

namespace odds::mesh::made {

/// Closed, genus 1; from z = -thickness to 0, hole along z at the origin. The hole's facets touch the circle of radius
/// peg_radius + clearance from outside, so the clearance is real. Negative: the peg does not fit.
struct PlateWithHole {
  static constexpr std::string_view name = "plate_with_hole";
  static constexpr std::string_view meaning = "a square plate with a round hole for the peg";

  double side = 0.08;         ///< of the square, metres, 1e-6 .. 1e4
  double thickness = 0.02;    ///< metres, 1e-6 .. 1e3
  double peg_radius = 0.01;   ///< metres, 1e-6 .. 1e3, with the clearance less than 0.45 sides
  double clearance = 5e-5;    ///< radial gap, metres, -0.2 .. 2 peg radii
  std::uint32_t around = 64;  ///< facets of the hole, a multiple of 8, 8 .. 8192
  std::uint32_t across = 8;   ///< rows of facets between hole and rim, 1 .. 1024
  std::uint32_t along = 8;    ///< rows of facets along the hole and on the rim, 1 .. 1024

  [[nodiscard]] static std::span<const Field<PlateWithHole>> fields();
};

/// The mesh, or an error that names the parameter and its range. Thread-safe; same parameters, same bits.
Result<TriangleMesh> make(const PlateWithHole& shape);

}  // namespace odds::mesh::made
