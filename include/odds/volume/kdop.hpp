// k-DOP: slabs along fixed directions (Klosowski et al. 1998), compared in any relative pose without enclosing them
// anew (after Zachmann 1998).
#pragma once

#include <array>
#include <cmath>

#include "odds/math/float_sums.hpp"
#include "odds/math/rounding.hpp"
#include "odds/volume/box_overlap.hpp"
#include "odds/volume/concept.hpp"
#include "odds/volume/slab_directions.hpp"

namespace odds::volume {

/// Once per query: each slab normal of one hierarchy as a blend of the other's (SlabBlend). About 0.3 us for k = 26.
template <int K>
struct KdopPose : RelativePose {
  std::array<SlabBlend, K / 2> b_in_a;  ///< reach of B along A's normals
  std::array<SlabBlend, K / 2> a_in_b;  ///< reach of A along B's normals

  [[nodiscard]] static KdopPose make(const math::Pose& pose_b_in_a, double reach) noexcept {
    KdopPose pose;
    static_cast<RelativePose&>(pose) = RelativePose::make(pose_b_in_a, reach);
    constexpr auto normals = slab_normals<K>();
    for (std::size_t i = 0; i < normals.size(); ++i) {
      const Vec3 normal(normals[i][0], normals[i][1], normals[i][2]);
      pose.b_in_a[i] = blend_of<K>(pose_b_in_a.rotation.transpose() * normal, normal.dot(pose_b_in_a.translation));
      const Vec3 turned = pose_b_in_a.rotation * normal;
      pose.a_in_b[i] = blend_of<K>(turned, -turned.dot(pose_b_in_a.translation));
    }
    return pose;
  }
};

/// 60, 76 and 108 bytes for k = 14, 18, 26. A slab is {|normal . x - center_| <= half_}; its normals are not of unit
/// length, so neither are these. The first three slabs are the axis-aligned box.
template <int K>
struct Kdop {
  using PreparedPose = KdopPose<K>;
  static constexpr std::size_t slabs = K / 2;
  static constexpr std::array<SlabNormal, slabs> normals = slab_normals<K>();

  std::array<float, slabs> center_{};
  std::array<float, slabs> half_{};
  float fill_ = 1.0F;  ///< share of the box that lies in all slabs, measured by `measured_fill`

  [[nodiscard]] ODDS_KEEPS_ROUNDING static Kdop fit(std::span<const Vec3> points, const PrincipalAxes&) {
    Kdop dop;
    for (std::size_t i = 0; i < slabs; ++i) {
      double lower = INFINITY;
      double upper = -INFINITY;
      for (const Vec3& p : points) {
        const double offset = along(i, p);
        lower = std::min(lower, offset);
        upper = std::max(upper, offset);
      }
      dop.center_[i] = static_cast<float>(0.5 * (lower + upper));
      const auto center = static_cast<double>(dop.center_[i]);
      // `along` rounds twice.
      const double rounding = 0x1p-51 * (std::abs(lower) + std::abs(upper));
      dop.half_[i] = rounded_up(std::max(upper - center, center - lower) + rounding);
    }
    dop.fill_ = dop.measured_fill();
    return dop;
  }

  template <class Vector>
  [[nodiscard]] static auto along(std::size_t slab, const Vector& p) noexcept {
    using Scalar = typename Vector::Scalar;
    return static_cast<Scalar>(normals[slab][0]) * p[0] + static_cast<Scalar>(normals[slab][1]) * p[1] +
           static_cast<Scalar>(normals[slab][2]) * p[2];
  }

  [[nodiscard]] Vec3f box_center() const noexcept { return {center_[0], center_[1], center_[2]}; }
  [[nodiscard]] Vec3f box_half() const noexcept { return {half_[0], half_[1], half_[2]}; }

  [[nodiscard]] double volume() const noexcept { return box_volume(box_half()) * static_cast<double>(fill_); }
  [[nodiscard]] float radius() const noexcept { return math::length(box_half()); }
  [[nodiscard]] OrientedBox cell_box() const {
    const Vec3f center = box_center();
    const Vec3f half = box_half();
    return {center.cast<double>(), Mat3::Identity(), half.cast<double>()};
  }

 private:
  /// Share of the centres of the box's 8^3 cells that lie in all slabs; at least `thickness_floor`, as for flat boxes.
  [[nodiscard]] float measured_fill() const noexcept {
    const Vec3f half = box_half();
    // Where the box's centre stands in the other slabs; differences of like numbers, so small errors are let pass.
    std::array<float, slabs> middle{};
    for (std::size_t i = 3; i < slabs; ++i) middle[i] = along(i, box_center()) - center_[i];
    const float slack = 1e-6F * (math::dot(Vec3f::Ones(), half) + math::dot(Vec3f::Ones(), box_center().cwiseAbs()));
    int inside = 0;
    for (int cell = 0; cell < 512; ++cell) {
      const Vec3f offset =
          half.cwiseProduct(Vec3f(static_cast<float>(2 * (cell % 8) - 7), static_cast<float>(2 * (cell / 8 % 8) - 7),
                                  static_cast<float>(2 * (cell / 64) - 7)) /
                            8.0F);
      bool in_all = true;
      for (std::size_t i = 3; i < slabs && in_all; ++i) {
        in_all = std::abs(middle[i] + along(i, offset)) <= half_[i] + slack;
      }
      inside += in_all ? 1 : 0;
    }
    return std::max(static_cast<float>(inside) / 512.0F, thickness_floor);
  }
};

/// Whether slab `i` of `one` keeps the volume `other` off, whose reach along its normal `blend` bounds.
template <int K>
[[nodiscard]] inline bool slab_separates(const Kdop<K>& one, std::size_t i, const Kdop<K>& other,
                                         const SlabBlend& blend, float margin) noexcept {
  float center = blend.shift;
  float reach = one.half_[i];
  for (std::size_t k = 0; k < 3; ++k) {
    center += blend.weight[k] * other.center_[blend.slab[k]];
    reach += std::abs(blend.weight[k]) * other.half_[blend.slab[k]];
  }
  return std::abs(one.center_[i] - center) - reach > margin;
}

/// By the normals of both, k in all. Along normals of length up to sqrt(3), with sums of up to 4 terms in which the
/// weighted normals are at most 1.3 times as long as their sum, the errors stay below twice the margin of unit normals.
template <int K>
[[nodiscard]] inline bool overlap(const Kdop<K>& a, const Kdop<K>& b, const KdopPose<K>& pose) noexcept {
  const float margin = 2.0F * pose.margin;
  for (std::size_t i = 0; i < K / 2; ++i) {
    if (slab_separates(a, i, b, pose.b_in_a[i], margin)) return false;
    if (slab_separates(b, i, a, pose.a_in_b[i], margin)) return false;
  }
  return true;
}

/// That of the enclosing boxes, times the lesser of both shares of their boxes that the volumes fill.
template <int K>
[[nodiscard]] inline double overlap_volume(const Kdop<K>& a, const Kdop<K>& b, const KdopPose<K>& pose) noexcept {
  const BoxPairView view = {math::times(pose.rotation, b.box_center()) + pose.translation - a.box_center(),
                            pose.rotation, pose.abs_rotation};
  return box_overlap_volume(a.box_half(), b.box_half(), view) * static_cast<double>(std::min(a.fill_, b.fill_));
}

template <int K>
[[nodiscard]] inline bool met_by(const Kdop<K>& dop, const RaySegment& ray) noexcept {
  float enter = 0.0F;
  float leave = ray.length;
  for (std::size_t i = 0; i < K / 2; ++i) {
    if (!clip_to_slab(dop.half_[i] + 2.0F * ray.margin, Kdop<K>::along(i, ray.origin) - dop.center_[i],
                      Kdop<K>::along(i, ray.direction), ray.length, enter, leave)) {
      return false;
    }
  }
  return anything_left(enter, leave);
}

using Kdop14 = Kdop<14>;
using Kdop18 = Kdop<18>;
using Kdop26 = Kdop<26>;
static_assert(BoundingVolume<Kdop14>);
static_assert(BoundingVolume<Kdop18>);
static_assert(BoundingVolume<Kdop26>);

}  // namespace odds::volume
