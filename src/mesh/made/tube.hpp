// A closed tube around a closed curve with a frame that closes by itself. Private to mesh/made.
#pragma once

#include <cmath>
#include <concepts>
#include <numbers>

#include "mesh/made/surface.hpp"

namespace odds::mesh::made {

/// A point of the centre line and the two unit vectors that span the section there; tangent = first x second.
struct Section {
  Vec3 centre;
  Vec3 first;
  Vec3 second;
};

/// `section(turn)` for turn in [0, 1) must be periodic with period 1.
template <std::invocable<double> Function>
Surface closed_tube(Function section, double radius, std::uint32_t along, std::uint32_t across) {
  Surface surface;
  for (std::uint32_t i = 0; i < along; ++i) {
    const Section at = section(static_cast<double>(i) / along);
    for (std::uint32_t j = 0; j < across; ++j) {
      const double angle = 2.0 * std::numbers::pi * j / across;
      surface.add(at.centre + radius * (std::cos(angle) * at.first + std::sin(angle) * at.second));
    }
  }
  for (std::uint32_t i = 0; i < along; ++i) {
    const std::uint32_t here = i * across;
    const std::uint32_t next = (i + 1) % along * across;
    for (std::uint32_t j = 0; j < across; ++j) {
      const std::uint32_t k = (j + 1) % across;
      surface.quad(here + j, here + k, next + k, next + j);
    }
  }
  return surface;
}

}  // namespace odds::mesh::made
