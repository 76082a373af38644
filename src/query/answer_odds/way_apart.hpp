// Which way two bodies come apart, by nothing but the boxes about them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "odds/math/pose.hpp"
#include "odds/mesh/triangle_mesh.hpp"

namespace odds::query {

struct WayApart {
  Vec3 direction = Vec3::UnitZ();  ///< from B to A, in A's mesh frame; unit
  /// What surfaces do that reach so little into each other's box is to part along it: 1 where the boxes only touch, 0
  /// where they overlap by a tenth of the thinner one.
  double worth = 0.0;
};

/// Of the sides of both meshes' boxes the one along which they overlap least. From centre to centre a small body on the
/// end of a long one would be pushed along it.
[[nodiscard]] inline WayApart way_apart(const mesh::TriangleMesh& a, const mesh::TriangleMesh& b,
                                        const math::Pose& b_in_a) noexcept {
  const Vec3 half_a = 0.5 * (a.upper() - a.lower());
  const Vec3 half_b = 0.5 * (b.upper() - b.lower());
  const Vec3 from_b = 0.5 * (a.upper() + a.lower()) - b_in_a * Vec3(0.5 * (b.upper() + b.lower()));
  const Mat3 turned = b_in_a.rotation.cwiseAbs();
  const std::array<Vec3, 2> reach{half_a + turned * half_b, half_b + turned.transpose() * half_a};
  const std::array<Mat3, 2> sides{Mat3::Identity(), b_in_a.rotation};
  constexpr double thin = 0.1;
  WayApart way;
  double thinner = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t body = 0; body < 2; ++body) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double along = sides[body].col(axis).dot(from_b);
      const double overlap = reach[body][axis] - std::abs(along);
      if (!(overlap < least)) continue;
      least = overlap;
      way.direction = std::copysign(1.0, along) * sides[body].col(axis);
      const double own = (body == 0 ? half_a : half_b)[axis];
      thinner = 2.0 * std::min(own, reach[body][axis] - own);
    }
  }
  if (thinner > 0.0) way.worth = std::clamp(1.0 - least / (thin * thinner), 0.0, 1.0);
  return way;
}

}  // namespace odds::query
