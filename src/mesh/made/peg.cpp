#include "odds/mesh/made/peg.hpp"

#include <algorithm>
#include <array>

#include "mesh/made/parameters.hpp"
#include "mesh/made/surface.hpp"

namespace odds::mesh::made {

std::span<const Field<Peg>> Peg::fields() {
  static constexpr std::array<Field<Peg>, 5> list = {
      {{"radius", &Peg::radius, 1e-6, 1e3, "metres"},
       {"length", &Peg::length, 1e-6, 1e4, "metres"},
       {"chamfer", &Peg::chamfer, 1e-8, 1e3, "at the tip, metres, less than radius and length"},
       {"around", &Peg::around, 3, 8192, "facets around"},
       {"along", &Peg::along, 1, 4096, "rows of facets above the chamfer"}}};
  return list;
}

Result<TriangleMesh> make(const Peg& shape) {
  if (auto error = out_of_range(shape)) return *std::move(error);
  if (shape.chamfer >= std::min(shape.radius, shape.length)) {
    return refuse(shape, "the chamfer is not less than radius and length", "give a smaller chamfer");
  }
  Surface surface;
  Ring below = surface.add_circle(shape.radius - shape.chamfer, 0.0, shape.around);
  surface.fan(surface.add({0.0, 0.0, 0.0}), below, true);
  for (std::uint32_t k = 0; k <= shape.along; ++k) {
    const double z = shape.chamfer + (shape.length - shape.chamfer) * k / shape.along;
    Ring ring = surface.add_circle(shape.radius, z, shape.around);
    surface.connect(below, ring);
    below = std::move(ring);
  }
  surface.fan(surface.add({0.0, 0.0, shape.length}), below, false);
  return surface.finish(title(shape));
}

}  // namespace odds::mesh::made
