// The relative pose of two hierarchies, prepared once per query for all volume tests.
#pragma once

#include <algorithm>
#include <limits>

#include "odds/math/pose.hpp"
#include "odds/math/types.hpp"

namespace odds::volume {

/// Metres: 40 roundings of what is less than the least normal number.
inline constexpr float least_margin = 40.0F * std::numeric_limits<float>::min();

/// Hierarchy frame B in hierarchy frame A, in single precision, with a margin that covers all rounding of the tests: a
/// test that adds `margin` to one extent never calls two touching volumes apart. Lengths in metres.
struct RelativePose {
  Mat3f rotation;       ///< B to A
  Mat3f abs_rotation;   ///< |rotation|, rounded up
  Vec3f translation;    ///< origin of B in A
  float margin = 0.0F;  ///< absolute error bound of a projected centre or extent

  /// `reach` >= every coordinate of both hierarchies and of the translation, in magnitude.
  /// The margin counts 16 roundings of 2^-24 relative to `reach`: a rotated point takes 3 products and 3 sums of terms
  /// that are each at most `reach`, the narrowed rotation and translation one rounding each, an extent 3 products and 5
  /// sums. Below 1e-29 m underflow is what rounds, and the floor covers it.
  [[nodiscard]] static RelativePose make(const math::Pose& b_in_a, double reach) noexcept {
    RelativePose pose;
    pose.rotation = b_in_a.rotation.cast<float>();
    pose.translation = b_in_a.translation.cast<float>();
    pose.abs_rotation = pose.rotation.cwiseAbs().array() + more_than_rounding;
    pose.margin = margin_of(reach);
    return pose;
  }
  [[nodiscard]] static float margin_of(double reach) noexcept {
    return std::max(static_cast<float>(reach * 16.0 * 0x1p-24), least_margin);
  }
  static constexpr float more_than_rounding = 2.4e-7F;  ///< of a rotation's entry
};

}  // namespace odds::volume
