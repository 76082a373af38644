#include "ode/geom/held_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "odds/math/motion.hpp"

namespace odds::ode {

std::span<const query::Contact> HeldContacts::best_of(const query::Answer& answer, const math::Pose& b_in_a,
                                                      double size) noexcept {
  if (answer.basis == query::Basis::proved && answer.contacts_complete) {
    note_all(answer.contacts, b_in_a, size);
    return answer.contacts;
  }
  const std::span<const query::Contact> still_held =
      at(b_in_a, size, answer.contacts.empty() ? most_slip_undecided : most_slip);
  const bool measured = answer.contacts_late || answer.contacts_flush;
  const bool rough = !measured && answer.contact_pairs < enough_pairs;
  if (answer.contacts.empty() || (rough && better_than_rough() && !still_held.empty())) return still_held;
  if (rough && !still_held.empty()) {
    add(answer.contacts, b_in_a, size, {});
    return at(b_in_a, size);
  }
  keep(answer.contacts, b_in_a, !rough, false);
  return answer.contacts;
}

// Bodies at rest hop: what is apart now by less than a hop touches in the same places again.
void HeldContacts::note_all(std::span<const query::Contact> found, const math::Pose& b_in_a, double size) noexcept {
  if (!found.empty()) return keep(found, b_in_a, true, true);
  static_cast<void>(at(b_in_a, size));
  note_apart(b_in_a);
}

std::span<const query::Contact> HeldContacts::with_all(std::span<const query::Contact> found, const math::Pose& b_in_a,
                                                       double size) noexcept {
  const HeldContacts before = *this;
  note_all(found, b_in_a, size);
  add_apart(before, b_in_a, size);
  return found;
}

std::span<const query::Contact> HeldContacts::with_part(std::span<const query::Contact> found, const math::Pose& b_in_a,
                                                        double size, const StillMeets& meets) noexcept {
  const std::span<const query::Contact> still_held = at(b_in_a, size, found.empty() ? most_slip_undecided : most_slip);
  if (found.empty()) return still_held;
  if (still_held.empty()) {
    keep(found, b_in_a, false, false);
    return found;
  }
  add(found, b_in_a, size, meets);
  return at(b_in_a, size);
}

/// A few pairs of triangles, of whose rim each run finds others: what they touched is kept beside what they touch now
/// (a persistent manifold), the nearest one's place is taken where there are as many as can be. What pushes where none
/// of those found now does was a wrong guess, or is another side; and what no run has found for a while is gone, unless
/// it is known to be there: a body that stands on it would sink in until it is found again. But what was made with care
/// stays while the bodies have hardly moved, and nothing has come deeper beside it than they have moved there since.
void HeldContacts::add(std::span<const query::Contact> found, const math::Pose& b_in_a, double size,
                       const StillMeets& meets) noexcept {
  const bool trusted = is_trusted(b_in_a, size);
  bool has_asked = false;
  const auto lives_on = [&](std::size_t i) {
    if (added_[i] < most_added) return true;
    if (meets.ask == nullptr) return false;
    if (has_asked) return true;  // until the next run
    has_asked = true;
    const double gap = std::max(-held_[i].parted(b_in_a).depth, 0.0) + rest * size;
    if (!meets.ask(meets.self, held_[i].triangle_a(), gap * held_[i].normal())) return false;
    added_[i] = 0;
    return true;
  };
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const Vec3 normal = held_[i].at(b_in_a).normal;
    const bool supported =
        std::any_of(found.begin(), found.end(), [&](const auto& f) { return f.normal.dot(normal) > same_side; });
    const bool stays = trusted && complete_[i];
    if (!stays && !(supported && lives_on(i))) continue;
    move(i, kept);
    if (!stays) ++added_[kept];
    ++kept;
  }
  count_ = kept;
  for (query::Contact contact : found) {
    if (!contact.position.allFinite() || !contact.normal.allFinite() || !std::isfinite(contact.depth)) continue;
    if (trusted) {
      const Vec3 moved = contact.position - complete_at_ * (b_in_a.inverse() * contact.position);
      contact.depth = std::min(contact.depth, contact.normal.dot(moved));
      if (!(contact.depth > 0.0)) continue;
      if (!agrees(contact.normal, b_in_a)) contact.depth = 0.0;
    }
    add_one(contact, trusted, b_in_a, size);
  }
  made_at_ = b_in_a;
  careful_ = false;
}

void HeldContacts::add_one(const query::Contact& contact, bool trusted, const math::Pose& b_in_a,
                           double size) noexcept {
  std::size_t place = count_;
  double least = count_ < most ? same_place * size : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count_; ++i) {
    const double distance = (held_[i].at(b_in_a).position - contact.position).norm();
    const bool stays = trusted && complete_[i];
    if (stays && distance < same_place * size) return;
    if (stays || distance >= least) continue;
    least = distance;
    place = i;
  }
  if (place == most) place = shallowest_above(contact.depth, b_in_a);
  if (place == most) return;
  held_[place] = query::HeldContact(contact, b_in_a);
  normals_on_b_[place] = b_in_a.rotation.transpose() * contact.normal;
  complete_[place] = false;
  added_[place] = 0;
  count_ = std::max(count_, place + 1);
}

// What was made with care on one side only must not keep out what the other side sinks into.
std::size_t HeldContacts::shallowest_above(double depth, const math::Pose& b_in_a) const noexcept {
  std::size_t shallowest = most;
  for (std::size_t i = 0; i < count_; ++i) {
    const double own = held_[i].parted(b_in_a).depth;
    if (!(own < depth)) continue;
    depth = own;
    shallowest = i;
  }
  return shallowest;
}

bool HeldContacts::is_trusted(const math::Pose& b_in_a, double size) const noexcept {
  return std::any_of(complete_.begin(), complete_.begin() + static_cast<std::ptrdiff_t>(count_),
                     [](bool careful) { return careful; }) &&
         math::motion_bound_about(held_[0].on_b(), complete_at_, b_in_a, size) <= most_trusted * size;
}

bool HeldContacts::agrees(const Vec3& normal, const math::Pose& b_in_a) const noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    if (complete_[i] && held_[i].at(b_in_a).normal.dot(normal) > same_side) return true;
  }
  return false;
}

void HeldContacts::move(std::size_t from, std::size_t to) noexcept {
  held_[to] = held_[from];
  normals_on_b_[to] = normals_on_b_[from];
  added_[to] = added_[from];
  complete_[to] = complete_[from];
}

void HeldContacts::note_apart(const math::Pose& b_in_a) noexcept {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    if (!(held_[i].parted(b_in_a).depth > 0.0)) move(i, kept++);
  }
  count_ = kept;
}

void HeldContacts::add_apart(const HeldContacts& before, const math::Pose& b_in_a, double size) noexcept {
  for (std::size_t i = 0; i < before.count_ && count_ < most; ++i) {
    const auto [depth, slip] = before.held_[i].parted(b_in_a);
    if (depth > 0.0 || depth < -most_gap * size || slip > most_slip * size) continue;
    const Vec3 place = before.held_[i].at(b_in_a).position;
    const auto is_there = [&](const query::HeldContact& held) {
      return (held.at(b_in_a).position - place).norm() < same_place * size;
    };
    if (std::any_of(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(count_), is_there)) continue;
    held_[count_] = before.held_[i];
    normals_on_b_[count_] = before.normals_on_b_[i];
    complete_[count_] = false;
    added_[count_] = before.added_[i];
    ++count_;
  }
}

void HeldContacts::keep(std::span<const query::Contact> found, const math::Pose& b_in_a, bool careful,
                        bool complete) noexcept {
  count_ = std::min(found.size(), most);
  for (std::size_t i = 0; i < count_; ++i) {
    held_[i] = query::HeldContact(found[i], b_in_a);
    normals_on_b_[i] = b_in_a.rotation.transpose() * found[i].normal;
  }
  added_.fill(0);
  made_at_ = b_in_a;
  complete_.fill(complete);
  complete_at_ = b_in_a;
  careful_ = careful;
  runs_ = 0;
}

std::span<const query::Contact> HeldContacts::at(const math::Pose& b_in_a, double size, double most_slid) noexcept {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const query::HeldContact held = held_[i];
    const auto [depth, slip] = held.parted(b_in_a);
    const bool is_near = depth >= -most_gap * size && depth - held.depth() <= most_come * size;
    // One that is turned over has its normal in A's frame, but may be of B's surface.
    const bool is_turned = !(held.normal().dot(b_in_a.rotation * normals_on_b_[i]) > same_side);
    if (!(slip <= most_slid * size && is_near) || is_turned) continue;
    touching_[kept] = held.at(b_in_a);
    move(i, kept++);
  }
  count_ = kept;
  rests_ = kept > 0 && math::motion_bound_about(held_[0].on_b(), made_at_, b_in_a, size) <= rest * size;
  runs_ = std::min(runs_ + 1, most_runs + 1);
  std::sort(touching_.begin(), touching_.begin() + static_cast<std::ptrdiff_t>(kept),
            [](const query::Contact& x, const query::Contact& y) { return x.depth > y.depth; });
  return {touching_.data(), kept};
}

}  // namespace odds::ode
