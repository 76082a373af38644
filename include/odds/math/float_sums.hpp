// Sums of three products of floats, in one order on all processors. Eigen adds them as (0 + 1) + 2 where it has
// registers of two floats (64-bit ARM), and as 0 + (1 + 2) elsewhere: the last bit of a volume's radius or of a node's
// odds would tell the processor, and the order of a search with it. Of doubles it has one order.
#pragma once

#include <cmath>

#include "odds/math/types.hpp"

namespace odds::math {

[[nodiscard]] inline float dot(const Vec3f& a, const Vec3f& b) noexcept {
  return a.x() * b.x() + (a.y() * b.y() + a.z() * b.z());
}

[[nodiscard]] inline float squared_length(const Vec3f& v) noexcept { return dot(v, v); }

[[nodiscard]] inline float length(const Vec3f& v) noexcept { return std::sqrt(squared_length(v)); }

/// M v.
[[nodiscard]] inline Vec3f times(const Mat3f& m, const Vec3f& v) noexcept {
  return {dot(m.row(0), v), dot(m.row(1), v), dot(m.row(2), v)};
}

/// M N.
[[nodiscard]] inline Mat3f times(const Mat3f& m, const Mat3f& n) noexcept {
  Mat3f product;
  for (int j = 0; j < 3; ++j) product.col(j) = times(m, Vec3f(n.col(j)));
  return product;
}

}  // namespace odds::math
