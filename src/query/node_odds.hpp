// What the statistics of two nodes say about the surfaces below them: how probably they meet, and where.
#pragma once

#include <algorithm>
#include <cmath>

#include "odds/math/pose.hpp"
#include "odds/probability/balls_into_bins.hpp"
#include "odds/probability/kinematic.hpp"
#include "odds/query/answer.hpp"
#include "odds/query/request.hpp"

namespace odds::query {

/// The searches whose undecided pairs are alike: how `rank` is meant differs between them.
enum class Engine : std::uint8_t {
  binary,  ///< rank: log2 of the expected number of crossings
  wide,    ///< rank: log2 of the depth of overlap over the thickness of both surfaces
};

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

/// Where, in which direction and how deep the surfaces of the nodes most probably meet, in A's mesh frame. `b_in_a` and
/// `origin_a` of the trees' frames; radii of the bounding volumes; `probability` of a meeting.
[[nodiscard]] inline Contact met_contact(const tree::NodeStatistics& a, const tree::NodeStatistics& b, float radius_a,
                                         float radius_b, const math::Pose& b_in_a, const Vec3& origin_a,
                                         double probability) noexcept {
  const Vec3 centroid_a = a.centroid.cast<double>();
  const Vec3 centroid_b = b_in_a * b.centroid.cast<double>();
  // The smaller node says more about where: weight by the inverse of the size (radii of 1e19 m are infinite).
  const double size = static_cast<double>(radius_a) + static_cast<double>(radius_b);
  const double weight_a = size > 0.0 && std::isfinite(size) ? static_cast<double>(radius_b) / size : 0.5;
  Contact contact;
  contact.position = weight_a * centroid_a + (1.0 - weight_a) * centroid_b + origin_a;
  Vec3 direction = b_in_a.rotation * b.mean_normal.cast<double>() - a.mean_normal.cast<double>();
  if (!(direction.norm() > 1e-3)) direction = b_in_a.rotation * b.slab_normal.cast<double>();  // closed on all sides
  const double length = direction.norm();
  contact.normal = length > 0.0 && std::isfinite(length) ? Vec3(direction / length) : Vec3::UnitZ();
  // A's surface lies beyond B's by this much. Two patches that nobody has looked into cannot be told to overlap deeper
  // than the thinner of them is thick. They may not meet at all, and a patch that faces all ways has no side to be
  // beyond: so it is the expected depth that counts, weighted by how flat both patches are (a whole closed body: not at
  // all).
  const double passed = contact.normal.dot(centroid_b - centroid_a);
  const double thickness = 2.0 * static_cast<double>(std::min(a.slab_half, b.slab_half));
  const double flatness = static_cast<double>(std::min(a.mean_normal.norm() * b.mean_normal.norm(), 1.0F));
  contact.depth = probability * flatness * std::clamp(passed, 0.0, thickness);
  return contact;
}

}  // namespace odds::query
