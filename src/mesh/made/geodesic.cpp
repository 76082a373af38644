#include "mesh/made/geodesic.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace odds::mesh::made {
namespace {

constexpr std::array<Triangle, 20> faces = {{{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                             {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                             {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                             {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}}};

std::array<Vec3, 12> corners() {
  const double g = (1.0 + std::sqrt(5.0)) / 2.0;
  return {{{-1, g, 0},
           {1, g, 0},
           {-1, -g, 0},
           {1, -g, 0},
           {0, -1, g},
           {0, 1, g},
           {0, -1, -g},
           {0, 1, -g},
           {g, 0, -1},
           {g, 0, 1},
           {-g, 0, -1},
           {-g, 0, 1}}};
}

/// Vertices by place: the corners first, then along each edge, then inside the faces; shared between faces.
class Lattice {
 public:
  Lattice(Surface& surface, std::uint32_t frequency) : surface_(surface), frequency_(frequency), corners_(corners()) {
    for (const Vec3& corner : corners_) surface_.add(corner.normalized());
  }

  /// The point with barycentric weights (n - i - j, i, j) of a face.
  std::uint32_t at(const Triangle& face, std::uint32_t i, std::uint32_t j) {
    const std::array<std::uint32_t, 3> weights = {frequency_ - i - j, i, j};
    const auto zeros = std::count(weights.begin(), weights.end(), 0U);
    for (std::size_t k = 0; k < 3; ++k) {
      if (weights[k] == frequency_) return face[k];
      if (zeros == 1 && weights[k] == 0) {
        return on_edge(face[(k + 1) % 3], face[(k + 2) % 3], weights[(k + 2) % 3]);
      }
    }
    const Vec3 point = corners_[face[0]] * weights[0] + corners_[face[1]] * weights[1] + corners_[face[2]] * weights[2];
    return surface_.add(point.normalized());
  }

 private:
  std::uint32_t on_edge(std::uint32_t a, std::uint32_t b, std::uint32_t steps_to_b) {
    if (a > b) return on_edge(b, a, frequency_ - steps_to_b);
    const auto [place, is_new] = edges_.try_emplace({a, b, steps_to_b}, 0U);
    if (is_new) {
      const Vec3 point = corners_[a] * (frequency_ - steps_to_b) + corners_[b] * steps_to_b;
      place->second = surface_.add(point.normalized());
    }
    return place->second;
  }

  Surface& surface_;
  std::uint32_t frequency_;
  std::array<Vec3, 12> corners_;
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> edges_;
};

}  // namespace

Surface geodesic_sphere(std::uint32_t frequency) {
  Surface surface;
  Lattice lattice(surface, frequency);
  for (const Triangle& face : faces) {
    Ring previous;
    for (std::uint32_t i = 0; i <= frequency; ++i) {
      Ring row;
      for (std::uint32_t j = 0; i + j <= frequency; ++j) row.push_back(lattice.at(face, i, j));
      for (std::size_t j = 0; i > 0 && j < row.size(); ++j) {
        surface.triangle(previous[j], row[j], previous[j + 1]);
        if (j + 1 < row.size()) surface.triangle(previous[j + 1], row[j], row[j + 1]);
      }
      previous = std::move(row);
    }
  }
  return surface;
}

}  // namespace odds::mesh::made
