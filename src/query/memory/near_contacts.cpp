#include "query/memory/near_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "odds/math/tolerances.hpp"
#include "query/memory/pair_memory.hpp"
#include "query/ray/budgeted_ray.hpp"

namespace odds::query {
namespace {

struct Gap {
  double length;
  std::uint32_t triangle;
};

/// How far a surface lies from `point` along `direction`, both in the shape's mesh frame: no farther than `margin`, and
/// not slanting. 0 where the point has passed it by no more than that.
std::optional<Gap> gap_to(const Shape& shape, const Vec3& point, const Vec3& direction, double margin,
                          Spending& spending) noexcept {
  RayHit hit;
  // From as far behind the point, which itself is on a surface that the other one may have just come through; but no
  // farther than the shape reaches, for a distance from far away has lost the gap to rounding.
  const double behind = std::min(margin, shape.mesh().size());
  const Vec3 from = point - behind * direction;
  if (cast_budgeted_ray(shape, from, direction, behind + margin, spending, hit) != Seen::surface) return {};
  const double cosine = facing(shape, hit.triangle, direction);
  if (!((shape.is_solid() ? -cosine : std::abs(cosine)) > tolerances::same_contact_side)) return {};
  return Gap{std::max(hit.distance - behind, 0.0), hit.triangle};
}

/// Of what touched a run ago: how near the surfaces are there now, along the normal of then.
std::optional<Contact> contact_across(const HeldContact& touched, const math::Pose& pose_b_in_a, double margin,
                                      const Pair::Implementation& pair, Spending& spending) noexcept {
  Contact contact = touched.at(pose_b_in_a);
  const math::Pose pose_a_in_b = pose_b_in_a.inverse();
  const Vec3 on_b = pose_b_in_a * touched.on_b();
  const auto below =
      gap_to(*pair.b, pose_a_in_b * touched.on_a(), pose_a_in_b.rotation * -contact.normal, margin, spending);
  const auto above = gap_to(*pair.a, on_b, contact.normal, margin, spending);
  if (!below && !above) return {};
  if (below && (!above || below->length <= above->length)) {
    contact.position = touched.on_a() - 0.5 * below->length * contact.normal;
    contact.depth = -below->length;
    contact.triangle_b = below->triangle;
  } else {
    contact.position = on_b + 0.5 * above->length * contact.normal;
    contact.depth = -above->length;
    contact.triangle_a = above->triangle;
  }
  return contact;
}

}  // namespace

void add_near_contacts(const math::Pose& pose_b_in_a, const Request& request, Pair::Implementation& pair,
                       Spending& spending) noexcept {
  Answer& answer = pair.answer;
  if (answer.basis != Basis::proved || request.polygon_free || pair.within == Within::b_in_a ||
      pair.within == Within::a_in_b) {
    pair.near.forget();
    return;
  }
  std::size_t count = answer.contacts.size();
  const std::size_t met = count;
  const std::size_t room = std::min<std::size_t>(static_cast<std::size_t>(request.max_contacts), most_contacts);
  const double near = tolerances::same_contact_place * std::min(pair.a->mesh().size(), pair.b->mesh().size());
  const auto known = [&](const Contact& contact) noexcept {
    const std::span so_far = std::span(pair.contacts).first(count);
    return std::any_of(so_far.begin(), so_far.end(), [&](const Contact& other) noexcept {
      return (other.position - contact.position).norm() < near &&
             other.normal.dot(contact.normal) > tolerances::same_contact_side;
    });
  };
  spending.reserve_for_contacts(pair.endings.ray);
  for (const HeldContact& touched : pair.near.last()) {
    if (count >= room) break;
    if (touched.parted(pose_b_in_a).slip > near || known(touched.at(pose_b_in_a))) continue;
    const auto found = contact_across(touched, pose_b_in_a, request.margin, pair, spending);
    if (found && !known(*found)) pair.contacts[count++] = *found;
  }
  std::sort(pair.contacts.begin() + static_cast<std::ptrdiff_t>(met),
            pair.contacts.begin() + static_cast<std::ptrdiff_t>(count),
            [](const Contact& x, const Contact& y) { return x.depth > y.depth; });
  answer.contacts = std::span(pair.contacts).first(count);
  pair.near.keep(answer.contacts, pose_b_in_a);
}

}  // namespace odds::query
