// Do two triangles meet? The kernel of the leaves.
#pragma once

#include "odds/math/types.hpp"

namespace odds::query {

/// Edge pq against triangle t by signs of plane distances and edge planes, in plain doubles.
inline bool segment_meets_triangle(const Vec3& p, const Vec3& q, const Vec3* t) noexcept {
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double above_p = normal.dot(p - t[0]);
  const double above_q = normal.dot(q - t[0]);
  if ((above_p > 0 && above_q > 0) || (above_p < 0 && above_q < 0) || above_p == above_q) return false;
  const Vec3 x = p + (q - p) * (above_p / (above_p - above_q));
  for (int i = 0; i < 3; ++i) {
    if (normal.dot((t[(i + 1) % 3] - t[i]).cross(x - t[i])) < 0) return false;
  }
  return true;
}

inline bool triangles_meet(const Vec3* a, const Vec3* b) noexcept {
  for (int i = 0; i < 3; ++i) {
    if (segment_meets_triangle(a[i], a[(i + 1) % 3], b) || segment_meets_triangle(b[i], b[(i + 1) % 3], a)) return true;
  }
  return false;
}

}  // namespace odds::query
