// Convex hull of the corners, of limited size: the tightest convex volume. Its pairs are judged by libccd's GJK
// (Gilbert, Johnson and Keerthi 1988) and believed only with a proof.
#pragma once

#include <array>
#include <cstdint>

#include "odds/math/rounding.hpp"
#include "odds/volume/box_overlap.hpp"
#include "odds/volume/concept.hpp"
#include "odds/volume/obb.hpp"

namespace odds::volume {

/// The set of points within `inflation_` of the convex hull of at most 32 of the points; 456 bytes, mostly the
/// vertices. First come the extremes along 26 directions, then always the point farthest from the hull so far, until
/// all lie within 1/256 of the box's radius or there is no room. What then still sticks out is the inflation: exact
/// hulls of small nodes have next to none, that of a round body of thousands of triangles some per cent of its radius.
/// Thread-safe as a value. Its functions that are not inline do not allocate, except `fit` for more than 64 points.
struct Hull {
  using PreparedPose = RelativePose;
  static constexpr std::size_t most_vertices = 32;

  Obb box_;
  float inflation_ = 0.0F;  ///< metres
  float fill_ = 1.0F;       ///< share of the box, measured by the slabs of a 26-DOP along the box's axes
  std::uint32_t count_ = 1;
  std::array<float, most_vertices> x_{};
  std::array<float, most_vertices> y_{};
  std::array<float, most_vertices> z_{};

  [[nodiscard]] ODDS_KEEPS_ROUNDING static Hull fit(std::span<const Vec3> points, const PrincipalAxes& axes);

  [[nodiscard]] Vec3 vertex(std::size_t i) const noexcept {
    return {static_cast<double>(x_[i]), static_cast<double>(y_[i]), static_cast<double>(z_[i])};
  }
  [[nodiscard]] double volume() const noexcept { return box_.volume() * static_cast<double>(fill_); }
  [[nodiscard]] float radius() const noexcept { return box_.radius(); }
  [[nodiscard]] OrientedBox cell_box() const { return box_.cell_box(); }
};

/// Boxes first. Then GJK looks for a direction that separates the inflated hulls, in at most 24 steps; false only if
/// the extreme vertices of both along a direction that it tried lie apart by more than both inflations and the margin:
/// what libccd itself concludes, by tolerances of its own, decides nothing. Some 0.1 to 3 us.
[[nodiscard]] bool overlap(const Hull& a, const Hull& b, const RelativePose& pose) noexcept;

/// That of the boxes, times the lesser of both shares of their boxes that the hulls fill.
[[nodiscard]] inline double overlap_volume(const Hull& a, const Hull& b, const RelativePose& pose) noexcept {
  return overlap_volume(a.box_, b.box_, pose) * static_cast<double>(std::min(a.fill_, b.fill_));
}

/// By the box alone: a ray visits few nodes, and GJK would cost more than it spares.
[[nodiscard]] inline bool met_by(const Hull& hull, const RaySegment& ray) noexcept { return met_by(hull.box_, ray); }

static_assert(BoundingVolume<Hull>);

}  // namespace odds::volume
