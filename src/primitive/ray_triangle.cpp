#include "odds/primitive/ray_triangle.hpp"

#include <algorithm>
#include <cmath>

namespace odds::primitive {
namespace {

/// How far off u and v may be: products of the way to the triangle, an edge and the direction err by 10 roundings.
double rounding_of(const Vec3& edge1, const Vec3& edge2, const Vec3& from_corner, const Vec3& direction,
                   double determinant) noexcept {
  constexpr double roundings = 16.0 * 0x1p-53;
  const double product =
      from_corner.squaredNorm() * std::max(edge1.squaredNorm(), edge2.squaredNorm()) * direction.squaredNorm();
  return 2.0 * roundings * std::sqrt(product) / std::abs(determinant);
}

}  // namespace

double distance_along_ray(const Vec3 corners[3], const Vec3& origin, const Vec3& direction) noexcept {
  constexpr double none = -1.0;
  constexpr double slack = 1e-12;  // of the edges; and as far off as rounding may be at most
  constexpr double most_slack = 1e-6;
  const Vec3 edge1 = corners[1] - corners[0];
  const Vec3 edge2 = corners[2] - corners[0];
  const Vec3 p = direction.cross(edge2);
  const double determinant = edge1.dot(p);
  if (determinant == 0.0) return none;  // its neighbours are met instead
  const Vec3 from_corner = origin - corners[0];
  const double u = from_corner.dot(p) / determinant;
  if (!(u >= -most_slack && u <= 1.0 + most_slack)) return none;
  const Vec3 q = from_corner.cross(edge1);
  const double v = direction.dot(q) / determinant;
  if (!(v >= -most_slack && u + v <= 1.0 + most_slack)) return none;
  const double outside = -std::min({u, v, 1.0 - u - v});
  if (outside > slack && outside > slack + rounding_of(edge1, edge2, from_corner, direction, determinant)) return none;
  const double distance = edge2.dot(q) / determinant;
  constexpr double rounding = 16.0 * 0x1p-53;  // of the products that determinant and u are made of, and more
  const double product =
      std::max(edge1.squaredNorm(), from_corner.squaredNorm()) * edge2.squaredNorm() * direction.squaredNorm();
  if (determinant * determinant > rounding * rounding * product) return distance;
  constexpr double one_point = 1e-2;  // of the longer edge: noise is off by as much as edges are long
  const Vec3 apart = from_corner + distance * direction - u * edge1 - v * edge2;
  const double longer = std::max(edge1.squaredNorm(), edge2.squaredNorm());
  return apart.squaredNorm() <= one_point * one_point * longer ? distance : none;
}

}  // namespace odds::primitive
