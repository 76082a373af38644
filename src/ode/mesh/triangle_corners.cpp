// Normal and angle of one triangle.
#include "ode/mesh/triangle_corners.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace odds::ode {
namespace {

Vec3 closest_on_segment(const Vec3& a, const Vec3& b, const Vec3& point) noexcept {
  const Vec3 d = b - a;
  const double square = d.squaredNorm();
  if (!(square > 0.0)) return a;
  return a + std::clamp(d.dot(point - a) / square, 0.0, 1.0) * d;
}

}  // namespace

Vec3 unit_normal(const Corners& triangle) noexcept {
  const Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  const double length = normal.norm();
  return length > 0.0 ? Vec3(normal / length) : Vec3(Vec3::Zero());
}

bool is_thin(const Corners& t, double height) noexcept {
  constexpr double low = 0.01;  // of the longest side
  const Vec3 sides[3] = {t[1] - t[0], t[2] - t[1], t[0] - t[2]};
  const double longest = std::max({sides[0].squaredNorm(), sides[1].squaredNorm(), sides[2].squaredNorm()});
  return sides[0].cross(sides[2]).squaredNorm() <= std::min(height * height, low * low * longest) * longest;
}

double angle_at(const Corners& triangle, const Vec3& point_on_it, double tolerance) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    if ((triangle[i] - point_on_it).norm() > tolerance) continue;
    const Vec3 u = triangle[(i + 1) % 3] - triangle[i];
    const Vec3 v = triangle[(i + 2) % 3] - triangle[i];
    return std::atan2(u.cross(v).norm(), u.dot(v));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 on_edge = closest_on_segment(triangle[i], triangle[(i + 1) % 3], point_on_it);
    if ((on_edge - point_on_it).norm() <= tolerance) return std::numbers::pi;
  }
  return 2.0 * std::numbers::pi;
}

}  // namespace odds::ode
