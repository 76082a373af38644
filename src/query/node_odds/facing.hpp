// In which direction patches of surface push each other, from the statistics of their nodes; four pairs at a time.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "math/four.hpp"
#include "odds/math/float_sums.hpp"
#include "odds/math/pose.hpp"
#include "odds/tree/node_statistics.hpp"

namespace odds::query {

using math::Four;
using math::FourVectors;

/// 1/m: of a cap of a ball of that area whose normals have that mean; it may be bent either way. 0 of what is no patch.
[[nodiscard]] inline Four curvature_of(const Four& area, const Four& mean_normal) noexcept {
  constexpr auto whole_sphere = static_cast<float>(4.0 * std::numbers::pi);
  constexpr float least_bent = 1e-6F;  // single precision says no more of what is flat
  const Four squared = whole_sphere * greater(1.0F - mean_normal, Four::all(least_bent)) / area;
  return choose((0.0F < area) & are_finite(squared), root(squared), Four::all(0.0F));
}

/// Patches of surface of one body.
struct FourPatches {
  Four area;                ///< m^2
  FourVectors centroid;     ///< metres
  FourVectors mean_normal;  ///< the longer the flatter, at most 1

  /// What `of(i)` points to, in their hierarchy's frame.
  template <class Of>
  [[nodiscard]] static FourPatches from(const Of& of) noexcept {
    return {Four::from([&](std::size_t i) { return of(i)->area; }),
            FourVectors::from([&](std::size_t i) -> const Vec3f& { return of(i)->centroid; }),
            FourVectors::from([&](std::size_t i) -> const Vec3f& { return of(i)->mean_normal; })};
  }
  /// `sign`: -1 of sheets that are met from behind, else 1.
  [[nodiscard]] FourPatches seen_from(float sign) const noexcept { return {area, centroid, sign * mean_normal}; }
  [[nodiscard]] FourPatches placed(const math::PoseOfFour& pose) const noexcept {
    return {area, pose.place(centroid), pose.turn(mean_normal)};
  }
};

/// What pairs of patches say of the direction in which they push each other.
struct FourFacings {
  FourVectors direction;  ///< from outwards of A to into A: see facing_where_they_touch; 0 .. 2 long
  Four opposition;  ///< 0 .. 1: how much the mean normals face each other; 0 of sides of an edge, that cannot meet
};

/// The direction into A in which two patches touch, from the means of their normals and where they are; not unit.
///
/// Patches that a search has not looked into are larger than where they touch, and that is aside of their middles. Of
/// two balls of curvatures k and l it is known how far: where the patches are m and n and lie at p and q, the normal is
/// (k n - l m + k l (p - q)) / (k + l), whatever caps they are. Surfaces that touch are mostly bent as balls are; since
/// some are not, half of the way counts. Equal or unknown curvatures and one place leave the difference of the normals.
[[nodiscard]] inline FourVectors facing_where_they_touch(const FourPatches& a, const FourPatches& b) noexcept {
  constexpr float trust = 0.5F;
  const Four bent_a = curvature_of(a.area, length(a.mean_normal));
  const Four bent_b = curvature_of(b.area, length(b.mean_normal));
  const Four share_a = bent_a / (bent_a + bent_b);
  const FourVectors facing = 2.0F * (share_a * b.mean_normal - (1.0F - share_a) * a.mean_normal +
                                     trust * share_a * bent_b * (a.centroid - b.centroid));
  const Four long_one = length(facing);  // of slivers far apart it would outweigh all other places
  const Four scale = choose(2.0F < long_one, 2.0F / long_one, Four::all(1.0F));
  return choose((0.0F < share_a) & (share_a < 1.0F), scale * facing, b.mean_normal - a.mean_normal);
}

/// Patches of A and of B, both in A's frame.
[[nodiscard]] inline FourFacings facings_of(const FourPatches& a, const FourPatches& b) noexcept {
  const Four facing = 0.0F - dot(a.mean_normal, b.mean_normal);
  return {facing_where_they_touch(a, b), lesser(greater(facing, Four::all(0.0F)), Four::all(1.0F))};
}

/// How flat both patches are, 0 .. 1: one that faces all ways, as of a whole closed body, has no side.
[[nodiscard]] inline double flatness_of(const tree::NodeStatistics& a, const tree::NodeStatistics& b) noexcept {
  return std::min(static_cast<double>(math::length(a.mean_normal) * math::length(b.mean_normal)), 1.0);
}

}  // namespace odds::query
