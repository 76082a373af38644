// The exact test for triangles without area.
#include <algorithm>
#include <cmath>

#include "odds/math/exact.hpp"
#include "odds/mesh/faults.hpp"

namespace odds::mesh {
namespace {

/// Scales one axis of three points up by a power of two, so that products of differences do not underflow. Exact.
void scale_axis(std::array<Vec3, 3>& points, Eigen::Index axis) {
  double largest = 0.0;
  for (const Vec3& p : points) largest = std::max(largest, std::abs(p[axis]));
  if (largest == 0.0 || largest >= 1.0) return;
  const int exponent = -std::ilogb(largest);
  for (Vec3& p : points) p[axis] = std::ldexp(p[axis], exponent);
}

/// Whether the projection to the plane of axes u and v has exactly zero area.
bool flat_in_plane(const std::array<Vec3, 3>& p, Eigen::Index u, Eigen::Index v) {
  const auto difference = [&](std::size_t i, Eigen::Index axis) {
    return math::Expansion<2>(math::two_difference(p[i][axis], p[2][axis]));
  };
  const auto left = difference(0, u) * difference(1, v);
  const auto right = difference(0, v) * difference(1, u);
  return (left - right).sign() == 0;
}

}  // namespace

bool has_zero_area(const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  // Almost all triangles are settled here: a component of the cross product exceeds its own rounding error (Shewchuk
  // 1997, the bound of the first stage of orient2d, with a margin; the second condition keeps off underflow).
  constexpr double bound = 4.0 * 0x1p-53;
  const Vec3 p = a - c;
  const Vec3 q = b - c;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Eigen::Index u = (axis + 1) % 3;
    const Eigen::Index v = (axis + 2) % 3;
    const double left = p[u] * q[v];
    const double right = p[v] * q[u];
    const double magnitude = std::abs(left) + std::abs(right);
    if (std::abs(left - right) > bound * magnitude && magnitude > 1e-280) return false;
  }
  std::array<Vec3, 3> points = {a, b, c};
  for (Eigen::Index axis = 0; axis < 3; ++axis) scale_axis(points, axis);
  return flat_in_plane(points, 0, 1) && flat_in_plane(points, 1, 2) && flat_in_plane(points, 2, 0);
}

}  // namespace odds::mesh
