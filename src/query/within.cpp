// By rays: which way a surface faces where a ray first meets it tells inside from outside.
#include "query/within.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "odds/math/tolerances.hpp"
#include "odds/query/ray.hpp"

namespace odds::query {
namespace {

constexpr std::uint64_t nodes_of_ray = 512;  // far beyond what a ray in a real mesh visits
constexpr double endless = std::numeric_limits<double>::infinity();

Vec3 middle(const Shape& shape) noexcept { return 0.5 * shape.mesh().lower() + 0.5 * shape.mesh().upper(); }

Vec3 first_vertex(const Shape& shape) noexcept {
  return shape.mesh().vertices()[shape.mesh().triangles().front()[0]];
}

bool in_box(const Shape& shape, const Vec3& point) noexcept {
  return (point.array() >= shape.mesh().lower().array()).all() && (point.array() <= shape.mesh().upper().array()).all();
}

bool can_hold(const Shape& outer, const Vec3& point) noexcept {
  return outer.is_solid() && outer.has_polygons() && in_box(outer, point);
}

/// Where a line from `point` leaves the solid: nothing if the surface that it meets first is seen from outside.
std::optional<RayHit> exit_along(const Shape& solid, const Vec3& point, const Vec3& direction,
                                 std::uint32_t& rays) noexcept {
  ++rays;
  const std::optional<RayHit> hit = cast_ray(solid, point, direction, endless, nodes_of_ray);
  if (!hit) return hit;
  const mesh::TriangleMesh& mesh = solid.mesh();
  const mesh::Triangle& t = mesh.triangles()[hit->triangle];
  const Vec3& p = mesh.vertices()[t[0]];
  const Vec3 outward = (mesh.vertices()[t[1]] - p).cross(mesh.vertices()[t[2]] - p);
  return outward.dot(direction) > 0.0 ? hit : std::nullopt;
}

/// Away from the middle of the box, where the surface is nearest in most solids; any direction at the middle itself.
Vec3 outwards(const Shape& solid, const Vec3& point) noexcept {
  const Vec3 away = point - middle(solid);
  const double length = away.norm();
  return length > 1e-9 * solid.mesh().size() ? Vec3(away / length) : Vec3(Vec3(0.48, 0.6, 0.64));
}

bool holds(const Shape& outer, const Vec3& point, std::uint32_t& rays) noexcept {
  if (!can_hold(outer, point)) return false;
  const Vec3 direction = outwards(outer, point);
  return exit_along(outer, point, direction, rays) && exit_along(outer, point, -direction, rays);
}

/// The outer shape, the inner one and its pose, in the outer one's frame.
struct Nested {
  const Shape& outer;
  const Shape& inner;
  math::Pose pose;
};

/// From the far side of the inner shape, seen along `direction` on the line through `point`, to the outer surface.
Contact contact_along(const Nested& nested, const Vec3& point, const Vec3& direction, const RayHit& exit,
                      std::uint32_t& rays) noexcept {
  // From outside the inner shape: its middle need not be in it.
  const Vec3 begin = nested.pose.inverse() * point;
  const Vec3 along = nested.pose.rotation.transpose() * direction;
  const double back = (begin - middle(nested.inner)).norm() + nested.inner.mesh().size();
  ++rays;
  const std::optional<RayHit> entry =
      cast_ray(nested.inner, begin - back * along, along.normalized(), 2.0 * back, nodes_of_ray);
  double far = entry ? back - entry->distance : 0.0;
  Contact contact;
  contact.triangle_b = entry ? entry->triangle : no_feature;
  if (!entry) far = std::max(0.0, direction.dot(point - nested.pose * first_vertex(nested.inner)));
  contact.depth = exit.distance + far;
  contact.position = point + 0.5 * (exit.distance - far) * direction;
  contact.normal = direction;
  contact.triangle_a = exit.triangle;
  return contact;
}

}  // namespace

bool may_be_within(const Shape& a, const Shape& b, const math::Pose& b_in_a) noexcept {
  return can_hold(a, b_in_a * first_vertex(b)) || can_hold(b, b_in_a.inverse() * first_vertex(a));
}

Within within(const Shape& a, const Shape& b, const math::Pose& b_in_a, std::uint32_t& rays) noexcept {
  if (holds(a, b_in_a * first_vertex(b), rays)) return Within::b_in_a;
  if (holds(b, b_in_a.inverse() * first_vertex(a), rays)) return Within::a_in_b;
  return Within::neither;
}

std::optional<Contact> way_out(const Shape& a, const Shape& b, const math::Pose& b_in_a, Within which,
                               std::span<const Vec3> preferred, const Deadline& deadline,
                               std::uint32_t& rays) noexcept {
  if (which == Within::neither) return std::nullopt;
  const bool b_inside = which == Within::b_in_a;
  const Nested nested = b_inside ? Nested{a, b, b_in_a} : Nested{b, a, b_in_a.inverse()};
  const Vec3 centre = nested.pose * middle(nested.inner);
  const Vec3 point = holds(nested.outer, centre, rays) ? centre : nested.pose * first_vertex(nested.inner);
  Vec3 best = Vec3::Zero();
  RayHit exit;
  double least = endless;
  const auto offer = [&](const Vec3& direction, double factor) noexcept {
    if (least < endless && deadline()) return;
    const std::optional<RayHit> found = exit_along(nested.outer, point, direction, rays);
    if (!found || !(factor * found->distance < least)) return;
    least = factor * found->distance;
    exit = *found;
    best = direction;
  };
  for (const Vec3& motion : preferred) {
    offer(b_inside ? motion : Vec3(-(nested.pose.rotation * motion)), tolerances::way_it_came);
  }
  offer(outwards(nested.outer, point), 1.0);
  for (int axis = 0; axis < 3; ++axis) {
    offer(Vec3::Unit(axis), 1.0);
    offer(-Vec3::Unit(axis), 1.0);
  }
  if (!(least < endless)) return std::nullopt;
  Contact contact = contact_along(nested, point, best, exit, rays);
  if (!std::isfinite(contact.depth) || !contact.position.allFinite()) return std::nullopt;
  if (b_inside) {
    contact.normal = -contact.normal;
  } else {
    contact.normal = b_in_a.rotation * contact.normal;
    contact.position = b_in_a * contact.position;
    std::swap(contact.triangle_a, contact.triangle_b);
  }
  return contact;
}

}  // namespace odds::query
