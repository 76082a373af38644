#include "odds/report/accuracy/contact_region.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "odds/query/ray.hpp"

namespace odds::report {
namespace {

using Corners = std::array<Vec3, 3>;

Corners corners_of(const mesh::TriangleMesh& mesh, std::uint32_t triangle) {
  const mesh::Triangle& t = mesh.triangles()[triangle];
  return {mesh.vertices()[t[0]], mesh.vertices()[t[1]], mesh.vertices()[t[2]]};
}

double distance_to(const primitive::IntersectionSegment& segment, const Vec3& point) {
  const Vec3 along = segment.end - segment.begin;
  const double squared = along.squaredNorm();
  const double share = squared > 0.0 ? std::clamp((point - segment.begin).dot(along) / squared, 0.0, 1.0) : 0.0;
  return (point - segment.begin - share * along).norm();
}

bool leaves_odd(const query::Shape& shape, Vec3 point, const Vec3& direction) {
  constexpr int most_crossings = 10000;
  const double size = shape.mesh().size();
  int count = 0;
  for (; count < most_crossings; ++count) {
    const auto hit = query::cast_ray(shape, point, direction, 4.0 * size);
    if (!hit) break;
    point += (hit->distance + 1e-9 * size) * direction;
  }
  return count % 2 == 1;
}

bool is_inside(const query::Shape& shape, const Vec3& point) {
  // In no special direction, so that a ray along an edge, which may count it twice, is a rare thing.
  const std::array<Vec3, 3> directions = {Vec3(0.4812, 0.7391, -0.4713).normalized(),
                                          Vec3(-0.8117, 0.2239, 0.5394).normalized(),
                                          Vec3(0.1573, -0.6421, 0.7503).normalized()};
  int votes = 0;
  for (const Vec3& direction : directions) votes += leaves_odd(shape, point, direction) ? 1 : 0;
  return votes >= 2;
}

}  // namespace

ContactRegion::ContactRegion(const query::Shape& a, const query::Shape& b, const math::Pose& b_in_a,
                             std::span<const query::TrianglePair> crossings)
    : a_(a), b_(b), a_in_b_(b_in_a.inverse()) {
  for (const query::TrianglePair& crossing : crossings) {
    const Corners in_a = corners_of(a.mesh(), crossing.a);
    Corners in_b = corners_of(b.mesh(), crossing.b);
    for (Vec3& corner : in_b) corner = b_in_a * corner;
    primitive::IntersectionSegment segment;
    // What touches by a rounding in the trees' frames may be apart by one in the mesh's: a corner will do.
    if (!primitive::intersection_segment(in_a.data(), in_b.data(), segment)) segment = {in_a[0], in_a[0]};
    curves_.push_back(segment);
  }
}

double ContactRegion::distance(const Vec3& point) const {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& curve : curves_) least = std::min(least, distance_to(curve, point));
  const bool may_be_inside = !curves_.empty() && a_.is_solid() && b_.is_solid();
  return may_be_inside && is_inside(a_, point) && is_inside(b_, a_in_b_ * point) ? 0.0 : least;
}

}  // namespace odds::report
