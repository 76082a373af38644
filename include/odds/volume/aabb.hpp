// Axis-aligned box, aligned with its hierarchy's frame (Zachmann 1997, van den Bergen 1997, Larsson and Akenine-Moeller
// 2001).
#pragma once

#include "odds/math/float_sums.hpp"
#include "odds/math/rounding.hpp"
#include "odds/volume/box_overlap.hpp"
#include "odds/volume/concept.hpp"

namespace odds::volume {

/// 24 bytes. Overlap by the six face axes: the nine edge axes cost more than they exclude (measured on near-contact
/// poses).
struct Aabb {
  using PreparedPose = RelativePose;

  Vec3f center_ = Vec3f::Zero();
  Vec3f half_ = Vec3f::Zero();

  [[nodiscard]] ODDS_KEEPS_ROUNDING static Aabb fit(std::span<const Vec3> points, const PrincipalAxes&) {
    Vec3 lower = points[0];
    Vec3 upper = points[0];
    for (const Vec3& p : points) {
      lower = lower.cwiseMin(p);
      upper = upper.cwiseMax(p);
    }
    Aabb box;
    box.center_ = (0.5 * (lower + upper)).cast<float>();
    const Vec3 center = box.center_.cast<double>();
    const Vec3 half = (upper - center).cwiseMax(center - lower);
    for (int i = 0; i < 3; ++i) box.half_[i] = rounded_up(half[i]);
    return box;
  }

  [[nodiscard]] double volume() const noexcept { return box_volume(half_); }
  [[nodiscard]] float radius() const noexcept { return math::length(half_); }
  [[nodiscard]] OrientedBox cell_box() const {
    return {center_.cast<double>(), Mat3::Identity(), half_.cast<double>()};
  }
};

[[nodiscard]] inline BoxPairView view_of(const Aabb& a, const Aabb& b, const RelativePose& pose) noexcept {
  return {math::times(pose.rotation, b.center_) + pose.translation - a.center_, pose.rotation, pose.abs_rotation};
}

[[nodiscard]] inline bool overlap(const Aabb& a, const Aabb& b, const RelativePose& pose) noexcept {
  return faces_overlap(a.half_, b.half_, view_of(a, b, pose), pose.margin);
}

[[nodiscard]] inline double overlap_volume(const Aabb& a, const Aabb& b, const RelativePose& pose) noexcept {
  return box_overlap_volume(a.half_, b.half_, view_of(a, b, pose));
}

[[nodiscard]] inline bool met_by(const Aabb& box, const RaySegment& ray) noexcept {
  return segment_meets_box(box.half_, ray.origin - box.center_, ray.direction, ray);
}

static_assert(BoundingVolume<Aabb>);

}  // namespace odds::volume
