#include "query/contacts/short_budget.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "odds/math/tolerances.hpp"
#include "query/contacts/corner_look.hpp"
#include "query/contacts/flush_answer.hpp"
#include "query/contacts/guess_contacts.hpp"
#include "query/contacts/look_beside.hpp"
#include "query/contacts/pair_contacts.hpp"
#include "query/contacts/rough_contacts.hpp"
#include "query/contacts/slid_contacts.hpp"

namespace odds::query {
namespace {

/// Budgets of less have no time for a patch beside the search.
constexpr double short_us = 50.0;
/// Budgets of less have no time for anything but guesses, also where there is no memory for late contacts.
constexpr double guesses_only_us = 12.0;
/// Of a longer one a guess is made from these hits: the first that are found lie on one side.
constexpr double hits_per_microsecond = 1.0;
constexpr double most_hits = 65536.0;
/// Hits of the work under way that are tried in a run.
constexpr std::size_t most_tried = 4;

/// A search that ends early has found hits on one side only. Some of those of the work under way, which has looked
/// everywhere, still are hits.
void add_hits_of_work(const PosedMeshes& meshes, Pair::Implementation& pair, Spending& spending) noexcept {
  const std::span<const TrianglePair> hits = pair.late->hits();
  for (std::size_t i = 0; i < std::min(most_tried, hits.size()) && spending.may_make_contacts(); ++i) {
    const TrianglePair tried = hits[(i * hits.size() / most_tried + 5 * pair.hasty_runs) % hits.size()];
    const std::span<const TrianglePair> known = pair.hits.pairs();
    const auto is_tried = [&tried](const TrianglePair& other) { return other.a == tried.a && other.b == tried.b; };
    if (std::any_of(known.begin(), known.end(), is_tried)) continue;
    spending.spend_triangle_pairs(1);
    if (meshes.meet(tried)) pair.hits.add(tried);
  }
}

/// The guess of the run before, if it has left no time for the work and will do.
bool share_guess(const math::Pose& pose_b_in_a, const Request& request, Pair::Implementation& pair) noexcept {
  const std::span<Contact> room = room_for_contacts(request, pair);
  const std::size_t written = pair.late->write_guess(pose_b_in_a, smaller_size(pair), room);
  if (written == 0) return false;
  pair.answer.contacts = room.first(written);
  pair.answer.contact_pairs = static_cast<std::uint32_t>(written);
  return true;
}

/// The guess of the run before, or those of many, where a look at corners has left no time for another.
bool serves_last_guess(const math::Pose& pose_b_in_a, const Request& request, Pair::Implementation& pair,
                       Spending& spending) noexcept {
  const bool has_looked = look_for_corner(pose_b_in_a, pair, spending);
  return share_guess(pose_b_in_a, request, pair) || (has_looked && recall_guess(pose_b_in_a, request, pair));
}

/// Whether the contacts of earlier poses are of use now, far as the bodies may have moved. Of a wall that a body has
/// come to since they know nothing.
bool serves_unmeasured(const math::Pose& pose_b_in_a, const Request& request,
                       const Pair::Implementation& pair) noexcept {
  return !pair.flush.something_else_came() &&
         pair.late->manifold().serves(pose_b_in_a, smaller_size(pair), request.margin);
}

/// The same once those that have slid are measured, which waits until the hit is proved.
bool serves_late(const math::Pose& pose_b_in_a, const Request& request, Pair::Implementation& pair,
                 Spending& spending) noexcept {
  if (pair.flush.something_else_came()) return false;
  measure_slid(pose_b_in_a, request, pair, spending);
  return serves_unmeasured(pose_b_in_a, request, pair);
}

/// Those of them that overlap, or have come apart by less than the margin: what two rays would have to find again.
void write_late(const math::Pose& pose_b_in_a, const Request& request, Pair::Implementation& pair) noexcept {
  LateManifold& manifold = pair.late->manifold();
  const std::span<Contact> room = room_for_contacts(request, pair);
  const double size = smaller_size(pair);
  const std::size_t written = manifold.write(pose_b_in_a, size, room, request.margin);
  pair.answer.contacts = room.first(pair.haste.hold_beside(room, written, pose_b_in_a, tolerances::hasty_spacing * size,
                                                           tolerances::unmeasured_depth * size));
  pair.answer.contacts_late = true;
  pair.haste.guessed.forget();  // what is guessed after these begins anew
  pair.answer.contacts_flush = false;
  pair.answer.contact_pairs = manifold.made_from();
}

/// What runs carry from now on while the bodies rest: the contacts that the work has found, or those of flat faces in
/// their place, for both kinds by turns would be as good as a tremor. Only such as are given in full: what is carried
/// pushes at once.
void carry_found(bool is_flush, const math::Pose& pose_b_in_a, const Request& request,
                 Pair::Implementation& pair) noexcept {
  const LateContacts& late = *pair.late;
  if (is_flush) {
    const bool all = late.gives_all() && pair.answer.contacts_flush && pair.flush.gives_all();
    pair.carried.keep(all ? pair.answer.contacts : std::span<const Contact>(), request.max_contacts, late.proofs(),
                      pose_b_in_a);
  } else if (late.gives_all()) {
    pair.carried = late.carried();
  } else {
    pair.carried.keep_proofs(late.proofs());
  }
}

/// For what time is left.
void work(const math::Pose& pose_b_in_a, const Request& request, Pair::Implementation& pair,
          Spending& spending) noexcept {
  if (spending.left_us() * 1e3 < static_cast<double>(pair.endings.late.ns())) {
    pair.endings.late.ease();
    return pair.late->note_starved();
  }
  spending.reserve_for_contacts(pair.endings.late);
  // In a longer budget what rests is asked about as it lies, so that its contacts can be carried.
  const auto press =
      request.budget.microseconds < short_us ? LateContacts::Press::all : LateContacts::Press::what_slides;
  if (!pair.late->work(pose_b_in_a, request, pair, spending, press)) return;
  const bool is_flush = is_all_flush(pair.late->contacts(), pair.late->pose(), true, pair, spending);
  carry_found(is_flush, pose_b_in_a, request, pair);
  if (is_flush || !serves_late(pose_b_in_a, request, pair, spending)) return;
  write_late(pose_b_in_a, request, pair);
  add_flush(request, pair, spending);
}

/// Guesses, and what stands in for them: contacts that were made with care need nothing beside them.
void hold_by_corners(const math::Pose& pose_b_in_a, const Request& request, Pair::Implementation& pair,
                     Spending& spending) noexcept {
  if (!pair.answer.contacts_late && !pair.answer.contacts_flush) {
    support_by_corners(pose_b_in_a, request, pair, spending);
  }
}

/// Contacts of what was found to meet, whatever is known of other places. False: flat faces explain all of it.
bool guess_anew(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const Request& request,
                Pair::Implementation& pair, Spending& spending) noexcept {
  ++pair.hasty_runs;
  spending.reserve_for_contacts(pair.endings.rough);
  if (!guess_contacts(meshes, pose_b_in_a, nullptr, request, pair, spending)) return false;
  pair.late->keep_guess(pair.answer.contacts, pose_b_in_a);
  return true;
}

/// What touches beside flat faces that overlap has contacts of its own at once: those of what a look has found there,
/// or, where that had no time, those found before. False: nothing is known to touch there.
bool answer_beside(Beside seen, const math::Pose& pose_b_in_a, const PosedMeshes& meshes, const Request& request,
                   Pair::Implementation& pair, Spending& spending) noexcept {
  if (seen == Beside::nothing) {
    pair.flush.note_beside(false);
    return false;
  }
  if (seen == Beside::unknown && !pair.flush.something_else_came()) return false;
  begin_haste(meshes, pose_b_in_a, pair);
  if (seen == Beside::something) {
    if (!guess_anew(meshes, pose_b_in_a, request, pair, spending)) return false;
    pair.flush.note_beside(true);
  } else if (!recall_guess(pose_b_in_a, request, pair)) {
    return false;
  }
  add_flush(request, pair, spending);
  return true;
}

/// Those of flat faces, or those made of earlier poses. False: neither serve.
bool answer_carried(Beside seen, const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const Request& request,
                    Pair::Implementation& pair, Spending& spending) noexcept {
  const bool is_flush = pair.flush.serves(seen == Beside::nothing);
  if (!is_flush && !serves_unmeasured(pose_b_in_a, request, pair)) return false;
  begin_haste(meshes, pose_b_in_a, pair);
  if (is_flush) {
    write_flush(meshes, false, request, pair, spending);
    learn_from_work(meshes, pair, spending);
    return true;
  }
  // What has slid over an edge is no contact any more, and may have been all there was.
  if (!serves_late(pose_b_in_a, request, pair, spending)) return false;
  write_late(pose_b_in_a, request, pair);
  add_flush(request, pair, spending);
  return true;
}

/// Whether contacts of this pair are allowed to be late.
bool may_be_late(const Request& request, const Pair::Implementation& pair) noexcept {
  return pair.late != nullptr && request.late_contacts && request.max_contacts > 1 && !request.polygon_free &&
         std::isfinite(request.budget.microseconds) && request.budget.work_units == Budget{}.work_units;
}

}  // namespace

bool is_short(const Request& request, const Pair::Implementation& pair) noexcept {
  if (!may_be_late(request, pair)) return false;
  const double budget_us = request.budget.microseconds;
  return budget_us < guesses_only_us ? pair.late->is_of_use()
                                     : (budget_us < short_us || pair.late->is_wanted()) && pair.late->can_work();
}

void note_unfinished(const Request& request, Pair::Implementation& pair) noexcept {
  if (may_be_late(request, pair)) pair.late->note_unfinished();
}

std::uint32_t hits_of_a_guess(const Request& request, const Pair::Implementation& pair) noexcept {
  if (pair.late->shares_guess()) return 1;
  if (request.budget.microseconds < short_us) return most_contacts;
  return static_cast<std::uint32_t>(std::min(hits_per_microsecond * request.budget.microseconds, most_hits));
}

bool carry_late_contacts(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const Request& request,
                         Pair::Implementation& pair, Spending& spending) noexcept {
  if (!is_short(request, pair)) return false;
  move_flush(pose_b_in_a, false, pair, spending);
  // Where there is never time for work on contacts, only a search sees what else has come to touch.
  if (pair.flush.serves() && request.budget.microseconds < very_short_us && ++pair.hasty_runs % 2 == 0) return false;
  const bool overlap = pair.flush.overlap();
  if (!overlap && !serves_unmeasured(pose_b_in_a, request, pair)) return false;
  const bool proved = prove_carried(meshes, pair, spending);
  Beside seen = Beside::unknown;
  if (overlap && request.budget.microseconds >= very_short_us) seen = look_beside(meshes, request, pair, spending);
  if (!proved && (!overlap || pair.hits.empty())) return false;
  if (!(overlap && answer_beside(seen, pose_b_in_a, meshes, request, pair, spending)) &&
      !answer_carried(seen, meshes, pose_b_in_a, request, pair, spending)) {
    // The hit is proved: a search could only lose the time for its contacts.
    begin_haste(meshes, pose_b_in_a, pair);
    if (guess_anew(meshes, pose_b_in_a, request, pair, spending)) {
      add_flush(request, pair, spending);
    } else if (overlap) {
      write_flush(meshes, false, request, pair, spending);
    }
  }
  pair.answer.contacts_complete = false;
  hold_by_corners(pose_b_in_a, request, pair, spending);
  work(pose_b_in_a, request, pair, spending);
  return true;
}

void settle_late(const Request& request, Pair::Implementation& pair, Spending& spending) noexcept {
  if (pair.late == nullptr) return;
  bool unwanted = false;
  if (!pair.hits.empty()) {
    pair.late->note_hit();
    unwanted = !is_short(request, pair);
  } else if (pair.answer.basis == Basis::proved) {
    unwanted = pair.late->note_clear();
  }
  if (unwanted && pair.late->is_at_work() && spending.left_us() > LateContacts::enough_to_drop_us) pair.late->drop();
}

void make_contacts_over_runs(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const Vec3* known_normal,
                             const Request& request, Pair::Implementation& pair, Spending& spending) noexcept {
  pair.answer.contacts_complete = false;
  ++pair.hasty_runs;
  begin_haste(meshes, pose_b_in_a, pair);
  if (see_flush(meshes, pair, spending)) {
    write_flush(meshes, false, request, pair, spending);
    pair.carried.keep_proofs(pair.hits.pairs());
  } else if (serves_late(pose_b_in_a, request, pair, spending)) {
    write_late(pose_b_in_a, request, pair);
  } else if (!serves_last_guess(pose_b_in_a, request, pair, spending)) {
    spending.reserve_for_contacts(pair.endings.rough);
    add_hits_of_work(meshes, pair, spending);
    guess_contacts(meshes, pose_b_in_a, known_normal, request, pair, spending);
    pair.late->keep_guess(pair.answer.contacts, pose_b_in_a);
  }
  hold_by_corners(pose_b_in_a, request, pair, spending);
  if (!pair.answer.contacts_flush) add_flush(request, pair, spending);
  work(pose_b_in_a, request, pair, spending);
}

}  // namespace odds::query
