#include "volume/point_to_hull.hpp"

#include <algorithm>

namespace odds::volume {
namespace {

Vec3 nearest_on_segment(const Vec3& a, const Vec3& b) noexcept {
  const Vec3 along = b - a;
  const double squared = along.squaredNorm();
  if (!(squared > 0.0)) return a;
  return a + std::clamp(-a.dot(along) / squared, 0.0, 1.0) * along;
}

/// Corners relative to the point: a subset of the vertices whose hull's nearest point is kept. At most 3 between steps.
struct Corners {
  std::array<Vec3, 4> corner;
  std::size_t count = 0;
  Vec3 nearest = Vec3::Zero();
};

bool origin_inside(const std::array<Vec3, 4>& c) noexcept {
  const auto side = [](const Vec3& p, const Vec3& q, const Vec3& r) { return p.dot(q.cross(r)); };
  const double signs[4] = {side(c[1], c[3], c[2]), side(c[0], c[2], c[3]), side(c[0], c[3], c[1]),
                           side(c[0], c[1], c[2])};
  return std::all_of(signs, signs + 4, [](double s) { return s > 0.0; }) ||
         std::all_of(signs, signs + 4, [](double s) { return s < 0.0; });
}

/// Keeps the face (or edge, or corner) that is nearest.
void reduce(Corners& corners) noexcept {
  const auto& c = corners.corner;
  if (corners.count == 1) {
    corners.nearest = c[0];
  } else if (corners.count == 2) {
    corners.nearest = nearest_on_segment(c[0], c[1]);
  } else if (corners.count == 3) {
    corners.nearest = nearest_to_origin(c[0], c[1], c[2]);
  } else if (origin_inside(c)) {
    corners.nearest.setZero();
  } else {
    std::size_t left_out = 3;
    corners.nearest = nearest_to_origin(c[0], c[1], c[2]);
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 nearest = nearest_to_origin(c[(i + 1) % 3], c[(i + 2) % 3], c[3]);
      if (nearest.squaredNorm() >= corners.nearest.squaredNorm()) continue;
      corners.nearest = nearest;
      left_out = i;
    }
    corners.corner[left_out] = Vec3(c[3]);
    corners.count = 3;
  }
}

}  // namespace

Vec3 nearest_to_origin(const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  const Vec3 normal = (b - a).cross(c - a);
  const double squared = normal.squaredNorm();
  if (squared > 0.0) {
    // The foot of the perpendicular, if it lies within all edges.
    const double u = normal.dot(b.cross(c));
    const double v = normal.dot(c.cross(a));
    const double w = normal.dot(a.cross(b));
    if (u >= 0.0 && v >= 0.0 && w >= 0.0 && u + v + w > 0.0) return (u * a + v * b + w * c) / (u + v + w);
  }
  Vec3 nearest = nearest_on_segment(a, b);
  for (const Vec3& other : {nearest_on_segment(b, c), nearest_on_segment(c, a)}) {
    if (other.squaredNorm() < nearest.squaredNorm()) nearest = other;
  }
  return nearest;
}

double distance_to_hull(const Vec3& point, std::span<const Vec3> vertices, double good_enough) noexcept {
  Corners corners;
  corners.corner[0] = vertices[0] - point;
  corners.count = 1;
  reduce(corners);
  double distance = corners.nearest.norm();
  constexpr int most_steps = 32;
  for (int step = 0; step < most_steps && distance > good_enough; ++step) {
    const Vec3 nearest = corners.nearest;
    std::size_t best = 0;
    double least = INFINITY;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const double offset = nearest.dot(vertices[i]);
      if (offset < least) {
        least = offset;
        best = i;
      }
    }
    const Vec3 found = vertices[best] - point;
    // No vertex lies nearer along the way to the nearest point: it is the hull's.
    if (nearest.dot(nearest - found) <= 1e-6 * distance * distance) break;
    corners.corner[corners.count++] = found;
    reduce(corners);
    const double reduced = corners.nearest.norm();
    if (!(reduced < distance)) break;  // rounding goes in circles
    distance = reduced;
  }
  return distance;
}

}  // namespace odds::volume
