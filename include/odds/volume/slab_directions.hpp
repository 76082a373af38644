// The directions of k-DOPs, and how any other direction is made of three of them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "odds/math/types.hpp"

namespace odds::volume {

/// One of 26 directions with components -1, 0, 1; not of unit length, so that offsets along it are sums of coordinates.
using SlabNormal = std::array<std::int8_t, 3>;

/// The k/2 normals of a k-DOP (Klosowski et al. 1998): 14 is axes and corners, 18 axes and edges, 26 all of a cube.
template <int K>
[[nodiscard]] constexpr std::array<SlabNormal, K / 2> slab_normals() noexcept {
  static_assert(K == 14 || K == 18 || K == 26, "the k-DOPs that are offered");
  constexpr std::array<SlabNormal, 3> axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  constexpr std::array<SlabNormal, 6> edges = {{{1, 1, 0}, {1, -1, 0}, {1, 0, 1}, {1, 0, -1}, {0, 1, 1}, {0, 1, -1}}};
  constexpr std::array<SlabNormal, 4> corners = {{{1, 1, 1}, {1, 1, -1}, {1, -1, 1}, {1, -1, -1}}};
  std::array<SlabNormal, K / 2> normals{};
  std::size_t size = 0;
  for (const SlabNormal& n : axes) normals[size++] = n;
  if constexpr (K != 14) {
    for (const SlabNormal& n : edges) normals[size++] = n;
  }
  if constexpr (K != 18) {
    for (const SlabNormal& n : corners) normals[size++] = n;
  }
  return normals;
}

/// A direction d as a sum of three slab normals: d = sum weight_i normal[slab_i]. What the slabs say along their
/// normals bounds what their volume reaches along d: max d.x <= sum |weight_i| * (offset of slab_i on the weight's
/// side). This is a feasible point of the dual of the linear program "max d.x within all slabs", so it holds for every
/// volume.
struct SlabBlend {
  std::array<float, 3> weight{};
  float shift = 0.0F;  ///< of the frame's origin along d, metres times |d|
  std::array<std::uint8_t, 3> slab{};
};

namespace detail {

/// Where a direction with components -1, 0, 1 stands among the normals, and whether it is turned round.
struct SignedSlab {
  std::uint8_t slab = 0;
  float sign = 0.0F;
};

template <int K>
[[nodiscard]] constexpr std::array<SignedSlab, 27> signed_slabs() noexcept {
  std::array<SignedSlab, 27> table{};
  const auto normals = slab_normals<K>();
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const int place = 9 * normals[i][0] + 3 * normals[i][1] + normals[i][2];
    table[static_cast<std::size_t>(13 + place)] = {static_cast<std::uint8_t>(i), 1.0F};
    table[static_cast<std::size_t>(13 - place)] = {static_cast<std::uint8_t>(i), -1.0F};
  }
  return table;
}

/// A direction of the cube's fundamental cone x >= y >= z >= 0 (or of its neighbour), and how much of it.
struct Share {
  SlabNormal normal;
  double weight;
};

/// The narrowest cone of three normals that contains (x, y, z) with x >= y >= z >= 0, all shares >= 0.
template <int K>
[[nodiscard]] constexpr std::array<Share, 3> shares(double x, double y, double z) noexcept {
  if constexpr (K == 26) return {{{{1, 0, 0}, x - y}, {{1, 1, 0}, y - z}, {{1, 1, 1}, z}}};
  if constexpr (K == 14) return {{{{1, 0, 0}, x - y}, {{1, 1, 1}, 0.5 * (y + z)}, {{1, 1, -1}, 0.5 * (y - z)}}};
  if (x >= y + z) return {{{{1, 0, 0}, x - y - z}, {{1, 1, 0}, y}, {{1, 0, 1}, z}}};
  return {{{{1, 1, 0}, 0.5 * (x + y - z)}, {{1, 0, 1}, 0.5 * (x + z - y)}, {{0, 1, 1}, 0.5 * (y + z - x)}}};
}

}  // namespace detail

/// The blend for `direction`: the cube's symmetries bring it into the fundamental cone, where the choice is a formula.
template <int K>
[[nodiscard]] inline SlabBlend blend_of(const Vec3& direction, double shift) noexcept {
  static constexpr auto table = detail::signed_slabs<K>();
  std::array<int, 3> order = {0, 1, 2};
  const auto longer_first = [&](std::size_t i, std::size_t j) {
    if (std::abs(direction[order[i]]) < std::abs(direction[order[j]])) std::swap(order[i], order[j]);
  };
  longer_first(0, 1);
  longer_first(1, 2);
  longer_first(0, 1);
  const auto shares =
      detail::shares<K>(std::abs(direction[order[0]]), std::abs(direction[order[1]]), std::abs(direction[order[2]]));
  SlabBlend blend;
  blend.shift = static_cast<float>(shift);
  for (std::size_t i = 0; i < 3; ++i) {
    constexpr std::array<int, 3> place_value = {9, 3, 1};
    int place = 13;
    for (std::size_t k = 0; k < 3; ++k) {
      const int sign = direction[order[k]] < 0.0 ? -1 : 1;
      place += place_value[static_cast<std::size_t>(order[k])] * sign * shares[i].normal[k];
    }
    const detail::SignedSlab& found = table[static_cast<std::size_t>(place)];
    blend.slab[i] = found.slab;
    blend.weight[i] = found.sign * static_cast<float>(shares[i].weight);
  }
  return blend;
}

}  // namespace odds::volume
