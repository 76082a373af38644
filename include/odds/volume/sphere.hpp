// Sphere (Hubbard 1995; Palmer and Grimsdale 1995).
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "odds/math/float_sums.hpp"
#include "odds/math/rounding.hpp"
#include "odds/volume/box_overlap.hpp"
#include "odds/volume/concept.hpp"

namespace odds::volume {

/// 16 bytes. Fitted by Ritter's two passes (1990) over the corners: at most about 5 % larger than the least sphere.
struct Sphere {
  using PreparedPose = RelativePose;

  Vec3f center_ = Vec3f::Zero();
  float radius_ = 0.0F;

  [[nodiscard]] ODDS_KEEPS_ROUNDING static Sphere fit(std::span<const Vec3> points, const PrincipalAxes&) {
    const auto farthest_from = [&](const Vec3& from) {
      return *std::max_element(points.begin(), points.end(), [&](const Vec3& p, const Vec3& q) {
        return (p - from).squaredNorm() < (q - from).squaredNorm();
      });
    };
    const Vec3 one_end = farthest_from(points[0]);
    const Vec3 other_end = farthest_from(one_end);
    Vec3 center = 0.5 * (one_end + other_end);
    double radius = 0.5 * (other_end - one_end).norm();
    for (const Vec3& p : points) {
      const double distance = (p - center).norm();
      if (distance <= radius) continue;
      const double grown = 0.5 * (radius + distance);
      center += (p - center) * ((grown - radius) / distance);
      radius = grown;
    }
    Sphere sphere;
    sphere.center_ = center.cast<float>();
    double enclosing = 0.0;
    for (const Vec3& p : points) enclosing = std::max(enclosing, (p - sphere.center_.cast<double>()).norm());
    sphere.radius_ = rounded_up(enclosing * (1.0 + 0x1p-50));
    return sphere;
  }

  [[nodiscard]] double volume() const noexcept {
    const double r = std::max(static_cast<double>(radius_), 1e-30);
    return 4.0 / 3.0 * std::numbers::pi * r * r * r;
  }
  [[nodiscard]] float radius() const noexcept { return radius_; }
  [[nodiscard]] OrientedBox cell_box() const {
    return {center_.cast<double>(), Mat3::Identity(), Vec3::Constant(static_cast<double>(radius_))};
  }
};

[[nodiscard]] inline bool overlap(const Sphere& a, const Sphere& b, const RelativePose& pose) noexcept {
  const Vec3f offset = math::times(pose.rotation, b.center_) + pose.translation - a.center_;
  const float reach = a.radius_ + b.radius_ + 2.0F * pose.margin;
  return math::squared_length(offset) <= reach * reach * (1.0F + 1e-6F);
}

/// The exact lens of two balls: pi z^2 (d^2 + 2d(R+r) - 3(R-r)^2) / (12 d) with z = R + r - d; a contained ball counts
/// whole.
[[nodiscard]] inline double overlap_volume(const Sphere& a, const Sphere& b, const RelativePose& pose) noexcept {
  const double d =
      static_cast<double>(math::length(math::times(pose.rotation, b.center_) + pose.translation - a.center_));
  const double ra = std::max(static_cast<double>(a.radius_), 1e-30);
  const double rb = std::max(static_cast<double>(b.radius_), 1e-30);
  if (d <= std::abs(ra - rb)) return std::min(a.volume(), b.volume());
  const double z = ra + rb - d;
  if (z <= 0.0) return 0.0;
  const double lens =
      std::numbers::pi * z * z * (d * d + 2.0 * d * (ra + rb) - 3.0 * (ra - rb) * (ra - rb)) / (12.0 * d);
  return std::clamp(lens, 0.0, std::min(a.volume(), b.volume()));
}

[[nodiscard]] inline bool met_by(const Sphere& sphere, const RaySegment& ray) noexcept {
  const Vec3f to_center = sphere.center_ - ray.origin;
  const float along = std::clamp(math::dot(to_center, ray.direction), 0.0F, ray.length);
  const float reach = sphere.radius_ + 2.0F * ray.margin;
  return math::squared_length(to_center - along * ray.direction) <= reach * reach * (1.0F + 1e-6F);
}

static_assert(BoundingVolume<Sphere>);

}  // namespace odds::volume
