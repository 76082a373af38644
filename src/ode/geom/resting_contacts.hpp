// Contacts of a mesh with bodies of ODE that rest against it: carried along, not made anew.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <span>

#include "odds/ode/odds_ode.h"
#include "ode/geom/held_contacts.hpp"
#include "query/known/carried_contacts.hpp"

namespace odds::ode {

/// What one geom with a mesh keeps of its contacts with convex bodies that touched it lately: those of bodies that rest
/// by the rules of query::CarriedContacts, and what a collision that its limit ended falls back on by those of
/// HeldContacts. Of more than `most_partners` the ones that were longest out of use are let go. All in the mesh's
/// frame, metres. Different partners may be asked about in different threads at once. No allocation (about 3 KB a
/// partner).
class RestingContacts {
 public:
  static constexpr std::size_t most_partners = 16;

  /// What a collision asks. Contacts answer the same question only: geoms may be destroyed, and others made at their
  /// addresses, or have their sizes changed.
  struct Question {
    dGeomID partner = nullptr;
    int geom_class = 0;
    std::uint64_t shape = 0;  ///< number of a shape that its class and extents do not tell
    Vec3 half_extents = Vec3::Zero();
    int room = 0;  ///< most contacts

    [[nodiscard]] bool operator==(const Question& other) const noexcept {
      return partner == other.partner && geom_class == other.geom_class && shape == other.shape &&
             half_extents == other.half_extents && room == other.room;
    }
  };

  /// Writes the contacts that are kept, where the body is now, if it has moved by no more than `motion` since they were
  /// made and `meets(triangle)` says of one of their triangles that it still does. Returns their number; 0: they must
  /// be made. `size`: of the smaller body.
  template <class Meets>
  [[nodiscard]] std::size_t write(const Question& question, const math::Pose& body_in_mesh, double motion, double size,
                                  const Meets& meets,
                                  std::span<query::Contact, query::most_contacts> contacts) noexcept {
    const Use use(slot_of(question.partner));
    if (use.slot == nullptr || !(use.slot->question == question)) return 0;
    query::CarriedContacts& carried = use.slot->carried;
    if (!carried.serve(body_in_mesh, question.room, motion, size)) return 0;
    for (query::TrianglePair& proof : carried.proofs()) {
      if (!meets(proof.a)) continue;
      std::swap(proof, carried.proofs().front());  // the next run's first
      use.slot->last_use = next_use();
      return carried.write(body_in_mesh, contacts);
    }
    return 0;
  }

  /// Another number in each collision of a partner that touched lately, and of others at nearly each pose: collisions
  /// that their limit ends must not all look in the same place.
  [[nodiscard]] std::uint32_t turn(const Question& question, const math::Pose& body_in_mesh) noexcept;

  /// Takes note of the contacts that a collision found, and writes those that it is to give: its own if it was
  /// `finished`, else the best of them and of what is held, about which `meets` may be asked. Returns their number.
  /// `size`: of the smaller body.
  [[nodiscard]] std::size_t settle(const Question& question, std::span<const query::Contact> found, bool finished,
                                   const math::Pose& body_in_mesh, double size, const HeldContacts::StillMeets& meets,
                                   std::span<query::Contact, query::most_contacts> contacts) noexcept;

  /// Writes what is held, where the body is now, without a collision. Returns the number.
  [[nodiscard]] std::size_t held(const Question& question, const math::Pose& body_in_mesh, double size,
                                 std::span<query::Contact, query::most_contacts> contacts) noexcept;

 private:
  struct Slot {
    std::atomic<dGeomID> partner{nullptr};  ///< null: free
    std::atomic<bool> busy{false};          ///< in use by a thread
    std::atomic<std::uint64_t> last_use{0};
    Question question;
    query::CarriedContacts carried;
    HeldContacts held;
    double deepest = 0.0;  ///< of the contacts that the last collision gave, metres
    math::Pose deepest_at;
    std::uint32_t turn = 0;
  };

  /// How deep a contact may be that a collision found which did not see all; the last one that is known was there.
  [[nodiscard]] static double believed_depth(const query::Contact& contact, const Slot& slot,
                                             const math::Pose& body_in_mesh, double size) noexcept;

  /// Notes and writes what a collision gives.
  std::size_t give(std::span<const query::Contact> best, const math::Pose& body_in_mesh, Slot& slot,
                   std::span<query::Contact, query::most_contacts> contacts) noexcept;

  /// Holds a slot for this thread; `slot` is null if there is none, or another thread holds it.
  struct Use {
    explicit Use(Slot* wanted) noexcept
        : slot(wanted != nullptr && !wanted->busy.exchange(true, std::memory_order_acquire) ? wanted : nullptr) {}
    ~Use() {
      if (slot != nullptr) slot->busy.store(false, std::memory_order_release);
    }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    Slot* slot;
  };

  [[nodiscard]] Slot* slot_of(dGeomID partner) noexcept;
  [[nodiscard]] Slot& slot_to_fill() noexcept;
  [[nodiscard]] std::uint64_t next_use() noexcept { return uses_.fetch_add(1, std::memory_order_relaxed) + 1; }

  std::array<Slot, most_partners> slots_;
  std::atomic<std::uint64_t> uses_{0};
};

}  // namespace odds::ode
