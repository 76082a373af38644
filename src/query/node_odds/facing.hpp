// In which direction two patches of surface push each other, from the statistics of their nodes.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "odds/math/float_sums.hpp"
#include "odds/math/pose.hpp"
#include "odds/tree/node_statistics.hpp"

namespace odds::query {

/// 1/m: of a cap of a ball of that area whose normals have that mean; it may be bent either way. 0 of what is no patch.
[[nodiscard]] inline double curvature_of(double area, double mean_normal) noexcept {
  constexpr double whole_sphere = 4.0 * std::numbers::pi;
  constexpr double least_bent = 1e-6;  // single precision says no more of what is flat
  const double squared = whole_sphere * std::max(1.0 - mean_normal, least_bent) / area;
  return area > 0.0 && std::isfinite(squared) ? std::sqrt(squared) : 0.0;
}

/// The direction into A in which two patches touch, from the means of their normals and `to_a`, from B's centroid to
/// A's; not unit.
///
/// Patches that a search has not looked into are larger than where they touch, and that is aside of their middles. Of
/// two balls of curvatures k and l it is known how far: where the patches are m and n and lie at p and q, the normal is
/// (k n - l m + k l (p - q)) / (k + l), whatever caps they are. Surfaces that touch are mostly bent as balls are; since
/// some are not, half of the way counts. Equal or unknown curvatures and one place leave the difference of the normals.
[[nodiscard]] inline Vec3 facing_where_they_touch(const Vec3& normal_a, double area_a, const Vec3& normal_b,
                                                  double area_b, const Vec3& to_a) noexcept {
  constexpr double trust = 0.5;
  const double bent_a = curvature_of(area_a, normal_a.norm());
  const double bent_b = curvature_of(area_b, normal_b.norm());
  const double share_a = bent_a / (bent_a + bent_b);
  if (!(share_a > 0.0 && share_a < 1.0)) return normal_b - normal_a;
  const Vec3 facing = 2.0 * (share_a * normal_b - (1.0 - share_a) * normal_a + trust * share_a * bent_b * to_a);
  const double length = facing.norm();  // of slivers far apart it would outweigh all other places
  return length > 2.0 ? Vec3(facing * (2.0 / length)) : facing;
}

/// What two patches say of the direction in which they push each other.
struct Facing {
  Vec3 direction;     ///< from outwards of A to into A: see facing_where_they_touch; 0 .. 2 long
  double opposition;  ///< 0 .. 1: how much the mean normals face each other; 0 of sides of an edge, that cannot meet
};

/// `sign_a`, `sign_b`: -1 of a sheet that is met from behind, else 1.
[[nodiscard]] inline Facing facing_of(const tree::NodeStatistics& a, const tree::NodeStatistics& b,
                                      const math::Pose& b_in_a, double sign_a = 1.0, double sign_b = 1.0) noexcept {
  const Vec3 normal_a = sign_a * a.mean_normal.cast<double>();
  const Vec3 normal_b = sign_b * (b_in_a.rotation * b.mean_normal.cast<double>());
  return {facing_where_they_touch(normal_a, static_cast<double>(a.area), normal_b, static_cast<double>(b.area),
                                  a.centroid.cast<double>() - b_in_a * b.centroid.cast<double>()),
          std::clamp(-normal_a.dot(normal_b), 0.0, 1.0)};
}

/// How flat both patches are, 0 .. 1: one that faces all ways, as of a whole closed body, has no side.
[[nodiscard]] inline double flatness_of(const tree::NodeStatistics& a, const tree::NodeStatistics& b) noexcept {
  return std::min(static_cast<double>(math::length(a.mean_normal) * math::length(b.mean_normal)), 1.0);
}

}  // namespace odds::query
