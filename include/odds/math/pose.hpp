// A rigid pose: where one frame stands in another.
#pragma once

#include <algorithm>
#include <cmath>

#include "odds/math/types.hpp"

namespace odds::math {

/// Rigid motion x_a = rotation * x_b + translation. A variable `pose_b_in_a` maps points of frame B to frame A.
/// Lengths in metres. Plain value; thread-safe to read.
struct Pose {
  Mat3 rotation = Mat3::Identity();  ///< orthonormal, determinant +1
  Vec3 translation = Vec3::Zero();   ///< metres

  [[nodiscard]] static Pose from_quaternion(const Vec3& translation, const Quat& rotation) {
    return {rotation.normalized().toRotationMatrix(), translation};
  }

  [[nodiscard]] Vec3 operator*(const Vec3& point) const { return rotation * point + translation; }
  [[nodiscard]] Pose operator*(const Pose& other) const {
    return {rotation * other.rotation, rotation * other.translation + translation};
  }
  [[nodiscard]] Pose inverse() const { return {rotation.transpose(), -(rotation.transpose() * translation)}; }

  /// True if every number is finite and the rotation is orthonormal to `orthonormality` (largest entry of R^T R - I).
  [[nodiscard]] bool is_rigid(double orthonormality) const {
    // Written out, with three comparisons, for every query asks it: half the time of Eigen's products and maxima. What
    // is not a number std::max may lose, but not the triple product; and only of finite numbers the multiple by 0 is 0.
    const double* const x = rotation.data();
    const double* const y = x + 3;
    const double* const z = x + 6;
    const auto dot = [](const double* u, const double* v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; };
    const double longest =
        std::max(std::max(std::abs(dot(x, x) - 1.0), std::abs(dot(y, y) - 1.0)), std::abs(dot(z, z) - 1.0));
    const double askew = std::max(std::max(std::abs(dot(x, y)), std::abs(dot(y, z))), std::abs(dot(z, x)));
    const double volume =
        (x[1] * y[2] - x[2] * y[1]) * z[0] + (x[2] * y[0] - x[0] * y[2]) * z[1] + (x[0] * y[1] - x[1] * y[0]) * z[2];
    const double* const t = translation.data();
    return std::max(longest, askew) <= orthonormality && volume > 0.0 && 0.0 * t[0] + 0.0 * t[1] + 0.0 * t[2] == 0.0;
  }
};

}  // namespace odds::math
