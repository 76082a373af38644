// One contact from the first intersecting pair of triangles.
#pragma once

#include "odds/query/answer.hpp"
#include "query/encounter.hpp"

namespace odds::query {

/// Normal: difference of the unit face normals; position: mean of the centroids; depth: how far the least deep corner
/// of one triangle lies beyond the other's plane, measured along the normal.
template <volume::BoundingVolume V>
[[nodiscard]] Contact first_contact(const Encounter<V>& encounter, TrianglePair hit) noexcept {
  const tree::TriangleCorners& a = encounter.a().corners()[hit.a];
  const tree::TriangleCorners b = encounter.in_a(hit.b);
  const auto unit_normal = [](const tree::TriangleCorners& t) -> Vec3 {
    const Vec3 cross = (t[1] - t[0]).cross(t[2] - t[0]);
    const double length = cross.norm();
    return length > 0.0 ? Vec3(cross / length) : Vec3(Vec3::Zero());
  };
  const Vec3 difference = unit_normal(b) - unit_normal(a);
  Contact contact;
  contact.normal = difference.norm() > 1e-9 ? Vec3(difference.normalized()) : Vec3(Vec3::UnitZ());
  contact.position = (a[0] + a[1] + a[2] + b[0] + b[1] + b[2]) / 6.0 + encounter.a().origin();
  double lowest_a = INFINITY;
  double highest_b = -INFINITY;
  for (int i = 0; i < 3; ++i) {
    lowest_a = std::min(lowest_a, contact.normal.dot(a[static_cast<std::size_t>(i)]));
    highest_b = std::max(highest_b, contact.normal.dot(b[static_cast<std::size_t>(i)]));
  }
  contact.depth = std::max(0.0, highest_b - lowest_a);
  contact.triangle_a = encounter.a().order()[hit.a];
  contact.triangle_b = encounter.b().order()[hit.b];
  return contact;
}

}  // namespace odds::query
