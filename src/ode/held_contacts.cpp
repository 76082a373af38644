#include "ode/held_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "odds/math/motion.hpp"

namespace odds::ode {

std::span<const query::Contact> HeldContacts::best_of(const query::Answer& answer, const math::Pose& b_in_a,
                                                      double size) noexcept {
  if (answer.basis == query::Basis::proved && answer.contacts_complete) {
    // Bodies at rest hop: what is apart now by less than a hop touches in the same places again.
    if (answer.contacts.empty()) {
      let_go_of_overlaps(b_in_a, size);
    } else {
      keep(answer.contacts, b_in_a, true);
    }
    return answer.contacts;
  }
  const std::span<const query::Contact> still_held =
      at(b_in_a, size, answer.contacts.empty() ? most_slip_undecided : most_slip);
  const bool rough = answer.contact_pairs < enough_pairs;
  if (answer.contacts.empty() || (rough && better_than_rough() && !still_held.empty())) return still_held;
  if (rough && !still_held.empty()) {
    add(answer.contacts, b_in_a, size);
    return at(b_in_a, size);
  }
  keep(answer.contacts, b_in_a, !rough);
  return answer.contacts;
}

/// A few pairs of triangles, of whose rim each run finds others: what they touched is kept beside what they touch now
/// (a persistent manifold), the nearest one's place is taken where there are as many as can be. What pushes where none
/// of those found now does was a wrong guess, or is another side; and what no run has found for a while is gone.
void HeldContacts::add(std::span<const query::Contact> found, const math::Pose& b_in_a, double size) noexcept {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const Vec3 normal = held_[i].at(b_in_a).normal;
    const bool supported =
        std::any_of(found.begin(), found.end(), [&](const auto& f) { return f.normal.dot(normal) > same_side; });
    if (!supported || added_[i] >= most_added) continue;
    held_[kept] = held_[i];
    added_[kept++] = added_[i] + 1;
  }
  count_ = kept;
  for (const query::Contact& contact : found) {
    if (!contact.position.allFinite() || !contact.normal.allFinite() || !std::isfinite(contact.depth)) continue;
    std::size_t nearest = count_ < most ? count_ : 0;
    double least = count_ < most ? same_place * size : std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < count_; ++i) {
      const double distance = (held_[i].at(b_in_a).position - contact.position).norm();
      if (distance < least) {
        least = distance;
        nearest = i;
      }
    }
    held_[nearest] = query::HeldContact(contact, b_in_a);
    added_[nearest] = 0;
    count_ = std::max(count_, nearest + 1);
  }
  made_at_ = b_in_a;
  careful_ = false;
}

/// Bodies that are proved apart: what would overlap by what is held has not gone where its points say.
void HeldContacts::let_go_of_overlaps(const math::Pose& b_in_a, double size) noexcept {
  static_cast<void>(at(b_in_a, size));
  const auto end = std::remove_if(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(count_),
                                  [&](const query::HeldContact& h) { return h.parted(b_in_a).depth > 0.0; });
  count_ = static_cast<std::size_t>(end - held_.begin());
}

void HeldContacts::keep(std::span<const query::Contact> found, const math::Pose& b_in_a, bool careful) noexcept {
  count_ = std::min(found.size(), most);
  for (std::size_t i = 0; i < count_; ++i) held_[i] = query::HeldContact(found[i], b_in_a);
  added_.fill(0);
  made_at_ = b_in_a;
  careful_ = careful;
  runs_ = 0;
}

std::span<const query::Contact> HeldContacts::at(const math::Pose& b_in_a, double size, double most_slid) noexcept {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const query::HeldContact held = held_[i];
    const auto [depth, slip] = held.parted(b_in_a);
    if (!(slip <= most_slid * size && depth >= -most_gap * size)) continue;
    touching_[kept] = held.at(b_in_a);
    added_[kept] = added_[i];
    held_[kept++] = held;
  }
  count_ = kept;
  rests_ = kept > 0 && math::motion_bound_about(held_[0].on_b(), made_at_, b_in_a, size) <= rest * size;
  runs_ = std::min(runs_ + 1, most_runs + 1);
  std::sort(touching_.begin(), touching_.begin() + static_cast<std::ptrdiff_t>(kept),
            [](const query::Contact& x, const query::Contact& y) { return x.depth > y.depth; });
  return {touching_.data(), kept};
}

}  // namespace odds::ode
