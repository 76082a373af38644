// What the statistics of two nodes say about the surfaces below them: how probably they meet, and where.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "odds/math/pose.hpp"
#include "odds/probability/balls_into_bins.hpp"
#include "odds/probability/kinematic.hpp"
#include "odds/query/answer.hpp"
#include "odds/query/request.hpp"
#include "odds/volume/kind.hpp"

namespace odds::query {

/// Two nodes whose volumes overlap. `rotation` maps B's frame to A's; volumes in m^3.
struct NodesMet {
  const tree::NodeStatistics& a;
  const tree::NodeStatistics& b;
  const Mat3f& rotation;
  double volume_a;
  double volume_b;
  double common;  ///< estimated volume of the overlap
};

/// Levels of both trees, root = 1.
struct TreeLevels {
  std::uint32_t a;
  std::uint32_t b;
};

/// Estimated probability that surfaces below both nodes meet, in [0, 1]: the book's (4.15), (4.16) with the collision
/// inside a shared cell of Zachmann 2007, or the kinematic rate.
[[nodiscard]] inline float met_probability(const NodesMet& met, EstimatorKind estimator, TreeLevels levels) noexcept {
  float p = 0.0F;
  if (estimator == EstimatorKind::cells) {
    const probability::CellCounts counts = probability::cells_in_overlap(
        met.a.well_filled_cells, met.b.well_filled_cells, met.common, met.volume_a, met.volume_b);
    p = static_cast<float>(probability::collision_probability(
        counts, probability::collision_in_shared_cell(met.a.depth, met.b.depth, static_cast<int>(levels.a) - 1,
                                                      static_cast<int>(levels.b) - 1)));
  } else {
    p = probability::kinematic(met.a, met.b, met.rotation, met.volume_a, met.volume_b, met.common);
  }
  return std::isfinite(p) ? std::clamp(p, 0.0F, 1.0F) : 0.5F;
}

/// What orders a search: log2 of lambda, where 1 - exp(-lambda) is the probability. Cheaper than the probability itself
/// where the estimator is kinematic.
[[nodiscard]] inline float met_rank(const NodesMet& met, EstimatorKind estimator, TreeLevels levels) noexcept {
  if (estimator == EstimatorKind::cells) {
    const float p = std::min(met_probability(met, estimator, levels), 1.0F - 1e-7F);
    return math::rough_log2(-std::log1p(-static_cast<double>(p)));
  }
  return probability::log_kinematic_rate(met.a, met.b, met.rotation, met.common);
}

/// What a pair of nodes is known by besides its volumes: where both surfaces are, and how far they reach.
struct NodesPlaced {
  const Vec3f& b_in_a;  ///< of the trees' frames' origins, metres
  float radius_a;       ///< of the bounding volumes, metres
  float radius_b;
};

/// Numbers from which the odds of a pair of nodes are made, all of order 1 to 10.
struct NodeNumbers {
  static constexpr std::size_t count = 12;
  static constexpr std::size_t usual = 7;  ///< the others tell more of pairs of hulls: see numbers_used
  /// 1; log2 of the kinematic rate; of which the mean sine; how deep each surface lies in the other's slab, the lesser
  /// of both: 1 in its middle, 0 where they part, as far as is known of how they are turned; levels below both; leaves
  /// among both; distance of the centroids over both radii. Further ones: log2 of the share of the lesser volume that
  /// is in both; cosine between the slabs; levels below both, squared, over ten; how much the surfaces face the same
  /// way, as in nested shells, 0 .. 1; that times the levels.
  std::array<float, count> x{};
};

/// How many of the numbers the stated odds of such volumes are made from: that hulls overlap says less of how much of
/// their surfaces does.
[[nodiscard]] constexpr std::size_t numbers_used(volume::Kind kind) noexcept {
  return kind == volume::Kind::hull ? NodeNumbers::count : NodeNumbers::usual;
}

/// The first `used` of them; the others are 0. In single precision and with few divisions: a search that asks for the
/// odds of every pair that it meets spends half of its time here.
[[nodiscard]] inline NodeNumbers numbers_of(const NodesMet& met, const NodesPlaced& placed,
                                            std::size_t used = NodeNumbers::count) noexcept {
  const tree::NodeStatistics& a = met.a;
  const tree::NodeStatistics& b = met.b;
  const float log_sine =
      0.5F * math::rough_log2(static_cast<double>(probability::mean_square_sine(a, b, met.rotation) + 1e-4F));
  const float log_shares = 2.0F * math::rough_log2(met.common) - a.log_volume - b.log_volume;
  const float log_rate = a.log_relative_area + b.log_relative_area + log_shares * (1.0F / 3.0F) + log_sine;
  const Vec3f normal_b = met.rotation * b.slab_normal;
  const Vec3f centroid_b = met.rotation * b.centroid + placed.b_in_a;
  const float cosine = std::min(std::abs(a.slab_normal.dot(normal_b)), 1.0F);
  constexpr float usual_reach = 0.5F;  // of the radius: a surface rarely fills the ball about it
  const float sine = usual_reach * std::sqrt(1.0F - cosine * cosine);
  const float away_a = std::abs(a.slab_normal.dot(centroid_b) - a.slab_center);
  const float away_b = std::abs(normal_b.dot(a.centroid - placed.b_in_a) - b.slab_center);
  const float thick_a = a.slab_half + b.slab_half * cosine + placed.radius_b * sine;
  const float thick_b = b.slab_half + a.slab_half * cosine + placed.radius_a * sine;
  const bool first = away_a * thick_b > away_b * thick_a;
  const float depth = 1.0F - (first ? away_a : away_b) / std::max(first ? thick_a : thick_b, 1e-37F);
  const float apart = (centroid_b - a.centroid).norm() / std::max(placed.radius_a + placed.radius_b, 1e-37F);
  NodeNumbers numbers;
  numbers.x = {1.0F,
               std::clamp(log_rate, -12.0F, 8.0F),
               log_sine,
               std::clamp(depth, -2.0F, 1.0F),
               static_cast<float>(a.height + b.height),
               static_cast<float>((a.height == 0 ? 1 : 0) + (b.height == 0 ? 1 : 0)),
               std::clamp(apart, 0.0F, 2.0F)};
  if (used > NodeNumbers::usual) {
    const float share = math::rough_log2(met.common) - std::min(a.log_volume, b.log_volume);
    const float levels = numbers.x[4];
    const float facing = std::clamp(a.mean_normal.dot(met.rotation * b.mean_normal), 0.0F, 1.0F);
    numbers.x[7] = std::clamp(share, -20.0F, 4.0F);
    numbers.x[8] = cosine;
    numbers.x[9] = 0.1F * levels * levels;
    numbers.x[10] = facing;
    numbers.x[11] = facing * levels;
  }
  return numbers;
}

/// Weights of the numbers, of one kind of bounding volume.
using NodeWeights = std::array<float, NodeNumbers::count>;

/// Natural logarithm of the odds that surfaces below both nodes meet, by the first `used` numbers; 0 where nothing can
/// be said.
[[nodiscard]] inline float log_odds(const NodeNumbers& numbers, const NodeWeights& weights,
                                    std::size_t used = NodeNumbers::count) noexcept {
  float z = 0.0F;
  for (std::size_t i = 0; i < used; ++i) z += weights[i] * numbers.x[i];
  return std::isfinite(z) ? z : 0.0F;
}

/// 1 / (1 + exp(-z)).
[[nodiscard]] inline float probability_of_log_odds(float z) noexcept {
  const float upper = 1.0F / (2.0F - math::probability_of_rate(z < 0.0F ? -z : z));
  return z < 0.0F ? 1.0F - upper : upper;
}

/// log2 of the rate that such odds are those of, to about 0.1 where the odds are below one; of greater ones only the
/// order matters.
[[nodiscard]] inline float log_rate_of_log_odds(float z) noexcept { return 1.44269504F * (z < 0.0F ? z : 0.5F * z); }

/// What a pair of nodes says about where the surfaces meet; in A's tree frame, metres.
struct MetPlace {
  Vec3 position;         ///< see where_they_meet
  float log_likelihood;  ///< to base 2, that they meet: by how far both have to reach for it and how thin they are
  Vec3 facing;           ///< from outwards of A to into A: see facing_where_they_touch; 0 .. 2 long
  double opposition;     ///< 0 .. 1: how much the mean normals face each other; 0 of sides of an edge, that cannot meet
  Vec3 beyond;           ///< from A's centroid to B's
  double thickness;      ///< of the thinner of both patches
  double flatness;       ///< 0 .. 1: a patch that faces all ways, as of a whole closed body, has no side to be beyond
  double inverse_size;   ///< of both bounding volumes together, 1/m
};

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

/// As far as that, and in the same direction.
[[nodiscard]] inline Vec3 within(double radius, const Vec3& away) noexcept {
  const double squared = away.squaredNorm();
  return squared > radius * radius ? Vec3(radius / std::sqrt(squared) * away) : away;
}

/// Of the thinner of both patches, metres.
[[nodiscard]] inline double thickness_of(const tree::NodeStatistics& a, const tree::NodeStatistics& b) noexcept {
  return 2.0 * static_cast<double>(std::min(a.slab_half, b.slab_half));
}

/// `b_in_a` of the trees' frames; radii of the bounding volumes.
[[nodiscard]] inline MetPlace met_place(const tree::NodeStatistics& a, const tree::NodeStatistics& b, double radius_a,
                                        double radius_b, const math::Pose& b_in_a) noexcept {
  const Vec3 centroid_a = a.centroid.cast<double>();
  const Vec3 centroid_b = b_in_a * b.centroid.cast<double>();
  const Vec3 normal_a = a.mean_normal.cast<double>();
  const Vec3 normal_b = b_in_a.rotation * b.mean_normal.cast<double>();
  MetPlace place;
  place.inverse_size = 1.0 / std::max(radius_a + radius_b, 1e-300);
  place.beyond = centroid_b - centroid_a;
  const Meeting meeting =
      where_they_meet(PatchSpread::of(a, radius_a, place.inverse_size, a.slab_normal.cast<double>()),
                      PatchSpread::of(b, radius_b, place.inverse_size, b_in_a.rotation * b.slab_normal.cast<double>()),
                      place.inverse_size * place.beyond);
  // Radii of 1e19 m are infinite.
  const bool known = meeting.from_a.allFinite() && std::isfinite(meeting.log_likelihood);
  // Planes that are nearly parallel cross far from both patches.
  const double size = std::max(radius_a + radius_b, 1e-300);
  const Vec3 from_a = known ? within(radius_a, size * meeting.from_a) : Vec3(0.5 * place.beyond);
  place.position = centroid_b + within(radius_b, from_a - place.beyond);
  place.log_likelihood = known ? std::clamp(meeting.log_likelihood, -40.0F, 40.0F) : 0.0F;
  place.facing = facing_where_they_touch(normal_a, static_cast<double>(a.area), normal_b, static_cast<double>(b.area),
                                         -place.beyond);
  place.opposition = std::clamp(-normal_a.dot(normal_b), 0.0, 1.0);
  constexpr double closed = 1e-3;
  if (!(place.facing.squaredNorm() > closed * closed)) {
    place.facing = closed * (b_in_a.rotation * b.slab_normal.cast<double>());
  }
  place.thickness = thickness_of(a, b);
  place.flatness = std::min(std::sqrt(normal_a.squaredNorm() * normal_b.squaredNorm()), 1.0);
  return place;
}

}  // namespace odds::query
