#include "odds/mesh/made/bumpy_sphere.hpp"

#include <array>
#include <cmath>

#include "mesh/made/bumps.hpp"
#include "mesh/made/geodesic.hpp"
#include "mesh/made/parameters.hpp"
#include "odds/math/random.hpp"

namespace odds::mesh::made {

std::span<const Field<BumpySphere>> BumpySphere::fields() {
  static constexpr std::array<Field<BumpySphere>, 7> list = {
      {{"radius", &BumpySphere::radius, 1e-6, 1e4, "metres"},
       {"height", &BumpySphere::height, 0.0, 0.5, "greatest bump, share of the radius"},
       {"width", &BumpySphere::width, 0.02, 1.0, "of a bump, radians"},
       {"scale", &BumpySphere::scale, 1e-3, 1e3, "of the whole shape; 0.985 for the inner of two shells"},
       {"bumps", &BumpySphere::bumps, 0, 1000, "bumps and hollows"},
       {"frequency", &BumpySphere::frequency, 1, 500, "20 frequency^2 triangles"},
       {"seed", &BumpySphere::seed, 0, 0x1p64, "of places and signs"}}};
  return list;
}

Surface bumpy_surface(const BumpySphere& shape) {
  struct Bump {
    Vec3 direction;
    double strength;
  };
  std::vector<Bump> bumps;
  math::Random random(shape.seed);
  for (std::uint32_t i = 0; i < shape.bumps; ++i) {
    const Vec3 direction = random.direction();
    bumps.push_back({direction, random.uniform(-1.5, 1.5)});
  }
  Surface surface = geodesic_sphere(shape.frequency);
  const double sharpness = 1.0 / (shape.width * shape.width);
  for (Vec3& vertex : surface.vertices()) {
    double sum = 0.0;
    // 2 (1 - cos angle) is the squared chord: near the squared angle, and smooth everywhere.
    for (const Bump& bump : bumps)
      sum += bump.strength * std::exp(-2.0 * (1.0 - bump.direction.dot(vertex)) * sharpness);
    vertex *= shape.radius * shape.scale * (1.0 + shape.height * std::tanh(sum));
  }
  return surface;
}

Result<TriangleMesh> make(const BumpySphere& shape) {
  if (auto error = out_of_range(shape)) return *std::move(error);
  return bumpy_surface(shape).finish(title(shape));
}

}  // namespace odds::mesh::made
