// Which way two bodies come apart, by nothing but the boxes about them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "odds/math/pose.hpp"
#include "odds/mesh/triangle_mesh.hpp"

namespace odds::query {

/// Of the sides of both meshes' boxes the one along which they overlap least, pointing from B to A, in A's mesh frame;
/// unit. From centre to centre a small body on the end of a long one would be pushed along it.
[[nodiscard]] inline Vec3 way_apart(const mesh::TriangleMesh& a, const mesh::TriangleMesh& b,
                                    const math::Pose& b_in_a) noexcept {
  const Vec3 half_a = 0.5 * (a.upper() - a.lower());
  const Vec3 half_b = 0.5 * (b.upper() - b.lower());
  const Vec3 from_b = 0.5 * (a.upper() + a.lower()) - b_in_a * Vec3(0.5 * (b.upper() + b.lower()));
  const Mat3 turned = b_in_a.rotation.cwiseAbs();
  const std::array<Vec3, 2> reach{half_a + turned * half_b, half_b + turned.transpose() * half_a};
  const std::array<Mat3, 2> sides{Mat3::Identity(), b_in_a.rotation};
  Vec3 way = Vec3::UnitZ();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t body = 0; body < 2; ++body) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double along = sides[body].col(axis).dot(from_b);
      const double overlap = reach[body][axis] - std::abs(along);
      if (!(overlap < least)) continue;
      least = overlap;
      way = std::copysign(1.0, along) * sides[body].col(axis);
    }
  }
  return way;
}

}  // namespace odds::query
