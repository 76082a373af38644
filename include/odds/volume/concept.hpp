// What a bounding volume must offer to be built into hierarchies and searched. A new volume is one header that models
// this concept and one word in volume/kind.hpp.
#pragma once

#include <concepts>
#include <span>

#include "odds/math/types.hpp"
#include "odds/volume/relative_pose.hpp"

namespace odds::volume {

/// A box in a hierarchy's frame: {center + axes * x, |x_i| <= half_extents_i}. Metres.
struct OrientedBox {
  Vec3 center = Vec3::Zero();
  Mat3 axes = Mat3::Identity();  ///< orthonormal columns
  Vec3 half_extents = Vec3::Zero();
};

/// A piece of a line in a hierarchy's frame: origin + t * direction for t in [0, length].
struct RaySegment {
  Vec3f origin;
  Vec3f direction;      ///< unit
  float length = 0.0F;  ///< metres
  float margin = 0.0F;  ///< metres; covers the rounding of the segment and of the tests

  [[nodiscard]] static RaySegment make(const Vec3& origin, const Vec3& direction, double length,
                                       double reach) noexcept {
    const double scale = origin.norm() + length + reach;
    return {origin.cast<float>(), direction.cast<float>(), static_cast<float>(length * (1.0 + 1e-6)),
            std::max(static_cast<float>(scale * 16.0 * 0x1p-24), least_margin)};
  }
};

/// Surface moments that a fit may use: principal axes of the area-weighted covariance, thinnest first (columns).
using PrincipalAxes = Mat3;

/// What a volume prepares once per query: a RelativePose, or a type derived from it that holds more (tables of turned
/// directions, say). Made by `make(b_in_a, reach)`; no allocation.
template <class P>
concept PoseForVolumes = std::derived_from<P, RelativePose> && requires(const math::Pose& b_in_a, double reach) {
  { P::make(b_in_a, reach) }
  noexcept->std::same_as<P>;
};

/// `overlap` and `met_by` may say true wrongly, never false (points exactly shared count as overlap). `volume` and
/// `overlap_volume` are estimates for probabilities: positive and finite for every volume, flat ones included (a flat
/// extent counts as `thickness_floor` of the largest), overlap_volume <= both volumes. All lengths in metres, frames of
/// hierarchy A for A and `pose` mapping B to A.
template <class V>
concept BoundingVolume = PoseForVolumes<typename V::PreparedPose> &&
    requires(const V& a, const V& b, const typename V::PreparedPose& pose, std::span<const Vec3> points,
             const PrincipalAxes& axes, const RaySegment& ray) {
  { V::fit(points, axes) } -> std::same_as<V>;
  { overlap(a, b, pose) }
  noexcept->std::same_as<bool>;
  { overlap_volume(a, b, pose) }
  noexcept->std::same_as<double>;
  { met_by(a, ray) }
  noexcept->std::same_as<bool>;
  { a.volume() }
  noexcept->std::same_as<double>;
  { a.radius() }
  noexcept->std::same_as<float>;  // of some enclosing ball about its centre: decides which side to split
  { a.cell_box() } -> std::same_as<OrientedBox>;  // the box whose 8^3 cells are counted
};

/// Flat volumes would have infinite area density: an extent counts at least as this share of the largest one.
inline constexpr float thickness_floor = 0.02F;

}  // namespace odds::volume
