// The estimator `kinematic`: how probably two random surface patches in a common volume meet, by integral geometry.
#pragma once

#include <algorithm>
#include <cmath>

#include "odds/math/elementary.hpp"
#include "odds/math/types.hpp"
#include "odds/tree/node_statistics.hpp"

namespace odds::probability {

/// sigma^2 = E|n_A x n_B|^2 = 1 - tr(M_A R M_B R^T): 0 for parallel sheets, 2/3 for isotropic ones. `rotation` maps B
/// to A. In [0, 1].
[[nodiscard]] inline float mean_square_sine(const tree::NodeStatistics& a, const tree::NodeStatistics& b,
                                            const Mat3f& rotation) noexcept {
  const float* mb = b.normal_moment;
  const float* ma = a.normal_moment;
  Mat3f turned;  // R M_B
  for (int i = 0; i < 3; ++i) {
    const float x = rotation(i, 0);
    const float y = rotation(i, 1);
    const float z = rotation(i, 2);
    turned(i, 0) = x * mb[0] + y * mb[3] + z * mb[4];
    turned(i, 1) = x * mb[3] + y * mb[1] + z * mb[5];
    turned(i, 2) = x * mb[4] + y * mb[5] + z * mb[2];
  }
  const auto entry = [&](int i, int j) {
    return turned(i, 0) * rotation(j, 0) + turned(i, 1) * rotation(j, 1) + turned(i, 2) * rotation(j, 2);
  };
  const float trace = ma[0] * entry(0, 0) + ma[1] * entry(1, 1) + ma[2] * entry(2, 2) +
                      2.0F * (ma[3] * entry(0, 1) + ma[4] * entry(0, 2) + ma[5] * entry(1, 2));
  return std::min(std::max(1.0F - trace, 0.0F), 1.0F);
}

/// Kinematic formula (Santalo): patches of area densities rho_A, rho_B (area / bounding volume) in a common volume V
/// meet in a curve of expected length rho_A rho_B V E|sin|. Per length scale V^(1/3) that is lambda = rho_A rho_B sigma
/// V^(2/3), and P = 1 - exp(-lambda). Nothing is fitted. In [0, 1], continuous in the pose, never NaN; 0 without a
/// common volume. Volumes in m^3 and > 0; only their ratios to the areas' 3/2 power matter, so any size of mesh will
/// do.
[[nodiscard]] inline float kinematic(const tree::NodeStatistics& a, const tree::NodeStatistics& b,
                                     const Mat3f& rotation, double volume_a, double volume_b,
                                     double overlap_volume) noexcept {
  if (!(overlap_volume > 0.0)) return 0.0F;
  // rho_A rho_B V^(2/3) in numbers near 1, whatever the mesh's unit: with areas relative to the volumes' faces,
  // (area_A / volume_A^(2/3)) (area_B / volume_B^(2/3)) cbrt(V / volume_A * V / volume_B).
  const auto shares = static_cast<float>((overlap_volume / volume_a) * (overlap_volume / volume_b));
  const float rate = a.relative_area * b.relative_area * math::cube_root(std::max(shares, 1e-36F));
  // Perfectly parallel sheets still meet when one bends by the mesh's own roughness: sigma never counts as less than 1
  // %.
  const float sigma = std::sqrt(mean_square_sine(a, b, rotation) + 1e-4F);
  return math::probability_of_rate(rate * sigma);
}

/// log2 of lambda of `kinematic`, to about 0.02: without a root, an exponential or a division. What orders a search: P
/// grows with lambda. Very negative where P is 0.
[[nodiscard]] inline float log_kinematic_rate(const tree::NodeStatistics& a, const tree::NodeStatistics& b,
                                              const Mat3f& rotation, double overlap_volume) noexcept {
  const float log_shares = 2.0F * math::rough_log2(overlap_volume) - a.log_volume - b.log_volume;
  const float log_sine = 0.5F * math::rough_log2(static_cast<double>(mean_square_sine(a, b, rotation) + 1e-4F));
  return a.log_relative_area + b.log_relative_area + log_shares * (1.0F / 3.0F) + log_sine;
}

}  // namespace odds::probability
