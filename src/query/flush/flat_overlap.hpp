// How two flat faces that nearly face each other overlap: polygons in a plane between them, and how deep they are
// there.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "query/patch/overlap.hpp"

namespace odds::query::flat {

/// A corner of a polygon as seen along the normal, and how deep the overlap is there.
struct Seen {
  double u;
  double v;
  double depth;
};

template <std::size_t most>
struct Polygon {
  std::array<Seen, most> corners;
  std::size_t count = 0;
};

/// What lies to the left of the line, where `side` is not negative (Sutherland and Hodgman 1974).
template <std::size_t most, class Side>
void clip(Polygon<most>& polygon, Side&& side) noexcept {
  std::array<double, most> distance;
  bool all = true;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    distance[i] = side(polygon.corners[i]);
    all = all && distance[i] >= 0.0;
  }
  if (all) return;
  Polygon<most> kept;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const std::size_t next = i + 1 < polygon.count ? i + 1 : 0;
    const Seen& from = polygon.corners[i];
    const Seen& to = polygon.corners[next];
    if (distance[i] >= 0.0 && kept.count < most) kept.corners[kept.count++] = from;
    if ((distance[i] >= 0.0) == (distance[next] >= 0.0) || kept.count == most) continue;
    const double t = distance[i] / (distance[i] - distance[next]);
    kept.corners[kept.count++] = {from.u + t * (to.u - from.u), from.v + t * (to.v - from.v),
                                  from.depth + t * (to.depth - from.depth)};
  }
  std::copy_n(kept.corners.begin(), kept.count, polygon.corners.begin());
  polygon.count = kept.count;
}

/// Two planes that nearly face each other, seen along the mean of their normals.
class Facing {
 public:
  /// By `normal . x = offset`; through which points near `origin` go.
  struct Plane {
    Vec3 normal;
    double offset;
  };
  // Neither is preferred: exchanging the bodies turns the normal round, and nothing else.
  Facing(const Plane& a, const Plane& b, const Vec3& origin) noexcept
      : frame_((b.normal - a.normal).normalized()), origin_(origin), a_(height_of(a)), b_(height_of(b)) {}

  [[nodiscard]] const Vec3& normal() const noexcept { return frame_.normal; }
  [[nodiscard]] const patch::Frame& frame() const noexcept { return frame_; }
  /// B's plane above A's is an overlap.
  [[nodiscard]] Seen seen(const Vec3& point) const noexcept {
    const Vec3 from = point - origin_;
    const double u = frame_.u.dot(from);
    const double v = frame_.v.dot(from);
    return {u, v, b_.at(u, v) - a_.at(u, v)};
  }
  [[nodiscard]] Vec3 on_a(const Seen& p) const noexcept {
    return origin_ + p.u * frame_.u + p.v * frame_.v + a_.at(p.u, p.v) * frame_.normal;
  }

 private:
  /// Of a plane over the frame's, which goes through the origin.
  struct Height {
    double level, by_u, by_v;
    [[nodiscard]] double at(double u, double v) const noexcept { return level + by_u * u + by_v * v; }
  };
  [[nodiscard]] Height height_of(const Plane& plane) const noexcept {
    const double steepness = plane.normal.dot(frame_.normal);
    return {(plane.offset - plane.normal.dot(origin_)) / steepness, -plane.normal.dot(frame_.u) / steepness,
            -plane.normal.dot(frame_.v) / steepness};
  }

  patch::Frame frame_;
  Vec3 origin_;
  Height a_, b_;
};

/// How large a convex polygon is.
struct Extent {
  double diagonal = 0.0;  ///< of the box about it
  double area = 0.0;
  Seen deepest;

  template <std::size_t most>
  explicit Extent(const Polygon<most>& polygon) noexcept : deepest(polygon.corners[0]) {
    double low[2] = {polygon.corners[0].u, polygon.corners[0].v};
    double high[2] = {low[0], low[1]};
    for (std::size_t i = 0; i < polygon.count; ++i) {
      const Seen& p = polygon.corners[i];
      const Seen& next = polygon.corners[i + 1 < polygon.count ? i + 1 : 0];
      area += 0.5 * (p.u * next.v - next.u * p.v);
      if (p.depth > deepest.depth) deepest = p;
      low[0] = std::min(low[0], p.u);
      low[1] = std::min(low[1], p.v);
      high[0] = std::max(high[0], p.u);
      high[1] = std::max(high[1], p.v);
    }
    area = std::abs(area);
    diagonal = std::sqrt((high[0] - low[0]) * (high[0] - low[0]) + (high[1] - low[1]) * (high[1] - low[1]));
  }
};

/// A face's corners, and its normal, into A.
struct SeenFace {
  std::span<const Seen> corners;
  Vec3 normal;

  [[nodiscard]] bool has_corner(const Seen& at, double rounding) const noexcept {
    return std::any_of(corners.begin(), corners.end(), [&](const Seen& p) {
      return std::abs(p.u - at.u) <= rounding && std::abs(p.v - at.v) <= rounding;
    });
  }
  /// Along the side that a point is nearest to; in the face, by its normal.
  [[nodiscard]] Vec3 side_at(const Seen& at, const patch::Frame& frame) const noexcept {
    double least = std::numeric_limits<double>::infinity();
    Vec3 side = Vec3::Zero();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Seen& from = corners[i];
      const Seen& to = corners[i + 1 < corners.size() ? i + 1 : 0];
      const double u = to.u - from.u;
      const double v = to.v - from.v;
      const double off = std::abs(u * (at.v - from.v) - v * (at.u - from.u)) / std::sqrt(u * u + v * v);
      if (!(off < least)) continue;
      least = off;
      side = u * frame.u + v * frame.v;
    }
    return side - side.dot(normal) / frame.normal.dot(normal) * frame.normal;
  }
};

/// Along which faces part that lean: a corner of one along the normal of the other, two sides across both.
[[nodiscard]] inline Vec3 normal_at(const Extent& overlap, const SeenFace& a, const SeenFace& b,
                                    const patch::Frame& frame) noexcept {
  const Seen& deepest = overlap.deepest;
  const double rounding = 1e-9 * overlap.diagonal;
  if (b.has_corner(deepest, rounding)) return a.normal;
  if (a.has_corner(deepest, rounding)) return b.normal;
  const Vec3 side_a = a.side_at(deepest, frame);
  const Vec3 side_b = b.side_at(deepest, frame);
  const Vec3 across = side_a.cross(side_b);
  const double along = across.dot(frame.normal);
  constexpr double parallel = 0.1;  // there, what rounding leaves of a side would turn it
  if (!(std::abs(along) > parallel * side_a.norm() * side_b.norm())) return frame.normal;
  return along > 0.0 ? Vec3(across.normalized()) : Vec3(-across.normalized());
}

}  // namespace odds::query::flat
