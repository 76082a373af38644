#include "ode/geom/resting_contacts.hpp"

#include <algorithm>

namespace odds::ode {

RestingContacts::Slot* RestingContacts::slot_of(dGeomID partner) noexcept {
  for (Slot& slot : slots_) {
    if (slot.partner.load(std::memory_order_relaxed) == partner) return &slot;
  }
  return nullptr;
}

/// A free one, or the one that was longest out of use.
RestingContacts::Slot& RestingContacts::slot_to_fill() noexcept {
  const auto age = [](const Slot& slot) noexcept {
    return slot.partner.load(std::memory_order_relaxed) == nullptr ? 0 : slot.last_use.load(std::memory_order_relaxed);
  };
  return *std::min_element(slots_.begin(), slots_.end(),
                           [&age](const Slot& x, const Slot& y) { return age(x) < age(y); });
}

void RestingContacts::keep(const Question& question, std::span<const query::Contact> contacts,
                           const math::Pose& body_in_mesh) noexcept {
  Slot* known = slot_of(question.partner);
  if (known == nullptr && contacts.empty()) return;
  const Use use(known != nullptr ? known : &slot_to_fill());
  if (use.slot == nullptr) return;
  Slot& slot = *use.slot;
  // Between the look and the hold another thread may have filled it.
  if (known != nullptr && slot.partner.load(std::memory_order_relaxed) != question.partner) return;
  if (contacts.empty()) {
    slot.partner.store(nullptr, std::memory_order_relaxed);
    return;
  }
  std::array<query::TrianglePair, query::most_contacts> triangles;
  for (std::size_t i = 0; i < contacts.size(); ++i) triangles[i] = {contacts[i].triangle_a, query::no_feature};
  slot.question = question;
  slot.carried.keep(contacts, question.room, std::span(triangles).first(contacts.size()), body_in_mesh);
  slot.last_use.store(next_use(), std::memory_order_relaxed);
  slot.partner.store(question.partner, std::memory_order_relaxed);
}

}  // namespace odds::ode
