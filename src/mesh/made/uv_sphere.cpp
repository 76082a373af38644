#include "odds/mesh/made/uv_sphere.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "mesh/made/parameters.hpp"
#include "mesh/made/surface.hpp"

namespace odds::mesh::made {

std::span<const Field<UvSphere>> UvSphere::fields() {
  static constexpr std::array<Field<UvSphere>, 3> list = {{{"radius", &UvSphere::radius, 1e-6, 1e4, "metres"},
                                                           {"around", &UvSphere::around, 3, 4096, "meridians"},
                                                           {"down", &UvSphere::down, 2, 4096, "bands of latitude"}}};
  return list;
}

Result<TriangleMesh> make(const UvSphere& shape) {
  if (auto error = out_of_range(shape)) return *std::move(error);
  Surface surface;
  const std::uint32_t bottom = surface.add({0.0, 0.0, -shape.radius});
  const std::uint32_t top = surface.add({0.0, 0.0, shape.radius});
  Ring below;
  for (std::uint32_t k = 1; k < shape.down; ++k) {
    const double latitude = std::numbers::pi * (static_cast<double>(k) / shape.down - 0.5);
    Ring ring = surface.add_circle(shape.radius * std::cos(latitude), shape.radius * std::sin(latitude), shape.around);
    if (k == 1) {
      surface.fan(bottom, ring, true);
    } else {
      surface.connect(below, ring);
    }
    below = std::move(ring);
  }
  surface.fan(top, below, false);
  return surface.finish(title(shape));
}

}  // namespace odds::mesh::made
