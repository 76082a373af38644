#include "odds/mesh/made/icosphere.hpp"

#include <array>

#include "mesh/made/geodesic.hpp"
#include "mesh/made/parameters.hpp"

namespace odds::mesh::made {

std::span<const Field<Icosphere>> Icosphere::fields() {
  static constexpr std::array<Field<Icosphere>, 2> list = {
      {{"radius", &Icosphere::radius, 1e-6, 1e4, "metres"},
       {"frequency", &Icosphere::frequency, 1, 500, "parts of each edge; 20 frequency^2 triangles"}}};
  return list;
}

Result<TriangleMesh> make(const Icosphere& shape) {
  if (auto error = out_of_range(shape)) return *std::move(error);
  Surface surface = geodesic_sphere(shape.frequency);
  for (Vec3& vertex : surface.vertices()) vertex *= shape.radius;
  return surface.finish(title(shape));
}

}  // namespace odds::mesh::made
