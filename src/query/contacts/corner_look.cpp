#include "query/contacts/corner_look.hpp"

#include <cmath>
#include <variant>

#include "odds/math/tolerances.hpp"
#include "query/memory/late_manifold.hpp"
#include "query/ray/budgeted_ray.hpp"
#include "query/shape/bound_along.hpp"

namespace odds::query {
namespace {

/// With less left a look is not begun.
constexpr double enough_to_look_us = 1.2;
/// Of the smaller body's size: deeper, and it is not what contacts on the rim are about.
constexpr double farthest = 0.25;
/// A tree of a million triangles is searched in some 12; what is found in these is far along the way all the same.
constexpr std::uint64_t most_nodes = 24;
/// Of a body that is so much smaller than the other one the corners are asked for: the large one's are far away.
constexpr double smaller = 0.5;

/// One body of a pair, and the way in which its corners may be within the other, unit, in its mesh frame.
struct Sought {
  const Shape& shape;
  Vec3 way;
};

Sought sought_of(bool of_b, const math::Pose& pose_b_in_a, const Pair::Implementation& pair) noexcept {
  const Vec3& into_a = pair.corners.normal();
  return of_b ? Sought{*pair.b, pose_b_in_a.rotation.transpose() * into_a} : Sought{*pair.a, -into_a};
}

/// The corner that is farthest along the way, as far as there is time to look; no_feature: none was seen.
std::uint32_t farthest_corner(const Sought& sought, const wide::Searches& searches, Spending& spending) noexcept {
  const auto* const tree = std::get_if<tree::WideTree>(&sought.shape.data().tree);
  if (tree == nullptr) return no_feature;
  const CornerSearch search(sought.shape.mesh(), *tree, searches);
  const BoundAlong bound(search, sought.way);
  std::uint64_t left = most_nodes;
  const auto may_go_on = [&spending] {
    spending.spend_node_pairs(1);
    return spending.may_make_contacts();
  };
  return search.greatest(
      bound.excess(), [&sought](const Vec3& x) { return sought.way.dot(x); }, bound, may_go_on, left);
}

/// How deep it is in the other body: a ray from it, back the way that it came.
void measure(const SoughtCorner& sought, const math::Pose& pose_b_in_a, Pair::Implementation& pair,
             Spending& spending) noexcept {
  const double size = smaller_size(pair);
  const Vec3& normal = pair.corners.normal();
  const Shape& own = sought.of_b ? *pair.b : *pair.a;
  const Shape& other = sought.of_b ? *pair.a : *pair.b;
  const std::uint32_t triangle = CornerSearch::triangle_of(sought.corner);
  const Vec3& corner = own.mesh().vertices()[own.mesh().triangles()[triangle][sought.corner % 3]];
  const Vec3 point = sought.of_b ? Vec3(pose_b_in_a * corner) : corner;
  const Vec3 out = sought.of_b ? Vec3(-normal) : normal;
  const math::Pose back = sought.of_b ? math::Pose() : pose_b_in_a.inverse();
  const Vec3 direction = back.rotation * out;
  RayHit hit;
  const Seen seen = cast_budgeted_ray(other, back * point, direction, farthest * size, spending, hit);
  if (seen == Seen::unknown && spending.may_make_contacts())
    return pair.corners.note_none();  // it takes too many nodes
  if (seen == Seen::unknown) return;
  const double cosine = seen == Seen::surface ? facing(other, hit.triangle, direction) : 0.0;
  // From outside a solid the ray comes to its surface from the front. A sheet has no inside.
  if (!((other.is_solid() ? cosine : std::abs(cosine)) > tolerances::same_contact_side)) {
    return pair.corners.note_none();
  }
  Contact contact;
  contact.position = point + 0.5 * hit.distance * out;
  contact.normal = normal;
  contact.depth = hit.distance;
  contact.triangle_a = sought.of_b ? hit.triangle : triangle;
  contact.triangle_b = sought.of_b ? triangle : hit.triangle;
  pair.corners.add(contact, pose_b_in_a, size);
}

/// Of gears, of a bolt in its nut, each run sees other places, which push elsewhere: they need the guesses.
bool wants_corner(const Pair::Implementation& pair) noexcept {
  return pair.corners.is_due() && !pair.corners.normal().isZero() && pair.haste.is_unanimous();
}

}  // namespace

bool look_for_corner(const math::Pose& pose_b_in_a, Pair::Implementation& pair, Spending& spending) noexcept {
  CornerContacts& corners = pair.corners;
  if (!wants_corner(pair)) return false;
  spending.reserve_for_contacts(pair.endings.ray);
  if (!(spending.left_us() > enough_to_look_us) || !spending.may_make_contacts()) return false;
  corners.note_look();
  if (!corners.sought()) {
    const bool of_b =
        pair.size_b < smaller * pair.size_a || (smaller * pair.size_b <= pair.size_a && corners.turns_to_b());
    const std::uint32_t corner = farthest_corner(sought_of(of_b, pose_b_in_a, pair), *pair.wide, spending);
    if (corner == no_feature) {
      corners.note_none();
      return true;
    }
    corners.note_sought({corner, of_b});
  }
  if (spending.may_make_contacts()) measure(*corners.sought(), pose_b_in_a, pair, spending);
  return true;
}

void support_by_corners(const math::Pose& pose_b_in_a, const Request& request, Pair::Implementation& pair,
                        Spending& spending) noexcept {
  CornerContacts& corners = pair.corners;
  if (!corners.has_looked()) {
    const bool one_way = push_one_way(pair.answer.contacts);
    corners.note_normal(one_way ? Vec3(pair.answer.contacts.front().normal) : Vec3(Vec3::Zero()));
    look_for_corner(pose_b_in_a, pair, spending);
  }
  if (corners.empty()) return;
  const double size = smaller_size(pair);
  const std::span<Contact> room = room_for_contacts(request, pair);
  const std::size_t count =
      corners.put_before(room, pair.answer.contacts.size(), pose_b_in_a, size, tolerances::hasty_spacing * size);
  pair.answer.contacts = room.first(count);
  if (pair.answer.contact_pairs == 0) pair.answer.contact_pairs = static_cast<std::uint32_t>(count);
}

}  // namespace odds::query
