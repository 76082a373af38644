#include "odds/mesh/made/plate_with_hole.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mesh/made/parameters.hpp"
#include "mesh/made/surface.hpp"

namespace odds::mesh::made {
namespace {

/// Ring number k of n between the hole (k = 0) and the square rim (k = n) at one height.
Ring add_ring(Surface& surface, const PlateWithHole& shape, double hole, std::uint32_t k, double z) {
  const double share = static_cast<double>(k) / shape.across;
  Ring ring;
  for (std::uint32_t i = 0; i < shape.around; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / shape.around;
    const Vec3 outward(std::cos(angle), std::sin(angle), 0.0);
    const double rim = 0.5 * shape.side / std::max(std::abs(outward.x()), std::abs(outward.y()));
    ring.push_back(surface.add((hole + (rim - hole) * share) * outward + z * Vec3::UnitZ()));
  }
  return ring;
}

}  // namespace

std::span<const Field<PlateWithHole>> PlateWithHole::fields() {
  static constexpr std::array<Field<PlateWithHole>, 7> list = {
      {{"side", &PlateWithHole::side, 1e-6, 1e4, "of the square, metres"},
       {"thickness", &PlateWithHole::thickness, 1e-6, 1e3, "metres"},
       {"peg_radius", &PlateWithHole::peg_radius, 1e-6, 1e3, "of the peg that it is for, metres"},
       {"clearance", &PlateWithHole::clearance, -200.0, 2e3, "radial gap to the peg, metres"},
       {"around", &PlateWithHole::around, 8, 8192, "facets of the hole, a multiple of 8"},
       {"across", &PlateWithHole::across, 1, 1024, "rows between hole and rim"},
       {"along", &PlateWithHole::along, 1, 1024, "rows along the hole and on the rim"}}};
  return list;
}

Result<TriangleMesh> make(const PlateWithHole& shape) {
  if (auto error = out_of_range(shape)) return *std::move(error);
  if (shape.around % 8 != 0) {
    return refuse(shape, "around is not a multiple of 8, so it would miss the square's corners", "give 64");
  }
  if (shape.clearance < -0.2 * shape.peg_radius || shape.clearance > 2.0 * shape.peg_radius) {
    return refuse(shape, "clearance is outside -0.2 .. 2 peg radii", "give a smaller clearance");
  }
  // The facets' middles, not their ends, touch the circle.
  const double hole = (shape.peg_radius + shape.clearance) / std::cos(std::numbers::pi / shape.around);
  if (hole >= 0.45 * shape.side) {
    return refuse(shape, "the hole comes too near to the rim", "give a side greater than " + number_text(hole / 0.45));
  }
  Surface surface;
  std::array<Ring, 2> holes;
  std::array<Ring, 2> rims;
  for (const std::size_t top : {0U, 1U}) {
    const double z = top == 1 ? 0.0 : -shape.thickness;
    Ring inner = add_ring(surface, shape, hole, 0, z);
    holes[top] = inner;
    for (std::uint32_t k = 1; k <= shape.across; ++k) {
      Ring outer = add_ring(surface, shape, hole, k, z);
      top == 1 ? surface.connect(outer, inner) : surface.connect(inner, outer);
      inner = std::move(outer);
    }
    rims[top] = inner;
  }
  Ring hole_below = holes[0];
  Ring rim_below = rims[0];
  for (std::uint32_t k = 1; k <= shape.along; ++k) {
    const bool last = k == shape.along;
    const double z = -shape.thickness * (shape.along - k) / shape.along;
    Ring hole_above = last ? holes[1] : add_ring(surface, shape, hole, 0, z);
    Ring rim_above = last ? rims[1] : add_ring(surface, shape, hole, shape.across, z);
    surface.connect(hole_above, hole_below);
    surface.connect(rim_below, rim_above);
    hole_below = std::move(hole_above);
    rim_below = std::move(rim_above);
  }
  return surface.finish(title(shape));
}

}  // namespace odds::mesh::made
