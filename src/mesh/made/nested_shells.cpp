#include "odds/mesh/made/nested_shells.hpp"

#include <array>

#include "mesh/made/bumps.hpp"
#include "mesh/made/parameters.hpp"

namespace odds::mesh::made {

std::span<const Field<NestedShells>> NestedShells::fields() {
  static constexpr std::array<Field<NestedShells>, 7> list = {
      {{"radius", &NestedShells::radius, 1e-6, 1e4, "of the outer surface, metres"},
       {"ratio", &NestedShells::ratio, 0.1, 0.9999, "inner to outer"},
       {"height", &NestedShells::height, 0.0, 0.5, "greatest bump, share of the radius"},
       {"width", &NestedShells::width, 0.02, 1.0, "of a bump, radians"},
       {"bumps", &NestedShells::bumps, 0, 1000, "bumps and hollows"},
       {"frequency", &NestedShells::frequency, 1, 300, "40 frequency^2 triangles"},
       {"seed", &NestedShells::seed, 0, 0x1p64, "of places and signs"}}};
  return list;
}

Result<TriangleMesh> make(const NestedShells& shape) {
  if (auto error = out_of_range(shape)) return *std::move(error);
  const BumpySphere outer{.radius = shape.radius,
                          .height = shape.height,
                          .width = shape.width,
                          .bumps = shape.bumps,
                          .frequency = shape.frequency,
                          .seed = shape.seed};
  Surface surface = bumpy_surface(outer);
  Surface inner = surface;
  for (Vec3& vertex : inner.vertices()) vertex *= shape.ratio;
  surface.append(inner, true);
  return surface.finish(title(shape));
}

}  // namespace odds::mesh::made
