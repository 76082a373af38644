// Separating axes in the box's frame, each with room for the rounding of what is compared.
#include "odds/primitive/triangle_box.hpp"

#include <algorithm>

namespace odds::primitive {

bool triangle_may_overlap_box(const Vec3 triangle[3], const Vec3& center, const Mat3& axes,
                              const Vec3& half_extents) noexcept {
  Vec3 corner[3];
  double reach = half_extents.maxCoeff();
  for (int i = 0; i < 3; ++i) {
    const Vec3 offset = triangle[i] - center;
    corner[i] = axes.transpose() * offset;
    reach = std::max(reach, offset.cwiseAbs().maxCoeff());
  }
  // Turning into the frame errs by less than 8 u of the reach in each coordinate (u = 2^-53), and by as much again if
  // the axes are orthonormal only to rounding; twice that leaves room for the rounding of the corners themselves.
  // Products of two such numbers err by less than 8 times as much of the square, those of three by 64 of the cube.
  constexpr double unit = 0x1p-53;
  const double length_error = 32.0 * unit * reach;
  const double area_error = 8.0 * length_error * reach;
  const double volume_error = 8.0 * area_error * reach;

  for (int i = 0; i < 3; ++i) {
    const double room = half_extents[i] + length_error;
    if (std::min({corner[0][i], corner[1][i], corner[2][i]}) > room) return false;
    if (std::max({corner[0][i], corner[1][i], corner[2][i]}) < -room) return false;
  }
  const Vec3 edge[3] = {corner[1] - corner[0], corner[2] - corner[1], corner[0] - corner[2]};
  const Vec3 normal = edge[0].cross(edge[1]);
  const double height = normal.dot(corner[0]);
  if (std::abs(height) > normal.cwiseAbs().dot(half_extents) + volume_error) return false;

  for (const Vec3& e : edge) {
    for (int i = 0; i < 3; ++i) {
      const int u = (i + 1) % 3;
      const int v = (i + 2) % 3;
      // The axis is unit(i) x e; along it the box reaches as far as `room` on both sides.
      const double room = half_extents[u] * std::abs(e[v]) + half_extents[v] * std::abs(e[u]) + area_error;
      const double at[3] = {corner[0][v] * e[u] - corner[0][u] * e[v], corner[1][v] * e[u] - corner[1][u] * e[v],
                            corner[2][v] * e[u] - corner[2][u] * e[v]};
      if (std::min({at[0], at[1], at[2]}) > room || std::max({at[0], at[1], at[2]}) < -room) return false;
    }
  }
  return true;
}

}  // namespace odds::primitive
