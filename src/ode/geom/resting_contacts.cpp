#include "ode/geom/resting_contacts.hpp"

#include <algorithm>
#include <bit>

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

std::uint32_t RestingContacts::turn(const Question& question, const math::Pose& body_in_mesh) noexcept {
  const Use use(slot_of(question.partner));
  if (use.slot != nullptr && use.slot->question == question) return use.slot->turn++;
  std::uint64_t mixed = 0;
  for (const double x : body_in_mesh.translation) {
    mixed = (mixed ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15U;  // 2^64 over the golden ratio
    mixed ^= mixed >> 32U;
  }
  return static_cast<std::uint32_t>(mixed);
}

/// Of a part of the surface the way out may be taken for a longer one; and what was overlooked for a while, and is deep
/// by now, must not throw the body. So it is as deep as the deepest was, and the body has come since, and a little more
/// each time.
double RestingContacts::believed_depth(const query::Contact& contact, const Slot& slot, const math::Pose& body_in_mesh,
                                       double size) noexcept {
  const Vec3 motion = contact.position - slot.deepest_at * (body_in_mesh.inverse() * contact.position);
  if (motion.norm() > HeldContacts::most_trusted * size) return contact.depth;
  const double came = std::max(contact.normal.dot(motion), 0.0);
  return std::min(contact.depth, slot.deepest + came + HeldContacts::rest * size);
}

std::size_t RestingContacts::settle(const Question& question, std::span<const query::Contact> found, bool finished,
                                    const math::Pose& body_in_mesh, double size, const HeldContacts::StillMeets& meets,
                                    std::span<query::Contact, query::most_contacts> contacts) noexcept {
  const auto as_found = [&] {
    std::copy(found.begin(), found.end(), contacts.begin());
    return found.size();
  };
  Slot* const known = slot_of(question.partner);
  if (known == nullptr && found.empty()) return 0;
  const Use use(known != nullptr ? known : &slot_to_fill());
  if (use.slot == nullptr) return as_found();
  Slot& slot = *use.slot;
  // Between the look and the hold another thread may have filled it.
  if (known != nullptr && slot.partner.load(std::memory_order_relaxed) != question.partner) return as_found();
  const bool is_known = known != nullptr && slot.question == question;
  if (!is_known) {
    slot.question = question;
    slot.carried.forget();
    slot.held = HeldContacts();
    slot.turn = 1;
  }
  if (finished) {
    std::array<query::TrianglePair, query::most_contacts> triangles;
    for (std::size_t i = 0; i < found.size(); ++i) triangles[i] = {found[i].triangle_a, query::no_feature};
    slot.carried.keep(found, question.room, std::span(triangles).first(found.size()), body_in_mesh);
  }
  std::array<query::Contact, query::most_contacts> believed;
  std::copy(found.begin(), found.end(), believed.begin());
  const std::span<query::Contact> part = std::span(believed).first(found.size());
  if (!finished && is_known) {
    for (query::Contact& contact : part) contact.depth = believed_depth(contact, slot, body_in_mesh, size);
  }
  const std::span<const query::Contact> best =
      finished ? slot.held.with_all(found, body_in_mesh, size) : slot.held.with_part(part, body_in_mesh, size, meets);
  slot.partner.store(best.empty() && slot.held.is_empty() ? nullptr : question.partner, std::memory_order_relaxed);
  return give(best, body_in_mesh, slot, contacts);
}

std::size_t RestingContacts::held(const Question& question, const math::Pose& body_in_mesh, double size,
                                  std::span<query::Contact, query::most_contacts> contacts) noexcept {
  const Use use(slot_of(question.partner));
  if (use.slot == nullptr || !(use.slot->question == question)) return 0;
  return give(use.slot->held.at(body_in_mesh, size), body_in_mesh, *use.slot, contacts);
}

std::size_t RestingContacts::give(std::span<const query::Contact> best, const math::Pose& body_in_mesh, Slot& slot,
                                  std::span<query::Contact, query::most_contacts> contacts) noexcept {
  const std::size_t count = std::min(best.size(), static_cast<std::size_t>(slot.question.room));
  std::copy_n(best.begin(), count, contacts.begin());
  slot.deepest_at = body_in_mesh;
  slot.deepest = 0.0;
  for (const query::Contact& contact : best) slot.deepest = std::max(slot.deepest, contact.depth);
  slot.last_use.store(next_use(), std::memory_order_relaxed);
  return count;
}

}  // namespace odds::ode
