// What the statistics of two nodes say about the surfaces below them: how probably they meet.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "odds/math/elementary.hpp"
#include "odds/math/float_sums.hpp"
#include "odds/probability/balls_into_bins.hpp"
#include "odds/probability/kinematic.hpp"
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
  const Vec3f normal_b = math::times(met.rotation, b.slab_normal);
  const Vec3f centroid_b = math::times(met.rotation, b.centroid) + placed.b_in_a;
  const float cosine = std::min(std::abs(math::dot(a.slab_normal, normal_b)), 1.0F);
  constexpr float usual_reach = 0.5F;  // of the radius: a surface rarely fills the ball about it
  const float sine = usual_reach * std::sqrt(1.0F - cosine * cosine);
  const float away_a = std::abs(math::dot(a.slab_normal, centroid_b) - a.slab_center);
  const float away_b = std::abs(math::dot(normal_b, a.centroid - placed.b_in_a) - b.slab_center);
  const float thick_a = a.slab_half + b.slab_half * cosine + placed.radius_b * sine;
  const float thick_b = b.slab_half + a.slab_half * cosine + placed.radius_a * sine;
  const bool first = away_a * thick_b > away_b * thick_a;
  const float depth = 1.0F - (first ? away_a : away_b) / std::max(first ? thick_a : thick_b, 1e-37F);
  const float apart = math::length(centroid_b - a.centroid) / std::max(placed.radius_a + placed.radius_b, 1e-37F);
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
    const float facing = std::clamp(math::dot(a.mean_normal, math::times(met.rotation, b.mean_normal)), 0.0F, 1.0F);
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

}  // namespace odds::query
