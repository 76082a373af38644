// Oriented box, aligned with the principal axes of the surface in it (Gottschalk, Lin and Manocha 1996).
#pragma once

#include "odds/math/float_sums.hpp"
#include "odds/math/rounding.hpp"
#include "odds/volume/box_overlap.hpp"
#include "odds/volume/concept.hpp"

namespace odds::volume {

/// 60 bytes. Overlap by all 15 axes. The axes are kept in float; extents are measured along those rounded axes, so the
/// box encloses its points although the axes are orthonormal only to 1e-7: that error is in the margin of RelativePose.
struct Obb {
  using PreparedPose = RelativePose;

  Vec3f center_ = Vec3f::Zero();
  Mat3f axes_ = Mat3f::Identity();
  Vec3f half_ = Vec3f::Zero();

  [[nodiscard]] ODDS_KEEPS_ROUNDING static Obb fit(std::span<const Vec3> points, const PrincipalAxes& axes) {
    Obb box;
    box.axes_ = axes.cast<float>();
    const Mat3 rounded_axes = box.axes_.cast<double>();
    Vec3 lower = Vec3::Constant(INFINITY);
    Vec3 upper = Vec3::Constant(-INFINITY);
    for (const Vec3& p : points) {
      const Vec3 q = rounded_axes.transpose() * p;
      lower = lower.cwiseMin(q);
      upper = upper.cwiseMax(q);
    }
    box.center_ = (rounded_axes * (0.5 * (lower + upper))).cast<float>();
    const Vec3 center = rounded_axes.transpose() * box.center_.cast<double>();
    const Vec3 half = (upper - center).cwiseMax(center - lower);
    for (int i = 0; i < 3; ++i) box.half_[i] = rounded_up(half[i]);
    return box;
  }

  [[nodiscard]] double volume() const noexcept { return box_volume(half_); }
  [[nodiscard]] float radius() const noexcept { return math::length(half_); }
  [[nodiscard]] OrientedBox cell_box() const {
    return {center_.cast<double>(), axes_.cast<double>(), half_.cast<double>()};
  }
};

[[nodiscard]] inline BoxPairView view_of(const Obb& a, const Obb& b, const RelativePose& pose) noexcept {
  BoxPairView view;
  view.t =
      math::times(a.axes_.transpose(), Vec3f(math::times(pose.rotation, b.center_) + pose.translation - a.center_));
  view.r = math::times(a.axes_.transpose(), math::times(pose.rotation, b.axes_));
  view.abs_r = view.r.cwiseAbs().array() + 1e-6F;
  return view;
}

[[nodiscard]] inline bool overlap(const Obb& a, const Obb& b, const RelativePose& pose) noexcept {
  const BoxPairView view = view_of(a, b, pose);
  return faces_overlap(a.half_, b.half_, view, pose.margin) && edges_overlap(a.half_, b.half_, view, pose.margin);
}

[[nodiscard]] inline double overlap_volume(const Obb& a, const Obb& b, const RelativePose& pose) noexcept {
  return box_overlap_volume(a.half_, b.half_, view_of(a, b, pose));
}

[[nodiscard]] inline bool met_by(const Obb& box, const RaySegment& ray) noexcept {
  return segment_meets_box(box.half_, math::times(box.axes_.transpose(), Vec3f(ray.origin - box.center_)),
                           math::times(box.axes_.transpose(), ray.direction), ray);
}

static_assert(BoundingVolume<Obb>);

}  // namespace odds::volume
