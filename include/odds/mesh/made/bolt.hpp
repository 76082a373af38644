// A hexagon bolt with a metric thread.
#pragma once

#include <span>

#include "odds/mesh/made/field.hpp"
#include "odds/mesh/triangle_mesh.hpp"

namespace odds::mesh::made {

/// Closed; axis z, tip at z = 0, thread from 0 to length, head above it. Right-handed ISO 60 degree profile (ISO 68-1)
/// of nominal size; the facets of the thread lie inside the true helicoid. Fits made::Nut of equal diameter and pitch:
/// a pose of the nut raised by h and turned by 2 pi h / pitch keeps the nut's clearance. Chamfered tip.
struct Bolt {
  static constexpr std::string_view name = "bolt";
  static constexpr std::string_view meaning = "a hexagon bolt with a metric thread";

  double diameter = 0.008;      ///< nominal, metres, 1e-5 .. 10
  double pitch = 0.00125;       ///< metres, 1e-6 .. 3, at most a third of the diameter
  double length = 0.03;         ///< of the thread, metres, at least one pitch, at most 1000 pitches
  double head = 0.0053;         ///< height of the head, metres, 1e-6 .. 10
  double across_flats = 0.013;  ///< of the hexagon, metres, greater than 1.2 diameters
  std::uint32_t around = 48;    ///< facets around, a multiple of 6, 12 .. 1200
  std::uint32_t rows = 1;       ///< rows of facets on each crest, flank and root, 1 .. 16

  [[nodiscard]] static std::span<const Field<Bolt>> fields();
};

/// The mesh, or an error that names the parameter and its range. Thread-safe; same parameters, same bits.
Result<TriangleMesh> make(const Bolt& shape);

}  // namespace odds::mesh::made
