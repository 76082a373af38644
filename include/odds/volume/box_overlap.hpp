// What axis-aligned and oriented boxes share: the separating axis test and the estimated volume of the overlap.
#pragma once

#include <algorithm>
#include <cmath>

#include "odds/math/float_sums.hpp"
#include "odds/math/types.hpp"
#include "odds/volume/concept.hpp"

namespace odds::volume {

/// Box B seen from box A's own axes: centre offset `t`, rotation `r` (B's axes in A's), `abs_r` = |r| rounded up.
struct BoxPairView {
  Vec3f t;
  Mat3f r;
  Mat3f abs_r;
};

/// The six face axes. True: not separated by any of them.
[[nodiscard]] inline bool faces_overlap(const Vec3f& ha, const Vec3f& hb, const BoxPairView& view,
                                        float margin) noexcept {
  const Vec3f reach_a = ha + math::times(view.abs_r, hb);
  if (((view.t.cwiseAbs() - reach_a).array() > margin).any()) return false;
  const Vec3f t_in_b = math::times(view.r.transpose(), view.t);
  const Vec3f reach_b = hb + math::times(view.abs_r.transpose(), ha);
  return !((t_in_b.cwiseAbs() - reach_b).array() > margin).any();
}

/// The nine edge-edge axes (Gottschalk et al. 1996). True: not separated by any of them.
/// An axis of near-parallel edges has a length near 0 and separates nothing: |t| and the reach shrink with it, and the
/// margin stays.
[[nodiscard]] inline bool edges_overlap(const Vec3f& ha, const Vec3f& hb, const BoxPairView& view,
                                        float margin) noexcept {
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3;
    const int i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3;
      const int j2 = (j + 2) % 3;
      const float distance = std::abs(view.t[i2] * view.r(i1, j) - view.t[i1] * view.r(i2, j));
      const float reach = ha[i1] * view.abs_r(i2, j) + ha[i2] * view.abs_r(i1, j) + hb[j1] * view.abs_r(i, j2) +
                          hb[j2] * view.abs_r(i, j1);
      if (distance - reach > 2.0F * margin) return false;
    }
  }
  return true;
}

/// Product of the extents with flat ones raised to the floor; positive for anything but a point, where it is 1e-90.
[[nodiscard]] inline Vec3f floored(const Vec3f& half_extents) noexcept {
  const float largest = std::max(half_extents.maxCoeff(), 1e-30F);
  return half_extents.cwiseMax(thickness_floor * largest);
}

[[nodiscard]] inline double box_volume(const Vec3f& half_extents) noexcept {
  const Vec3f h = floored(half_extents);
  return 8.0 * static_cast<double>(h[0]) * static_cast<double>(h[1]) * static_cast<double>(h[2]);
}

/// Overlap volume from the separating axis test's own intermediates: in each frame the product of the interval overlaps
/// of one box with the other's enclosure, scaled by the share of that enclosure which the other box fills; the lesser
/// of both.
[[nodiscard]] inline double box_overlap_volume(const Vec3f& half_a, const Vec3f& half_b,
                                               const BoxPairView& view) noexcept {
  const Vec3f ha = floored(half_a);
  const Vec3f hb = floored(half_b);
  const Vec3f eb = math::times(view.abs_r, hb);
  const Vec3f ea = math::times(view.abs_r.transpose(), ha);
  const Vec3f t_in_b = math::times(view.r.transpose(), view.t);
  double product_a = 1.0;
  double product_b = 1.0;
  double enclosure_a = 1.0;
  double enclosure_b = 1.0;
  double volume_a = 1.0;  // an eighth of each
  double volume_b = 1.0;
  for (int i = 0; i < 3; ++i) {
    const float overlap_a = std::min(ha[i], view.t[i] + eb[i]) - std::max(-ha[i], view.t[i] - eb[i]);
    const float overlap_b = std::min(hb[i], t_in_b[i] + ea[i]) - std::max(-hb[i], t_in_b[i] - ea[i]);
    product_a *= static_cast<double>(std::max(overlap_a, 0.0F));
    product_b *= static_cast<double>(std::max(overlap_b, 0.0F));
    enclosure_a *= static_cast<double>(ea[i]);
    enclosure_b *= static_cast<double>(eb[i]);
    volume_a *= static_cast<double>(ha[i]);
    volume_b *= static_cast<double>(hb[i]);
  }
  return std::min(
      {product_a * (volume_b / enclosure_b), product_b * (volume_a / enclosure_a), 8.0 * volume_a, 8.0 * volume_b});
}

/// Part [enter, leave] of a segment that may lie within |x| <= half of one slab, with `origin` and `direction` along
/// the slab's normal. False: none does. A direction within the slab is judged by where the segment stands.
[[nodiscard]] inline bool clip_to_slab(float half, float origin, float direction, float length, float& enter,
                                       float& leave) noexcept {
  if (std::abs(direction) < 1e-6F) {  // moves less than the margin over any length that the margin was made for
    return std::abs(origin) <= half + std::abs(direction) * length;
  }
  const float inverse = 1.0F / direction;
  const float t0 = (-half - origin) * inverse;
  const float t1 = (half - origin) * inverse;
  enter = std::max(enter, std::min(t0, t1));
  leave = std::min(leave, std::max(t0, t1));
  return true;
}

/// Whether something is left of a segment that was clipped: each end is wrong by a few roundings of its own size.
[[nodiscard]] inline bool anything_left(float enter, float leave) noexcept {
  return enter <= leave + 4e-7F * (std::abs(enter) + std::abs(leave));
}

/// A segment given in the box's own axes, from its centre.
[[nodiscard]] inline bool segment_meets_box(const Vec3f& half_extents, const Vec3f& origin, const Vec3f& direction,
                                            const RaySegment& ray) noexcept {
  float enter = 0.0F;
  float leave = ray.length;
  for (int i = 0; i < 3; ++i) {
    if (!clip_to_slab(half_extents[i] + ray.margin, origin[i], direction[i], ray.length, enter, leave)) return false;
  }
  return anything_left(enter, leave);
}

/// Half extents in float that enclose double points about a float centre: rounded outwards.
[[nodiscard]] inline float rounded_up(double value) noexcept {
  const auto narrow = static_cast<float>(value);
  return static_cast<double>(narrow) < value ? std::nextafter(narrow, INFINITY) : narrow;
}

}  // namespace odds::volume
