// One contact from one intersecting pair of triangles: what a budget without time for a patch still gives.
#pragma once

#include <algorithm>

#include "odds/primitive/triangle_triangle.hpp"
#include "odds/query/answer.hpp"
#include "query/posed_meshes.hpp"

namespace odds::query {

/// About 0.2 us. Position: middle of the segment in which the triangles meet. Normal: difference of the face normals,
/// turned towards `towards_a` unless both bodies are solid. Depth: the lesser of how far one triangle's corners lie
/// beyond the other's plane.
[[nodiscard]] inline Contact first_contact(const PosedMeshes& meshes, TrianglePair hit, bool both_solid,
                                           const Vec3& towards_a) noexcept {
  const tree::TriangleCorners a = meshes.corners_a(hit.a);
  const tree::TriangleCorners b = meshes.corners_b(hit.b);
  const auto unit_normal = [](const tree::TriangleCorners& t) -> Vec3 {
    const Vec3 cross = (t[1] - t[0]).cross(t[2] - t[0]);
    const double length = cross.norm();
    return length > 0.0 ? Vec3(cross / length) : Vec3(Vec3::Zero());
  };
  const auto farthest_beyond = [](const tree::TriangleCorners& t, const Vec3& origin, const Vec3& direction) {
    double farthest = 0.0;
    for (const Vec3& corner : t) farthest = std::max(farthest, direction.dot(corner - origin));
    return farthest;
  };
  const Vec3 normal_a = unit_normal(a);
  const Vec3 normal_b = unit_normal(b);
  Contact contact;
  Vec3 direction = normal_b - normal_a;
  if (!(direction.norm() > 1e-9)) direction = towards_a;
  if (!(direction.norm() > 0.0)) direction = Vec3::UnitZ();
  contact.normal = direction.normalized();
  if (!both_solid && contact.normal.dot(towards_a) < 0.0) contact.normal = -contact.normal;
  const double side_a = normal_a.dot(contact.normal) > 0.0 ? 1.0 : -1.0;
  const double side_b = normal_b.dot(contact.normal) > 0.0 ? 1.0 : -1.0;
  contact.depth = std::min(farthest_beyond(a, b[0], -side_b * normal_b), farthest_beyond(b, a[0], side_a * normal_a));
  primitive::IntersectionSegment segment;
  segment.begin = segment.end = (a[0] + a[1] + a[2]) / 3.0;
  static_cast<void>(primitive::intersection_segment(a.data(), b.data(), segment));
  contact.position = 0.5 * (segment.begin + segment.end) + meshes.origin_a();
  contact.triangle_a = hit.a;
  contact.triangle_b = hit.b;
  return contact;
}

}  // namespace odds::query
