#include "odds/mesh/made/terrain.hpp"

#include <array>

#include "mesh/made/noise.hpp"
#include "mesh/made/parameters.hpp"
#include "mesh/made/surface.hpp"

namespace odds::mesh::made {
namespace {

/// Sum of octaves, scaled so that it stays within -height .. height.
double height_at(const Terrain& shape, double x, double y) {
  double sum = 0.0;
  double bound = 0.0;
  double amplitude = 1.0;
  double frequency = 1.0 / (shape.feature * shape.side);
  for (std::uint32_t octave = 0; octave < shape.octaves; ++octave) {
    sum += amplitude * smooth_noise(shape.seed, {x * frequency, y * frequency, 0.5 + octave});
    bound += amplitude;
    amplitude *= shape.roughness;
    frequency *= 2.0;
  }
  return shape.height * sum / bound;
}

/// Walls down from the rim and a flat bottom.
void close_below(Surface& surface, const Terrain& shape) {
  const std::uint32_t n = shape.cells;
  Ring rim;
  for (std::uint32_t k = 0; k < n; ++k) rim.push_back(k);
  for (std::uint32_t k = 0; k < n; ++k) rim.push_back(k * (n + 1) + n);
  for (std::uint32_t k = n; k > 0; --k) rim.push_back(n * (n + 1) + k);
  for (std::uint32_t k = n; k > 0; --k) rim.push_back(k * (n + 1));
  const double floor = -shape.height - shape.depth;
  Ring foot;
  for (const std::uint32_t vertex : rim) {
    Vec3 position = surface.vertices()[vertex];
    position.z() = floor;
    foot.push_back(surface.add(position));
  }
  surface.connect(foot, rim);
  surface.fan(surface.add({0.0, 0.0, floor}), foot, true);
}

}  // namespace

std::span<const Field<Terrain>> Terrain::fields() {
  static constexpr std::array<Field<Terrain>, 8> list = {
      {{"side", &Terrain::side, 1e-5, 1e5, "of the square, metres"},
       {"height", &Terrain::height, 0.0, 1e4, "greatest height, metres"},
       {"feature", &Terrain::feature, 0.01, 1.0, "size of the largest hills, share of the side"},
       {"roughness", &Terrain::roughness, 0.0, 0.9, "amplitude from one octave to the next"},
       {"depth", &Terrain::depth, 0.0, 1e4, "of the solid below, metres; 0: open sheet"},
       {"cells", &Terrain::cells, 1, 3000, "along each side"},
       {"octaves", &Terrain::octaves, 1, 12, "of the noise"},
       {"seed", &Terrain::seed, 0, 0x1p64, "of the noise"}}};
  return list;
}

Result<TriangleMesh> make(const Terrain& shape) {
  if (auto error = out_of_range(shape)) return *std::move(error);
  const std::uint32_t n = shape.cells;
  Surface surface;
  for (std::uint32_t j = 0; j <= n; ++j) {
    for (std::uint32_t i = 0; i <= n; ++i) {
      const double x = shape.side * (static_cast<double>(i) / n - 0.5);
      const double y = shape.side * (static_cast<double>(j) / n - 0.5);
      surface.add({x, y, height_at(shape, x, y)});
    }
  }
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t here = j * (n + 1) + i;
      surface.quad(here, here + 1, here + n + 2, here + n + 1);
    }
  }
  if (shape.depth > 0.0) close_below(surface, shape);
  return surface.finish(title(shape));
}

}  // namespace odds::mesh::made
