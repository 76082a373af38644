// A ray that slips through no edge: where it crosses triangles that share edges and corners.
#pragma once

#include "odds/math/types.hpp"

namespace odds::primitive {

/// Woop, Benthin and Wald 2013: each corner is moved to where the ray, as it sees it, is the z axis, by a function of
/// the corner alone, so that all triangles that share it agree where it is; on which side of the edges the ray passes
/// is decided by exact signs. Thread-safe.
class WatertightRay {
 public:
  /// Any frame; metres; `direction` of unit length, finite. `front_only`: triangles met from behind do not count, the
  /// front being where the corners turn counter-clockwise.
  WatertightRay(const Vec3& origin, const Vec3& direction, bool front_only) noexcept;

  /// A triangle without an area, which has no normal, counts as so much farther, relatively: wherever rounding does not
  /// part the neighbours whose gap it closes, one of them is met first.
  static constexpr double no_area_is_farther = 1e-11;

  /// The distance along the ray at which it crosses the triangle, or a negative number, as also where that is behind
  /// its origin. Borders belong to the triangle. One that is seen edge-on is not crossed, for then its neighbours are.
  [[nodiscard]] double crossing(const Vec3 corners[3]) const noexcept;

 private:
  Vec3 origin_;
  Vec3 direction_;
  bool front_only_;
  int x_;  ///< z_: the axis along which the ray is longest; x_, y_: the other two, in cyclic order
  int y_;
  int z_;
};

}  // namespace odds::primitive
