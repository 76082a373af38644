#include "query/contacts/slid_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "odds/math/tolerances.hpp"
#include "query/memory/late_contacts.hpp"
#include "query/memory/pair_memory.hpp"
#include "query/ray/budgeted_ray.hpp"

namespace odds::query {
namespace {

/// One body of a pair, and how its mesh frame stands in A's.
struct Posed {
  const Shape& shape;
  math::Pose pose;

  /// Unit, A's frame; zero of a triangle without an area.
  [[nodiscard]] Vec3 outward(std::uint32_t triangle) const noexcept {
    if (triangle == no_feature) return Vec3::Zero();
    const mesh::Triangle& t = shape.mesh().triangles()[triangle];
    const std::span<const Vec3> vertices = shape.mesh().vertices();
    const Vec3 cross = (vertices[t[1]] - vertices[t[0]]).cross(vertices[t[2]] - vertices[t[0]]);
    return pose.rotation * cross.stableNormalized();
  }
};

/// A normal that is that of a facet turns as the surface does from this facet to that one. Others, of edges or of the
/// other body's faces, stay.
Vec3 turned(const Vec3& normal, const Vec3& from, const Vec3& to) noexcept {
  const double sign = from.dot(normal) < 0.0 ? -1.0 : 1.0;
  if (sign * from.dot(normal) < tolerances::slid_facet || sign * to.dot(normal) < tolerances::hasty_agreement) {
    return normal;
  }
  return (normal + sign * (to - from)).normalized();
}

/// `held` as it is at `pose_b_in_a`; its point of the smaller body stays where it is.
Seen measure(const math::Pose& pose_b_in_a, const Pair::Implementation& pair, double size, Spending& spending,
             HeldContact& held) noexcept {
  const bool is_on_b = pair.b->mesh().size() <= pair.a->mesh().size();
  const Posed other = is_on_b ? Posed{*pair.a, {}} : Posed{*pair.b, pose_b_in_a};
  const auto [depth, slip] = held.parted(pose_b_in_a);
  Contact contact = held.at(pose_b_in_a);
  const Vec3 point = is_on_b ? Vec3(pose_b_in_a * held.on_b()) : held.on_a();
  const Vec3 inwards = is_on_b ? contact.normal : Vec3(-contact.normal);
  // A point that moved across the normal of a surface is off it by what that bends.
  const double reach = std::abs(depth) + tolerances::slid_bend * slip + tolerances::unmeasured_depth * size;
  const math::Pose back = other.pose.inverse();
  RayHit hit;
  const Seen seen = cast_budgeted_ray(other.shape, back * Vec3(point - reach * inwards), back.rotation * inwards,
                                      2.0 * reach, spending, hit);
  // One that is not seen to its end within a ray's nodes would take the time of every run.
  const bool had_time = spending.allows(most_nodes_of_a_ray) && spending.may_make_contacts();
  if (seen == Seen::unknown && had_time) return Seen::none;
  if (seen != Seen::surface) return seen;
  const double cosine = facing(other.shape, hit.triangle, back.rotation * inwards);
  if (!((other.shape.is_solid() ? -cosine : std::abs(cosine)) > tolerances::same_contact_side)) return Seen::none;
  std::uint32_t& facet = is_on_b ? contact.triangle_a : contact.triangle_b;
  if (hit.triangle != facet) contact.normal = turned(contact.normal, other.outward(facet), other.outward(hit.triangle));
  facet = hit.triangle;
  contact.depth = reach - hit.distance;
  contact.position = point + (is_on_b ? -0.5 : 0.5) * contact.depth * contact.normal;
  held = HeldContact(contact, pose_b_in_a);
  return Seen::surface;
}

}  // namespace

void measure_slid(const math::Pose& pose_b_in_a, const Request& request, Pair::Implementation& pair,
                  Spending& spending) noexcept {
  const double size = smaller_size(pair);
  bool is_reserved = false;
  pair.late->manifold().measure_slid(pose_b_in_a, size, request.margin, [&](HeldContact& held) noexcept {
    if (!is_reserved) spending.reserve_for_contacts(pair.endings.ray);
    is_reserved = true;
    return measure(pose_b_in_a, pair, size, spending, held);
  });
}

}  // namespace odds::query
