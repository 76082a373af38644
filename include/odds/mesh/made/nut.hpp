// A hexagon nut with a metric thread and a clearance to the bolt.
#pragma once

#include <span>

#include "odds/mesh/made/field.hpp"
#include "odds/mesh/triangle_mesh.hpp"

namespace odds::mesh::made {

/// Closed, genus 1; axis z, from z = 0 to height; both ends countersunk. The thread is made::Bolt's profile moved
/// outwards by `clearance` along its normal; its facets lie outside that helicoid, so in the poses named at Bolt the
/// gap is the clearance (to second order in the facets' angle). Negative: bolt and nut interfere everywhere.
struct Nut {
  static constexpr std::string_view name = "nut";
  static constexpr std::string_view meaning = "a hexagon nut with a metric thread and a clearance to the bolt";

  double diameter = 0.008;      ///< nominal, metres, 1e-5 .. 10
  double pitch = 0.00125;       ///< metres, 1e-6 .. 3, at most a third of the diameter
  double height = 0.0065;       ///< metres, at least one pitch, at most 1000 pitches
  double across_flats = 0.013;  ///< of the hexagon, metres, greater than 1.2 diameters
  double clearance = 3e-5;      ///< metres, -0.05 .. 0.1 pitches
  std::uint32_t around = 48;    ///< facets around, a multiple of 6, 12 .. 1200
  std::uint32_t rows = 1;       ///< rows of facets on each crest, flank and root, 1 .. 16

  [[nodiscard]] static std::span<const Field<Nut>> fields();
};

/// The mesh, or an error that names the parameter and its range. Thread-safe; same parameters, same bits.
Result<TriangleMesh> make(const Nut& shape);

}  // namespace odds::mesh::made
