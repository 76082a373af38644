// Bodies of blocks: rooms, pillars, stairs, each one mesh.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "odds/mesh/triangle_mesh.hpp"

namespace odds::test {

struct Blocks {
  std::array<std::vector<double>, 3> grid;  ///< where the cells begin and end along each axis, metres
  bool (*full)(int, int, int);              ///< whether the cell of these numbers is
};

/// The squares between cells that are full and cells that are not, outwards; if `kept` is given, those whose middle it
/// keeps.
inline std::pair<std::vector<Vec3>, std::vector<mesh::Triangle>> surface_of(const Blocks& blocks,
                                                                            bool (*kept)(const Vec3&) = nullptr) {
  using Place = std::array<int, 3>;
  std::vector<Vec3> vertices;
  std::vector<mesh::Triangle> triangles;
  std::map<Place, std::uint32_t> known;
  const auto line = [&](std::size_t axis, int number) { return blocks.grid[axis][static_cast<std::size_t>(number)]; };
  const auto vertex = [&](const Place& at) {
    const auto [place, is_new] = known.insert({at, static_cast<std::uint32_t>(vertices.size())});
    if (is_new) vertices.emplace_back(line(0, at[0]), line(1, at[1]), line(2, at[2]));
    return place->second;
  };
  const auto size = [&](std::size_t axis) { return static_cast<int>(blocks.grid[axis].size()) - 1; };
  const auto is_full = [&](const Place& at) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (at[axis] < 0 || at[axis] >= size(axis)) return false;
    }
    return blocks.full(at[0], at[1], at[2]);
  };
  const auto add_side = [&](const Place& at, std::size_t axis, int side) {
    Place beside = at;
    beside[axis] += 2 * side - 1;
    if (is_full(beside)) return;
    std::array<Place, 4> square;
    square.fill(at);
    for (Place& corner : square) corner[axis] += side;
    for (const std::size_t k : {1U, 2U}) ++square[k][(axis + 1) % 3];
    for (const std::size_t k : {2U, 3U}) ++square[k][(axis + 2) % 3];
    if (side == 0) std::swap(square[1], square[3]);
    std::array<std::uint32_t, 4> corners{};
    std::transform(square.begin(), square.end(), corners.begin(), vertex);
    if (kept != nullptr && !kept(0.5 * (vertices[corners[0]] + vertices[corners[2]]))) return;
    triangles.push_back({corners[0], corners[1], corners[2]});
    triangles.push_back({corners[0], corners[2], corners[3]});
  };
  for (int cell = 0; cell < size(0) * size(1) * size(2); ++cell) {
    const Place at{cell % size(0), cell / size(0) % size(1), cell / (size(0) * size(1))};
    for (std::size_t axis = 0; axis < 3 && is_full(at); ++axis) {
      for (const int side : {0, 1}) add_side(at, axis, side);
    }
  }
  return {std::move(vertices), std::move(triangles)};
}

}  // namespace odds::test
