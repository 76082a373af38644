// Where the surfaces below two nodes meet, if they do, from the statistics of the nodes; four pairs at a time.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

#include "odds/math/elementary.hpp"
#include "query/node_odds/facing.hpp"

namespace odds::query {

/// What a pair of nodes says about where the surfaces meet; in A's tree frame, metres.
struct MetPlace {
  Vec3 position;         ///< see where_they_meet
  float log_likelihood;  ///< to base 2, that they meet: by how far both have to reach for it and how thin they are
  Vec3 direction;        ///< see FourFacings; never zero
  double opposition;     ///< see FourFacings
  Vec3 beyond;           ///< from A's centroid to B's
  double thickness;      ///< of the thinner of both patches
  double flatness;       ///< see flatness_of: what is not flat has no side to be beyond
  double inverse_size;   ///< of both bounding volumes together, 1/m
};

/// Where patches of surface probably are: normally distributed about their centroids, with half of their radius along
/// them and with as much across them as a slab's points have that are evenly spread in it. Lengths over some size.
struct PatchSpreads {
  Four along;          ///< variance along them
  Four thinner;        ///< how much less that across them is, >= 0
  FourVectors normal;  ///< unit, but for rounding

  [[nodiscard]] static PatchSpreads of(const Four& slab_half, const Four& radius, const Four& inverse_size,
                                       const FourVectors& normal) noexcept {
    // Of the size: nothing is thinner, so that two planes have a place in common, and rounding does not matter.
    const Four least = Four::all(1e-4F);
    const Four reach = 0.5F * radius * inverse_size;
    const Four thick = slab_half * inverse_size;
    const Four along = greater(reach * reach, least);
    return {along, greater(along - greater((1.0F / 3.0F) * (thick * thick), least), Four::all(0.0F)), normal};
  }
};

/// The likeliest places of points of two patches, and how likely they are: of two normal distributions the product is
/// one, too.
struct Meetings {
  FourVectors from_a;  ///< from A's centroids, in the unit of `beyond`
  Four determinant;    ///< see where_they_meet
  Four squared;

  /// To base 2.
  [[nodiscard]] float log_likelihood(std::size_t i) const noexcept {
    return -0.5F * (math::rough_log2(static_cast<double>(determinant[i])) + std::numbers::log2e_v<float> * squared[i]);
  }
};

/// `beyond`: from A's centroids to B's, over the spreads' size. With covariances C and D the place is C (C + D)^-1
/// beyond, and -2 ln of the likelihood is ln det (C + D) + beyond' (C + D)^-1 beyond.
[[nodiscard]] inline Meetings where_they_meet(const PatchSpreads& a, const PatchSpreads& b,
                                              const FourVectors& beyond) noexcept {
  // C + D = sum I - a.thinner m m' - b.thinner n n', inverted by Woodbury's identity.
  const Four sum = a.along + b.along;
  const Four cosine = dot(a.normal, b.normal);
  const Four left_a = sum - a.thinner;
  const Four left_b = sum - b.thinner;
  const Four both = a.thinner * b.thinner * cosine;
  const Four rest = left_a * left_b - both * cosine;
  const Four up_a = dot(a.normal, beyond);
  const Four up_b = dot(b.normal, beyond);
  const Four by_rest = 1.0F / rest;
  const Four more_a = (a.thinner * left_b * up_a + both * up_b) * by_rest;
  const Four more_b = (b.thinner * left_a * up_b + both * up_a) * by_rest;
  const FourVectors solved = (1.0F / sum) * (beyond + more_a * a.normal + more_b * b.normal);
  return {a.along * solved - (a.thinner * dot(a.normal, solved)) * a.normal, sum * rest, dot(beyond, solved)};
}

/// As far as that at most, and in the same direction.
[[nodiscard]] inline FourVectors no_farther(const Four& radius, const FourVectors& away) noexcept {
  const Four squared = dot(away, away);
  return choose(radius * radius < squared, radius / root(squared), Four::all(1.0F)) * away;
}

/// Of the thinner of both patches, metres.
[[nodiscard]] inline double thickness_of(const tree::NodeStatistics& a, const tree::NodeStatistics& b) noexcept {
  return 2.0 * static_cast<double>(std::min(a.slab_half, b.slab_half));
}

/// A node of each body, with the radii of their bounding volumes, metres.
struct PatchPair {
  const tree::NodeStatistics* a;
  const tree::NodeStatistics* b;
  float radius_a;
  float radius_b;
};

/// Of one to four pairs. `b_in_a` of the trees' frames. The places lie within both, for planes that are nearly parallel
/// cross far from both patches.
inline void find_met_places(std::span<const PatchPair> pairs, const math::Pose& b_in_a,
                            std::span<MetPlace> places) noexcept {
  const auto pair = [&](std::size_t i) -> const PatchPair& { return pairs[std::min(i, pairs.size() - 1)]; };
  const auto of_a = [&](std::size_t i) { return pair(i).a; };
  const auto of_b = [&](std::size_t i) { return pair(i).b; };
  const Four radius_a = Four::from([&](std::size_t i) { return pair(i).radius_a; });
  const Four radius_b = Four::from([&](std::size_t i) { return pair(i).radius_b; });
  const math::PoseOfFour pose(b_in_a);
  const FourPatches a = FourPatches::from(of_a);
  const FourPatches b = FourPatches::from(of_b).placed(pose);
  const auto spreads = [&](const auto& patch, const Four& radius, const Four& inverse_size, const auto& normals) {
    const Four slab_half = Four::from([&](std::size_t i) { return patch(i)->slab_half; });
    return PatchSpreads::of(slab_half, radius, inverse_size, normals);
  };
  const auto slab_normals = [](const auto& patch) {
    return FourVectors::from([&](std::size_t i) -> const Vec3f& { return patch(i)->slab_normal; });
  };
  const Four size = greater(radius_a + radius_b, Four::all(1e-30F));
  const Four inverse_size = 1.0F / size;
  const FourVectors beyond = b.centroid - a.centroid;
  const FourVectors normal_b = pose.turn(slab_normals(of_b));
  const Meetings meetings = where_they_meet(spreads(of_a, radius_a, inverse_size, slab_normals(of_a)),
                                            spreads(of_b, radius_b, inverse_size, normal_b), inverse_size * beyond);
  // Radii of 1e19 m are infinite.
  const math::FourTruths known = are_finite(dot(meetings.from_a, meetings.from_a)) & are_finite(meetings.determinant) &
                                 are_finite(meetings.squared);
  const FourVectors from_a = choose(known, no_farther(radius_a, size * meetings.from_a), 0.5F * beyond);
  const FourVectors position = b.centroid + no_farther(radius_b, from_a - beyond);
  const FourFacings facings = facings_of(a, b);
  constexpr float closed = 1e-3F;
  const FourVectors direction =
      choose(closed * closed < dot(facings.direction, facings.direction), facings.direction, closed * normal_b);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const float log_likelihood = meetings.log_likelihood(i);
    places[i] = {position[i],
                 std::isfinite(log_likelihood) ? std::clamp(log_likelihood, -40.0F, 40.0F) : 0.0F,
                 direction[i],
                 static_cast<double>(facings.opposition[i]),
                 beyond[i],
                 thickness_of(*pairs[i].a, *pairs[i].b),
                 flatness_of(*pairs[i].a, *pairs[i].b),
                 static_cast<double>(inverse_size[i])};
  }
}

}  // namespace odds::query
