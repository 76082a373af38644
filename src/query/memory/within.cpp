// By rays: which way a surface faces where a ray first meets it tells inside from outside.
#include "query/memory/within.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "odds/math/tolerances.hpp"
#include "query/ray/budgeted_ray.hpp"

namespace odds::query {
namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

Vec3 middle(const Shape& shape) noexcept { return 0.5 * shape.mesh().lower() + 0.5 * shape.mesh().upper(); }

Vec3 first_vertex(const Shape& shape) noexcept { return shape.mesh().vertices()[shape.mesh().triangles().front()[0]]; }

bool in_box(const Shape& shape, const Vec3& point) noexcept {
  return (point.array() >= shape.mesh().lower().array()).all() && (point.array() <= shape.mesh().upper().array()).all();
}

bool can_hold(const Shape& outer, const Vec3& point) noexcept {
  return outer.is_solid() && outer.has_polygons() && in_box(outer, point);
}

/// Where a line from `point` leaves the solid: none if the surface that it meets first is seen from outside.
Seen exit_along(const Shape& solid, const Vec3& point, const Vec3& direction, Spending& spending,
                RayHit& exit) noexcept {
  const Seen seen = cast_budgeted_ray(solid, point, direction, endless, spending, exit);
  if (seen != Seen::surface) return seen;
  return facing(solid, exit.triangle, direction) > 0.0 ? Seen::surface : Seen::none;
}

/// Away from the middle of the box, where the surface is nearest in most solids; any direction at the middle itself.
Vec3 outwards(const Shape& solid, const Vec3& point) noexcept {
  const Vec3 away = point - middle(solid);
  const double length = away.norm();
  return length > 1e-9 * solid.mesh().size() ? Vec3(away / length) : Vec3(Vec3(0.48, 0.6, 0.64));
}

/// surface: the point is inside, and the nearest exit that was seen is noted; none: outside.
Seen holds(const Shape& outer, const Vec3& point, Exit& nearest, Spending& spending) noexcept {
  if (!can_hold(outer, point)) return Seen::none;
  const auto look = [&](const Vec3& direction) noexcept {
    RayHit hit;
    const Seen seen = exit_along(outer, point, direction, spending, hit);
    if (seen == Seen::surface && (nearest.direction.isZero() || hit.distance < nearest.hit.distance)) {
      nearest = {direction, hit};
    }
    return seen;
  };
  const Vec3 direction = outwards(outer, point);
  const Seen one = look(direction);
  if (one == Seen::unknown) return one;
  const Seen other = look(-direction);
  if (other == one || other == Seen::unknown) return other;
  // One of them grazed an edge: a third decides.
  return look(direction.unitOrthogonal());
}

/// The outer shape, the inner one and its pose, in the outer one's frame.
struct Nested {
  const Shape& outer;
  const Shape& inner;
  math::Pose pose;
};

/// From the far side of the inner shape, seen along `direction` on the line through `point`, to the outer surface.
Contact contact_along(const Nested& nested, const Vec3& point, const Vec3& direction, const RayHit& exit,
                      Spending& spending) noexcept {
  // From outside the inner shape: its middle need not be in it.
  const Vec3 begin = nested.pose.inverse() * point;
  const Vec3 along = nested.pose.rotation.transpose() * direction;
  const double back = (begin - middle(nested.inner)).norm() + nested.inner.mesh().size();
  RayHit entry;
  const Seen seen = cast_budgeted_ray(nested.inner, begin - back * along, along.normalized(), endless, spending, entry);
  // Where the line misses it, or meets it only farther on: its first vertex at least is to leave.
  const double of_vertex = direction.dot(point - nested.pose * first_vertex(nested.inner));
  const double far = std::max(0.0, seen == Seen::surface ? back - entry.distance : of_vertex);
  Contact contact;
  contact.triangle_b = seen == Seen::surface ? entry.triangle : no_feature;
  contact.depth = exit.distance + far;
  contact.position = point + 0.5 * (exit.distance - far) * direction;
  contact.normal = direction;
  contact.triangle_a = exit.triangle;
  return contact;
}

}  // namespace

bool may_be_within(const Shape& a, const Shape& b, const math::Pose& b_in_a) noexcept {
  // An open body can hold nothing; of others this is asked in every query that finds them apart.
  return (a.is_solid() && can_hold(a, b_in_a * first_vertex(b))) ||
         (b.is_solid() && can_hold(b, b_in_a.inverse() * first_vertex(a)));
}

Within within(const Shape& a, const Shape& b, const math::Pose& b_in_a, Exit& exit, Spending& spending) noexcept {
  exit = {};
  const Seen b_held = holds(a, b_in_a * first_vertex(b), exit, spending);
  if (b_held == Seen::surface) return Within::b_in_a;
  exit = {};
  const Seen a_held = holds(b, b_in_a.inverse() * first_vertex(a), exit, spending);
  if (a_held == Seen::surface) return Within::a_in_b;
  return b_held == Seen::none && a_held == Seen::none ? Within::neither : Within::unknown;
}

std::optional<Contact> way_out(const Shape& a, const Shape& b, const math::Pose& b_in_a, Within which,
                               std::span<const Vec3> preferred, const Exit& known, Spending& spending) noexcept {
  if (which != Within::b_in_a && which != Within::a_in_b) return std::nullopt;
  const bool b_inside = which == Within::b_in_a;
  const Nested nested = b_inside ? Nested{a, b, b_in_a} : Nested{b, a, b_in_a.inverse()};
  const Vec3 centre = nested.pose * middle(nested.inner);
  Exit of_centre;
  const bool centre_is_inside = holds(nested.outer, centre, of_centre, spending) == Seen::surface;
  const Vec3 vertex = nested.pose * first_vertex(nested.inner);
  Vec3 point = centre_is_inside ? centre : vertex;
  Vec3 best = Vec3::Zero();
  RayHit exit;
  double least = endless;
  const auto offer = [&](const Vec3& direction, double factor) noexcept {
    RayHit found;
    if (exit_along(nested.outer, point, direction, spending, found) != Seen::surface) return;
    if (!(factor * found.distance < least)) return;
    least = factor * found.distance;
    exit = found;
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
  if (!(least < endless)) {
    if (known.direction.isZero()) return std::nullopt;
    point = vertex;
    exit = known.hit;
    best = known.direction;
  }
  Contact contact = contact_along(nested, point, best, exit, spending);
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
