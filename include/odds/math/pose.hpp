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
    // Written out, for every query asks it. What is not a number std::max may lose, but not the triple product.
    const auto x = rotation.col(0);
    const auto y = rotation.col(1);
    const auto z = rotation.col(2);
    const double longest = std::max({std::abs(x.dot(x) - 1.0), std::abs(y.dot(y) - 1.0), std::abs(z.dot(z) - 1.0)});
    const double askew = std::max({std::abs(x.dot(y)), std::abs(y.dot(z)), std::abs(z.dot(x))});
    return longest <= orthonormality && askew <= orthonormality && x.cross(y).dot(z) > 0.0 && translation.allFinite();
  }
};

}  // namespace odds::math
