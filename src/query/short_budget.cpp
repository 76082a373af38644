#include "query/short_budget.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "odds/math/tolerances.hpp"
#include "query/flush_answer.hpp"
#include "query/pair_contacts.hpp"
#include "query/rough_contacts.hpp"
#include "query/slid_contacts.hpp"

namespace odds::query {
namespace {

/// Budgets of less have no time for a patch beside the search.
constexpr double short_us = 50.0;
/// Of a longer one a guess is made from these hits: the first that are found lie on one side.
constexpr double hits_per_microsecond = 1.0;
constexpr double most_hits = 65536.0;
/// Of what a run has left, for a guess; the rest is for the work on contacts.
constexpr double share_of_a_guess = 0.5;
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

/// Some of the pair's hits, others in each run, spread over their list, as they cross.
struct Sample {
  std::array<Crossing, most_contacts> crossings;
  std::array<TrianglePair, most_contacts> hits;
  std::size_t count = 0;

  [[nodiscard]] std::span<const Crossing> made() const noexcept { return std::span(crossings).first(count); }
};

template <class MayGoOn>
Sample sample_of(const PosedMeshes& meshes, std::span<const TrianglePair> hits, std::size_t first,
                 MayGoOn may_go_on) noexcept {
  Sample sample;
  const std::size_t most = std::min(hits.size(), sample.hits.size());
  // First those that are far apart in the list: if time is short, they are all there is.
  constexpr std::array<std::size_t, most_contacts> eighths{0, 4, 2, 6, 1, 5, 3, 7};
  for (const std::size_t eighth : eighths) {
    if (eighth >= most) continue;
    if (sample.count > 0 && !may_go_on()) break;
    sample.hits[sample.count] = hits[(eighth * hits.size() / most + first) % hits.size()];
    sample.crossings[sample.count] = Crossing::of(meshes, sample.hits[sample.count]);
    ++sample.count;
  }
  return sample;
}

/// What a crossing says of the direction in which the bodies part.
class Judge {
 public:
  /// `anew`: whatever is known of other places.
  Judge(const PosedMeshes& meshes, const Pair::Implementation& pair, bool anew) noexcept
      : both_solid_(pair.a->is_solid() && pair.b->is_solid()),
        expected_(anew ? Vec3(Vec3::Zero()) : pair.previous_normal),
        little_(tolerances::hasty_alike * smaller_size(pair)) {
    const Vec3 by_place = (-meshes.pose().translation).stableNormalized();
    towards_a_ = expected_.isZero() ? Vec3(by_place + tolerances::came_side * pair.came) : expected_;
  }

  [[nodiscard]] Vote vote_of(const Crossing& crossing) const noexcept {
    const Vec3 by_b = turned(crossing.normal_b);
    const Vec3 by_a = turned(-crossing.normal_a);
    return Vote::of(-by_a, by_b, crossing.overlap_along(by_a), crossing.overlap_along(by_b),
                    (crossing.segment.end - crossing.segment.begin).norm(), little_, expected_);
  }
  [[nodiscard]] Vec3 direction_of(std::span<const Crossing> made, const HastyMemory& memory) const noexcept {
    const Vec3 guess = memory.has_seen() && memory.is_of_one_mind() ? memory.direction()
                                                                    : rough_direction(made, both_solid_, towards_a_);
    return snapped_to_face(made, both_solid_, guess);
  }

 private:
  /// Surfaces of a body that is not solid have two sides.
  [[nodiscard]] Vec3 turned(const Vec3& normal) const noexcept {
    return !both_solid_ && normal.dot(towards_a_) < 0.0 ? Vec3(-normal) : normal;
  }

  bool both_solid_;
  Vec3 expected_;
  double little_;
  Vec3 towards_a_;
};

/// What flat faces that lie on each other do not explain. A body that slides along a wall may come down on the floor:
/// they are learnt from every place that is seen.
void leave_out_flush(const PosedMeshes& meshes, Sample& sample, Pair::Implementation& pair,
                     Spending& spending) noexcept {
  if (!pair.flush.may_be()) return;
  std::size_t left = 0;
  for (std::size_t i = 0; i < sample.count; ++i) {
    const Crossing& crossing = sample.crossings[i];
    if (spending.may_make_contacts() && is_of_flat_faces(meshes, crossing, pair) && pair.flush.overlap()) continue;
    sample.hits[left] = sample.hits[i];
    sample.crossings[left++] = crossing;
  }
  sample.count = left;
}

/// Contacts from single pairs of triangles. They hold, but hardly push: a wrong one moves a body by no more than what
/// nobody need have measured.
void guess_contacts(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const Vec3* known_normal,
                    const Request& request, Pair::Implementation& pair, Spending& spending) noexcept {
  const double kept_us = (1.0 - share_of_a_guess) * spending.left_us();
  Sample sample = sample_of(meshes, pair.hits.pairs(), pair.hasty_runs,
                            [&] { return spending.may_make_contacts() && spending.left_us() >= kept_us; });
  leave_out_flush(meshes, sample, pair, spending);
  pair.answer.contacts = {};
  if (sample.count == 0) return;
  // Beside such faces the rest has a direction of its own, of which nothing is known.
  const bool beside = pair.flush.overlap();
  if (beside) known_normal = nullptr;
  const Judge judge(meshes, pair, beside);
  for (const Crossing& crossing : sample.made()) {
    if (beside) break;
    const Vote vote = judge.vote_of(crossing);
    pair.haste.see(vote.weight * vote.direction, vote.weight);
  }
  const bool each_its_own = !beside && known_normal == nullptr && pair.haste.has_seen() && !pair.haste.is_of_one_mind();
  const Vec3 direction =
      known_normal != nullptr ? *known_normal : judge.direction_of(sample.made(), beside ? HastyMemory() : pair.haste);
  const double size = smaller_size(pair);
  // A corner that has just come through is not deeper than its rim is wide, though the triangles reach on.
  const double most_depth = std::min(tolerances::unmeasured_depth * size, extent_of(sample.made()));
  const std::span<Contact> room = room_for_contacts(request, pair);
  const std::size_t count = std::min(sample.count, room.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Crossing& crossing = sample.crossings[i];
    Vec3 normal = direction;
    if (each_its_own) {
      const Vote vote = judge.vote_of(crossing);
      if (vote.weight > 0.0) normal = vote.direction;
    }
    room[i] = {crossing.middle() + meshes.origin_a(), normal, std::min(most_depth, crossing.overlap_along(normal)),
               sample.hits[i].a, sample.hits[i].b};
  }
  const double near = tolerances::hasty_spacing * size;
  const std::size_t all =
      pair.haste.add_to(room, count, each_its_own || beside ? nullptr : &direction, pose_b_in_a, near);
  double deepest = 0.0;
  for (Contact& contact : room.first(all)) {
    contact.depth = std::min(contact.depth, tolerances::unmeasured_depth * size);
    deepest = std::max(deepest, contact.depth);
  }
  pair.haste.remember(room.first(count), pose_b_in_a, near);
  if (!pair.known_depth.known()) pair.known_depth.note(meshes.pose(), deepest);
  pair.answer.contacts = room.first(all);
  pair.answer.contact_pairs = static_cast<std::uint32_t>(sample.count);
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

void begin_haste(const math::Pose& pose_b_in_a, Pair::Implementation& pair) noexcept {
  const double size = smaller_size(pair);
  pair.haste.begin(pose_b_in_a, tolerances::hasty_slack * size, tolerances::coherent_motion * size);
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

/// Whether contacts of this pair are allowed to be late.
bool may_be_late(const Request& request, const Pair::Implementation& pair) noexcept {
  return pair.late != nullptr && request.late_contacts && request.max_contacts > 1 && !request.polygon_free &&
         std::isfinite(request.budget.microseconds) && request.budget.work_units == Budget{}.work_units;
}

}  // namespace

bool is_short(const Request& request, const Pair::Implementation& pair) noexcept {
  return may_be_late(request, pair) && (request.budget.microseconds < short_us || pair.late->is_wanted()) &&
         pair.late->can_work();
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
  const bool is_flush = pair.flush.serves();
  // Where there is never time for work on contacts, only a search sees what else has come to touch.
  if (is_flush && request.budget.microseconds < very_short_us && ++pair.hasty_runs % 2 == 0) return false;
  if (!is_flush && !serves_unmeasured(pose_b_in_a, request, pair)) return false;
  if (!prove_carried(meshes, pair, spending)) return false;
  begin_haste(pose_b_in_a, pair);
  pair.answer.contacts_complete = false;
  if (is_flush) {
    write_flush(meshes, false, request, pair, spending);
    learn_from_work(meshes, pair, spending);
  } else {
    measure_slid(pose_b_in_a, request, pair, spending);
    write_late(pose_b_in_a, request, pair);
    add_flush(request, pair, spending);
  }
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
  begin_haste(pose_b_in_a, pair);
  if (see_flush(meshes, pair, spending)) {
    write_flush(meshes, false, request, pair, spending);
    pair.carried.keep_proofs(pair.hits.pairs());
  } else if (serves_late(pose_b_in_a, request, pair, spending)) {
    write_late(pose_b_in_a, request, pair);
  } else if (!share_guess(pose_b_in_a, request, pair)) {
    spending.reserve_for_contacts(pair.endings.rough);
    add_hits_of_work(meshes, pair, spending);
    guess_contacts(meshes, pose_b_in_a, known_normal, request, pair, spending);
    pair.late->keep_guess(pair.answer.contacts, pose_b_in_a);
  }
  if (!pair.answer.contacts_flush) add_flush(request, pair, spending);
  work(pose_b_in_a, request, pair, spending);
}

}  // namespace odds::query
