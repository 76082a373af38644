#include "odds/mesh/made/box.hpp"

#include <array>
#include <map>

#include "mesh/made/parameters.hpp"
#include "mesh/made/surface.hpp"

namespace odds::mesh::made {

std::span<const Field<Box>> Box::fields() {
  static constexpr std::array<Field<Box>, 4> list = {{{"x", &Box::x, 1e-6, 1e4, "length along x, metres"},
                                                      {"y", &Box::y, 1e-6, 1e4, "length along y, metres"},
                                                      {"z", &Box::z, 1e-6, 1e4, "length along z, metres"},
                                                      {"cells", &Box::cells, 1, 1000, "cells along each edge"}}};
  return list;
}

Result<TriangleMesh> make(const Box& shape) {
  if (auto error = out_of_range(shape)) return *std::move(error);
  const std::uint32_t n = shape.cells;
  Surface surface;
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> index;
  const Vec3 size(shape.x, shape.y, shape.z);
  const auto vertex = [&](const std::array<std::uint32_t, 3>& at) {
    const auto [place, is_new] = index.try_emplace(at, 0U);
    if (is_new) {
      Vec3 position;
      for (int axis = 0; axis < 3; ++axis) {
        position[axis] = size[axis] * (static_cast<double>(at[static_cast<std::size_t>(axis)]) / n - 0.5);
      }
      place->second = surface.add(position);
    }
    return place->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    for (const std::uint32_t side : {0U, n}) {
      for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < n; ++j) {
          const auto corner = [&](std::uint32_t di, std::uint32_t dj) {
            std::array<std::uint32_t, 3> at{};
            at[axis] = side;
            at[u] = i + di;
            at[v] = j + dj;
            return vertex(at);
          };
          // One after the other: compilers differ in the order of arguments, which would number the vertices.
          const std::uint32_t last = side == n ? corner(0, 1) : corner(1, 0);
          const std::uint32_t far = corner(1, 1);
          const std::uint32_t next = side == n ? corner(1, 0) : corner(0, 1);
          surface.quad(corner(0, 0), next, far, last);
        }
      }
    }
  }
  return surface.finish(title(shape));
}

}  // namespace odds::mesh::made
