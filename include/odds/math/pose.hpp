// A rigid pose: where one frame stands in another.
#pragma once

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
    if (!rotation.allFinite() || !translation.allFinite()) return false;
    const Mat3 deviation = rotation.transpose() * rotation - Mat3::Identity();
    return deviation.cwiseAbs().maxCoeff() <= orthonormality && rotation.determinant() > 0.0;
  }
};

}  // namespace odds::math
