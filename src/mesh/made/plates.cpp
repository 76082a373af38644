#include "odds/mesh/made/plates.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "mesh/made/parameters.hpp"
#include "mesh/made/surface.hpp"

namespace odds::mesh::made {
namespace {

/// One sheet at height z; returns its rim, counter-clockwise seen from above.
Ring add_sheet(Surface& surface, const Plates& shape, double z, bool facing_up) {
  const std::uint32_t n = shape.cells;
  const auto first = static_cast<std::uint32_t>(surface.vertices().size());
  for (std::uint32_t j = 0; j <= n; ++j) {
    for (std::uint32_t i = 0; i <= n; ++i) {
      const double u = static_cast<double>(i) / n - 0.5;
      const double v = static_cast<double>(j) / n - 0.5;
      const double wave =
          0.5 * shape.wave * std::cos(2.0 * std::numbers::pi * u) * std::cos(2.0 * std::numbers::pi * v);
      surface.add({shape.side * u, shape.side * v, z + wave});
    }
  }
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = first + j * (n + 1) + i;
      if (facing_up) {
        surface.quad(a, a + 1, a + n + 2, a + n + 1);
      } else {
        surface.quad(a, a + n + 1, a + n + 2, a + 1);
      }
    }
  }
  Ring rim;
  for (std::uint32_t k = 0; k < n; ++k) rim.push_back(first + k);
  for (std::uint32_t k = 0; k < n; ++k) rim.push_back(first + k * (n + 1) + n);
  for (std::uint32_t k = n; k > 0; --k) rim.push_back(first + n * (n + 1) + k);
  for (std::uint32_t k = n; k > 0; --k) rim.push_back(first + k * (n + 1));
  return rim;
}

}  // namespace

std::span<const Field<Plates>> Plates::fields() {
  static constexpr std::array<Field<Plates>, 6> list = {
      {{"side", &Plates::side, 1e-6, 1e4, "of a square plate, metres"},
       {"thickness", &Plates::thickness, 0.0, 1e3, "metres; 0: sheets, else 1e-9 or more"},
       {"gap", &Plates::gap, 1e-9, 1e3, "between neighbours, metres"},
       {"wave", &Plates::wave, 0.0, 1e3, "height of a wave that all share, metres"},
       {"count", &Plates::count, 1, 1000, "plates"},
       {"cells", &Plates::cells, 1, 1000, "along each side"}}};
  return list;
}

Result<TriangleMesh> make(const Plates& shape) {
  if (auto error = out_of_range(shape)) return *std::move(error);
  constexpr double thinnest =
      1e-9;  // as near as neighbours: the coordinates of a thinner one's two sides fall together
  if (shape.thickness > 0.0 && shape.thickness < thinnest) {
    return refuse(shape, "thickness = " + number_text(shape.thickness) + " is thinner than coordinates can tell",
                  "give 0 for sheets, or at least " + number_text(thinnest));
  }
  if (static_cast<double>(shape.count) * shape.cells * shape.cells > 5e6) {
    return refuse(shape, "count * cells^2 exceeds 5 million cells", "give fewer plates or cells");
  }
  Surface surface;
  for (std::uint32_t k = 0; k < shape.count; ++k) {
    const double z = k * (shape.thickness + shape.gap);
    if (shape.thickness == 0.0) {
      add_sheet(surface, shape, z, true);
      continue;
    }
    const Ring low = add_sheet(surface, shape, z, false);
    const Ring high = add_sheet(surface, shape, z + shape.thickness, true);
    surface.connect(low, high);
  }
  return surface.finish(title(shape));
}

}  // namespace odds::mesh::made
