#include "odds/mesh/made/car_body.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/made/car_panels.hpp"
#include "mesh/made/noise.hpp"
#include "mesh/made/parameters.hpp"
#include "mesh/made/surface.hpp"

namespace odds::mesh::made {
namespace {

struct Grid {
  std::uint32_t s;
  std::uint32_t t;
  [[nodiscard]] std::uint64_t cells() const { return std::uint64_t{s} * t; }
};

Grid grid_of(const Panel& panel, double cells_per_metre) {
  const auto count = [&](double length) {
    return static_cast<std::uint32_t>(std::max(1.0, std::round(length * cells_per_metre)));
  };
  return {count(panel.along_s), count(panel.along_t)};
}

std::uint64_t triangles_at(const std::vector<Panel>& panels, double cells_per_metre) {
  std::uint64_t triangles = 0;
  for (const Panel& panel : panels) triangles += 2 * grid_of(panel, cells_per_metre).cells();
  return triangles;
}

/// The finest density that does not exceed the wanted count; the count never falls as the density grows.
double density_for(const std::vector<Panel>& panels, std::uint64_t triangles) {
  double low = 0.0;
  double high = 4096.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (triangles_at(panels, middle) <= triangles ? low : high) = middle;
  }
  return low;
}

/// Cells of one panel. The first `in_four` of them are cut in four at their centre instead of in two; `split_edge` adds
/// a vertex to one edge of the rim. Together they make up the exact count without a triangle out of shape.
void add_panel(Surface& surface, const Panel& panel, Grid grid, std::uint64_t in_four, bool split_edge) {
  const auto first = static_cast<std::uint32_t>(surface.vertices().size());
  const auto at = [&](double i, double j) { return panel.position(i / grid.s, j / grid.t); };
  const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    panel.mirrored ? surface.triangle(a, c, b) : surface.triangle(a, b, c);
  };
  for (std::uint32_t j = 0; j <= grid.t; ++j) {
    for (std::uint32_t i = 0; i <= grid.s; ++i) surface.add(at(i, j));
  }
  std::uint64_t cell = 0;
  for (std::uint32_t j = 0; j < grid.t; ++j) {
    for (std::uint32_t i = 0; i < grid.s; ++i, ++cell) {
      const std::uint32_t a = first + j * (grid.s + 1) + i;
      const std::array<std::uint32_t, 4> corner = {a, a + 1, a + grid.s + 2, a + grid.s + 1};
      const bool cut_rim = split_edge && j + 1 == grid.t && i + 1 == grid.s;  // its upper edge is on the rim
      if (cell < in_four) {
        const std::uint32_t centre = surface.add(at(i + 0.5, j + 0.5));
        for (std::size_t k = 0; k < 4; ++k) {
          if (k != 2 || !cut_rim) triangle(corner[k], corner[(k + 1) % 4], centre);
        }
        if (cut_rim) {
          const std::uint32_t middle = surface.add(at(i + 0.5, j + 1.0));
          triangle(corner[2], middle, centre);
          triangle(middle, corner[3], centre);
        }
      } else {
        triangle(corner[0], corner[1], corner[2]);
        if (!cut_rim) triangle(corner[0], corner[2], corner[3]);
        if (cut_rim) {
          const std::uint32_t middle = surface.add(at(i + 0.5, j + 1.0));
          triangle(corner[0], corner[2], middle);
          triangle(corner[0], middle, corner[3]);
        }
      }
    }
  }
}

}  // namespace

std::span<const Field<CarBody>> CarBody::fields() {
  static constexpr std::array<Field<CarBody>, 4> list = {
      {{"length", &CarBody::length, 1e-3, 1e3, "metres; the rest in proportion"},
       {"dent", &CarBody::dent, 0.0, 0.01, "greatest unevenness, metres at a length of 4.5 m"},
       {"triangles", &CarBody::triangles, 500, 5e6, "exactly so many"},
       {"seed", &CarBody::seed, 0, 0x1p64, "of the unevenness"}}};
  return list;
}

Result<TriangleMesh> make(const CarBody& shape) {
  if (auto error = out_of_range(shape)) return *std::move(error);
  const std::vector<Panel> panels = car_panels();
  const double density = density_for(panels, shape.triangles);
  const std::uint64_t missing = shape.triangles - triangles_at(panels, density);
  std::uint64_t in_four = missing / 2;
  Surface surface;
  for (const Panel& panel : panels) {
    const Grid grid = grid_of(panel, density);
    const std::uint64_t here = std::min(in_four, grid.cells());
    add_panel(surface, panel, grid, here, missing % 2 == 1 && &panel == &panels.front());
    in_four -= here;
  }
  constexpr double drawn_length = 4.5;
  constexpr double dent_size = 0.25;  // metres
  for (Vec3& p : surface.vertices()) {
    const Vec3 at = p / dent_size;
    const Vec3 dent(smooth_noise(shape.seed, at), smooth_noise(shape.seed + 1, at), smooth_noise(shape.seed + 2, at));
    p = (p + shape.dent * dent / std::sqrt(3.0)) * (shape.length / drawn_length);
  }
  return surface.finish(title(shape));
}

}  // namespace odds::mesh::made
