// How far two triangles, or two meshes along a line, overlap in a direction.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "odds/math/tolerances.hpp"
#include "query/patch/rim.hpp"
#include "query/patch/watch.hpp"

namespace odds::query::patch {

/// Two points, one on each surface, on a line along the normal: moving A by depth * normal brings them together.
struct Witness {
  Vec3 on_a = Vec3::Zero();
  Vec3 on_b = Vec3::Zero();
  double depth = 0.0;
  std::uint32_t triangle_a = no_feature;
  std::uint32_t triangle_b = no_feature;

  /// Half-way, so that exchanging the bodies leaves it where it is.
  [[nodiscard]] Vec3 middle() const noexcept { return 0.5 * (on_a + on_b); }
};

/// Coordinates (u, v, height along the normal). u and v are a smooth function of the normal almost everywhere.
struct Frame {
  Vec3 u;
  Vec3 v;
  Vec3 normal;

  explicit Frame(const Vec3& unit_normal) noexcept : normal(unit_normal) {
    // Duff et al., Building an Orthonormal Basis, Revisited, JCGT 2017.
    const double sign = std::copysign(1.0, normal.z());
    const double p = -1.0 / (sign + normal.z());
    const double q = normal.x() * normal.y() * p;
    u = Vec3(1.0 + sign * normal.x() * normal.x() * p, sign * q, -sign * normal.x());
    v = Vec3(q, sign + normal.y() * normal.y() * p, -normal.y());
  }
  [[nodiscard]] Vec3 operator()(const Vec3& point) const noexcept {
    return {u.dot(point), v.dot(point), normal.dot(point)};
  }
};

/// Calls found(on_a, on_b, depth) for the corners of the overlap of the two triangles seen along the frame's normal:
/// corners of one above the other and crossings of sides. The largest depth is how far A's triangle must move along the
/// normal to leave B's. Triangles seen edge-on (a wall on a floor) are the usual case and need no care of the caller.
/// `shift` moves A's triangle first. Depths are not sorted and may be negative.
template <class Found>
void overlap_corners(const PlacedPair& placed, const Frame& frame, const Vec3& shift, Found&& found) noexcept {
  const Vec3 origin = placed.b[0];
  std::array<Vec3, 3> a;
  std::array<Vec3, 3> b;
  for (std::size_t i = 0; i < 3; ++i) {
    a[i] = frame(placed.a[i] + shift - origin);
    b[i] = frame(placed.b[i] - origin);
  }
  const auto cross = [](const Vec3& p, const Vec3& q) noexcept { return p.x() * q.y() - p.y() * q.x(); };

  // Corners of one over the face of the other.
  const auto corners_over = [&](const std::array<Vec3, 3>& corners, const std::array<Vec3, 3>& face, double facing,
                                auto&& report) noexcept {
    const double area = cross(face[1] - face[0], face[2] - face[0]);
    if (std::abs(facing) < tolerances::edge_on || area == 0.0) return;
    for (std::size_t i = 0; i < 3; ++i) {
      const double w0 = cross(face[1] - corners[i], face[2] - corners[i]) / area;
      const double w1 = cross(face[2] - corners[i], face[0] - corners[i]) / area;
      const double w2 = 1.0 - w0 - w1;
      if (w0 < -tolerances::on_border || w1 < -tolerances::on_border || w2 < -tolerances::on_border) continue;
      report(i, w0 * face[0].z() + w1 * face[1].z() + w2 * face[2].z());
    }
  };
  corners_over(a, b, placed.normal_b.dot(frame.normal), [&](std::size_t i, double height) noexcept {
    const double depth = height - a[i].z();
    found(placed.a[i], Vec3(placed.a[i] + depth * frame.normal), depth);
  });
  corners_over(b, a, placed.normal_a.dot(frame.normal), [&](std::size_t i, double height) noexcept {
    const double depth = b[i].z() - height;
    found(Vec3(placed.b[i] - depth * frame.normal), placed.b[i], depth);
  });

  // Crossings of sides. Sides along the line of sight are covered by their corners.
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 along_a = a[(i + 1) % 3] - a[i];
    const double seen_a = along_a.x() * along_a.x() + along_a.y() * along_a.y();
    if (seen_a <= tolerances::edge_on * tolerances::edge_on * along_a.squaredNorm()) continue;
    for (std::size_t j = 0; j < 3; ++j) {
      const Vec3 along_b = b[(j + 1) % 3] - b[j];
      const double seen_b = along_b.x() * along_b.x() + along_b.y() * along_b.y();
      if (seen_b <= tolerances::edge_on * tolerances::edge_on * along_b.squaredNorm()) continue;
      const double denominator = cross(along_a, along_b);
      if (denominator * denominator <= tolerances::parallel_sides * tolerances::parallel_sides * seen_a * seen_b)
        continue;
      const Vec3 between = b[j] - a[i];
      const double s = cross(between, along_b) / denominator;
      const double t = cross(between, along_a) / denominator;
      const double slack = tolerances::on_border;
      if (s < -slack || s > 1.0 + slack || t < -slack || t > 1.0 + slack) continue;
      const double depth = (b[j].z() + t * along_b.z()) - (a[i].z() + s * along_a.z());
      const Vec3 on_a = placed.a[i] + s * (placed.a[(i + 1) % 3] - placed.a[i]);
      found(on_a, Vec3(on_a + depth * frame.normal), depth);
    }
  }
}

/// Between which heights along a direction a line leaves one of the bodies, if what it measures is the overlap at a
/// rim: from a place below the floor beside a wall, a line sideways runs along under the floor to its far end.
struct ExitRange {
  Vec3 direction = Vec3::Zero();  ///< unit
  Vec3 origin = Vec3::Zero();     ///< heights count from here
  double low = 0.0;
  double high = 0.0;
  bool of_b = false;

  [[nodiscard]] bool has(const Witness& measured) const noexcept {
    const double height = direction.dot((of_b ? measured.on_b : measured.on_a) - origin);
    return low <= height && height <= high;
  }
};

/// Several, all of which count.
using ExitRanges = std::span<const ExitRange>;

[[nodiscard]] inline bool all_have(ExitRanges ranges, const Witness& measured) noexcept {
  return std::all_of(ranges.begin(), ranges.end(), [&](const ExitRange& range) { return range.has(measured); });
}

/// Largest depth of one pair along a direction, at least 0.
[[nodiscard]] double pair_depth(const PlacedPair& placed, const Frame& frame, const Vec3& shift) noexcept;

enum class Probing : std::uint8_t {
  unknown,  ///< a probe is missing, or has not seen where the line leaves a body
  missed,   ///< one of the bodies is not on the line
  apart,    ///< the bodies do not overlap on the line
  overlap,
};

/// The overlap on the line through `point` along `normal`, by the probes: from A's surface up to B's. For solids the
/// crossing at which the line leaves the body, for sheets the nearest within `reach`. Writes `witness` where both are
/// found; where they are apart its depth is below 0.
[[nodiscard]] Probing probe_line(const PatchInput& input, const Vec3& point, const Vec3& normal, double reach,
                                 Watch& watch, Witness& witness) noexcept;

/// Whether the bodies are known to overlap there: see probe_line.
[[nodiscard]] bool probe_overlap(const PatchInput& input, const Vec3& point, const Vec3& normal, double reach,
                                 Watch& watch, Witness& witness) noexcept;

/// Normals of triangles of the meshes, both in A's frame, not of unit length; zero for an index out of range.
[[nodiscard]] Vec3 normal_in_a(const PatchInput& input, std::uint32_t triangle) noexcept;
[[nodiscard]] Vec3 normal_in_b(const PatchInput& input, std::uint32_t triangle) noexcept;

}  // namespace odds::query::patch
