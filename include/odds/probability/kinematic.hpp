// The estimator `kinematic`: how probably two random surface patches in a common volume meet, by integral geometry.
#pragma once

#include <cmath>

#include "odds/math/types.hpp"
#include "odds/tree/node_statistics.hpp"

namespace odds::probability {

/// sigma^2 = E|n_A x n_B|^2 = 1 - tr(M_A R M_B R^T): 0 for parallel sheets, 2/3 for isotropic ones. `rotation` maps B
/// to A.
[[nodiscard]] inline double mean_square_sine(const tree::NodeStatistics& a, const tree::NodeStatistics& b,
                                             const Mat3f& rotation) noexcept {
  const float* mb = b.normal_moment;
  Mat3f moment_b;
  moment_b << mb[0], mb[3], mb[4], mb[3], mb[1], mb[5], mb[4], mb[5], mb[2];
  const Mat3f turned = rotation * moment_b;
  const float* ma = a.normal_moment;
  const auto entry = [&](int i, int j) { return turned.row(i).dot(rotation.row(j)); };
  const float trace = ma[0] * entry(0, 0) + ma[1] * entry(1, 1) + ma[2] * entry(2, 2) +
                      2.0F * (ma[3] * entry(0, 1) + ma[4] * entry(0, 2) + ma[5] * entry(1, 2));
  return std::fmin(std::fmax(1.0 - static_cast<double>(trace), 0.0), 1.0);
}

/// Kinematic formula (Santalo): patches of area densities rho_A, rho_B (area / bounding volume) in a common volume V
/// meet in a curve of expected length rho_A rho_B V E|sin|. Per length scale V^(1/3) that is lambda = rho_A rho_B sigma
/// V^(2/3), and P = 1 - exp(-lambda). Nothing is fitted. In [0, 1], smooth in the pose, never NaN for volumes > 0.
/// Volumes in m^3.
[[nodiscard]] inline double kinematic(const tree::NodeStatistics& a, const tree::NodeStatistics& b,
                                      const Mat3f& rotation, double volume_a, double volume_b,
                                      double overlap_volume) noexcept {
  if (!(overlap_volume > 0.0)) return 0.0;
  // Perfectly parallel sheets still meet when one bends by the mesh's own roughness: sigma never counts as less than 1
  // %.
  const double sigma = std::sqrt(mean_square_sine(a, b, rotation) + 1e-4);
  const double edge = std::cbrt(overlap_volume);
  const double lambda =
      (static_cast<double>(a.area) / volume_a * edge) * (static_cast<double>(b.area) / volume_b * edge) * sigma;
  return -std::expm1(-lambda);
}

}  // namespace odds::probability
