// A spur gear with involute teeth and a bore.
#pragma once

#include <span>

#include "odds/mesh/made/field.hpp"
#include "odds/mesh/triangle_mesh.hpp"

namespace odds::mesh::made {

/// Closed; axis z, from z = 0 to width; a tooth points along +x. Two gears of one module mesh at a centre distance of
/// module * (teeth_1 + teeth_2) / 2. Addendum 1 module, dedendum 1.25; below the base circle the flanks are radial.
struct SpurGear {
  static constexpr std::string_view name = "gear";
  static constexpr std::string_view meaning = "a spur gear with involute teeth and a bore";

  double module = 0.002;         ///< pitch diameter per tooth, metres, 1e-6 .. 10
  double width = 0.01;           ///< metres, 1e-6 .. 1e3
  double bore = 0.004;           ///< radius of the hole, metres, 1e-7 .. 1e3, less than the root circle's
  double pressure_angle = 20.0;  ///< degrees, 14 .. 30
  double backlash = 0.0;         ///< taken from each tooth's thickness at the pitch circle, metres, 0 .. 1
  std::uint32_t teeth = 24;      ///< 5 .. 1000
  std::uint32_t flank = 8;       ///< segments of a flank, 1 .. 64
  std::uint32_t root = 3;        ///< segments of the root between two teeth, 1 .. 64

  [[nodiscard]] static std::span<const Field<SpurGear>> fields();
};

/// The mesh, or an error that names the parameter and its range. Thread-safe; same parameters, same bits.
Result<TriangleMesh> make(const SpurGear& shape);

}  // namespace odds::mesh::made
