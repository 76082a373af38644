// Where the surfaces below two nodes meet, if they do, from the statistics of the nodes.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "odds/math/elementary.hpp"
#include "query/node_odds/facing.hpp"

namespace odds::query {

/// What a pair of nodes says about where the surfaces meet; in A's tree frame, metres.
struct MetPlace {
  Vec3 position;         ///< see where_they_meet
  float log_likelihood;  ///< to base 2, that they meet: by how far both have to reach for it and how thin they are
  Facing facing;         ///< its direction is never zero
  Vec3 beyond;           ///< from A's centroid to B's
  double thickness;      ///< of the thinner of both patches
  double flatness;       ///< see flatness_of: what is not flat has no side to be beyond
  double inverse_size;   ///< of both bounding volumes together, 1/m
};

/// Where a patch of surface probably is: normally distributed about its centroid, with half of its radius along it and
/// with as much across it as a slab's points have that are evenly spread in it. Lengths over some size.
struct PatchSpread {
  double along;    ///< variance along it
  double thinner;  ///< how much less that across it is, >= 0
  Vec3 normal;     ///< unit, but for rounding

  [[nodiscard]] static PatchSpread of(const tree::NodeStatistics& patch, double radius, double inverse_size,
                                      const Vec3& normal) noexcept {
    // Of the size: nothing is thinner, so that two planes have a place in common, and rounding does not matter.
    constexpr double least = 1e-4;
    const double reach = 0.5 * radius * inverse_size;
    const double thick = static_cast<double>(patch.slab_half) * inverse_size;
    const double along = std::max(reach * reach, least);
    return {along, std::max(along - std::max(thick * thick * (1.0 / 3.0), least), 0.0), normal};
  }
};

/// The likeliest place of a point of two patches, and how likely it is: of two normal distributions the product is one,
/// too.
struct Meeting {
  Vec3 from_a;           ///< from A's centroid, in the unit of `beyond`
  float log_likelihood;  ///< to base 2
};

/// `beyond`: from A's centroid to B's, over the spreads' size. With covariances C and D the place is C (C + D)^-1
/// beyond, and -2 ln of the likelihood is ln det (C + D) + beyond' (C + D)^-1 beyond.
[[nodiscard]] inline Meeting where_they_meet(const PatchSpread& a, const PatchSpread& b, const Vec3& beyond) noexcept {
  // C + D = sum I - a.thinner m m' - b.thinner n n', inverted by Woodbury's identity.
  const double sum = a.along + b.along;
  const double cosine = a.normal.dot(b.normal);
  const double left_a = sum - a.thinner;
  const double left_b = sum - b.thinner;
  const double both = a.thinner * b.thinner * cosine;
  const double rest = left_a * left_b - both * cosine;
  const double up_a = a.normal.dot(beyond);
  const double up_b = b.normal.dot(beyond);
  const double by_rest = 1.0 / rest;
  const double more_a = (a.thinner * left_b * up_a + both * up_b) * by_rest;
  const double more_b = (b.thinner * left_a * up_b + both * up_a) * by_rest;
  const Vec3 solved = (beyond + more_a * a.normal + more_b * b.normal) * (1.0 / sum);
  const double squared = beyond.dot(solved);
  return {a.along * solved - a.thinner * a.normal.dot(solved) * a.normal,
          -0.5F * (math::rough_log2(sum * rest) + static_cast<float>(squared * std::numbers::log2e))};
}

/// As far as that at most, and in the same direction.
[[nodiscard]] inline Vec3 no_farther(double radius, const Vec3& away) noexcept {
  const double squared = away.squaredNorm();
  return squared > radius * radius ? Vec3(radius / std::sqrt(squared) * away) : away;
}

/// Of the thinner of both patches, metres.
[[nodiscard]] inline double thickness_of(const tree::NodeStatistics& a, const tree::NodeStatistics& b) noexcept {
  return 2.0 * static_cast<double>(std::min(a.slab_half, b.slab_half));
}

/// `b_in_a` of the trees' frames; radii of the bounding volumes. The place lies within both, for planes that are nearly
/// parallel cross far from both patches.
[[nodiscard]] inline MetPlace met_place(const tree::NodeStatistics& a, const tree::NodeStatistics& b, double radius_a,
                                        double radius_b, const math::Pose& b_in_a) noexcept {
  const Vec3 centroid_a = a.centroid.cast<double>();
  const Vec3 centroid_b = b_in_a * b.centroid.cast<double>();
  const double size = std::max(radius_a + radius_b, 1e-300);
  MetPlace place;
  place.inverse_size = 1.0 / size;
  place.beyond = centroid_b - centroid_a;
  const Meeting meeting =
      where_they_meet(PatchSpread::of(a, radius_a, place.inverse_size, a.slab_normal.cast<double>()),
                      PatchSpread::of(b, radius_b, place.inverse_size, b_in_a.rotation * b.slab_normal.cast<double>()),
                      place.inverse_size * place.beyond);
  // Radii of 1e19 m are infinite.
  const bool known = meeting.from_a.allFinite() && std::isfinite(meeting.log_likelihood);
  const Vec3 from_a = known ? no_farther(radius_a, size * meeting.from_a) : Vec3(0.5 * place.beyond);
  place.position = centroid_b + no_farther(radius_b, from_a - place.beyond);
  place.log_likelihood = known ? std::clamp(meeting.log_likelihood, -40.0F, 40.0F) : 0.0F;
  place.facing = facing_of(a, b, b_in_a);
  constexpr double closed = 1e-3;
  if (!(place.facing.direction.squaredNorm() > closed * closed)) {
    place.facing.direction = closed * (b_in_a.rotation * b.slab_normal.cast<double>());
  }
  place.thickness = thickness_of(a, b);
  place.flatness = flatness_of(a, b);
  return place;
}

}  // namespace odds::query
