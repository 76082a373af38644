#include "odds/query/pair.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "odds/math/tolerances.hpp"
#include "query/answer_odds/likeliest_place.hpp"
#include "query/answer_odds/odds_for.hpp"
#include "query/answer_odds/way_apart.hpp"
#include "query/contacts/flush_answer.hpp"
#include "query/contacts/pair_contacts.hpp"
#include "query/contacts/short_budget.hpp"
#include "query/memory/near_contacts.hpp"
#include "query/memory/pair_memory.hpp"
#include "query/pair/pair_within.hpp"
#include "query/pair/witness.hpp"
#include "query/search/search.hpp"
#include "query/shape_data.hpp"

namespace odds::query {

namespace {

/// A pose or request that no query can be run with: answered as undecided, never as a NaN.
Answer refused() noexcept {
  Answer answer;
  answer.basis = Basis::budget;
  answer.probability = 0.5;
  return answer;
}

/// The order in which a search looks for an answer. Only one from the roots, the likeliest pair first, may end on
/// probability.
Method order_of(const Request& request) noexcept {
  if (request.polygon_free) return Method::time_critical;
  if (request.method == Method::exact) return Method::exact;
  return request.p_min < 1.0 ? Method::time_critical : request.method;
}

template <volume::BoundingVolume V>
SearchResult search(const Encounter<V>& encounter, const PosedMeshes&, const Request& request, BucketQueue* queue,
                    Pair::Implementation& pair, Spending& spending) noexcept {
  SearchResult result;
  if (encounter.far_apart()) return result;
  Method order = order_of(request);
  if (order == Method::incremental && request.budget.is_limited() && pair.slice.pauses()) order = Method::time_critical;
  // Pairs of triangles that met before may have taken all units.
  if (!spending.allows(1) || (pieces_are_long<V> && !spending.may_go_on())) {
    result.method = order;
    result.ended = Progressed::spent;
    consider(result, {0, 0, encounter.rank(0, 0)});
    return result;
  }
  spending.spend_node_pairs(1);
  if (!encounter.volumes_overlap(0, 0)) return result;
  const std::uint32_t wanted = wanted_hits(request, pair);
  if (order == Method::exact) {
    result.method = Method::exact;
    search_depth_first(encounter, {0, 0, 0.0F}, wanted, pair.hits, spending, result);
    return result;
  }
  if (order == Method::incremental) {
    result.method = Method::incremental;
    pair.slice.search(encounter, wanted, pair.hits, spending, result);
    remember_witness(pair);
    return result;
  }
  return TimeCriticalSearch<V>(encounter, request, wanted, *queue, pair.hits, spending).run({0, 0, 0.0F});
}

/// Whether searches from the roots are tried. Shorter budgets find next to nothing from there, and keep the front; but
/// where contacts come late, from work that a search leaves time for, it pays down to a few microseconds: a front that
/// has nearly all expired takes all of them, as of gears, or of a bolt in its nut.
[[nodiscard]] bool may_search_from_roots(const Request& request, const Pair::Implementation& pair) noexcept {
  constexpr double least_us = 4.0;
  return wide::is_enough_from_roots(request.budget) ||
         (request.budget.microseconds >= least_us && is_short(request, pair));
}

/// Whether a search that the budget ends is gone on with in the next run. Contacts of a bolt in its nut have to be from
/// all around, as a search that begins anew finds them. Of bodies of which nothing is known yet, a search may never
/// come to where they meet.
[[nodiscard]] bool may_go_on_next_run(const Pair::Implementation& pair) noexcept {
  const bool in_one_place = pair.haste.spread.metres() <= tolerances::one_place * smaller_size(pair);
  return in_one_place || pair.haste.is_unanimous();
}

/// The incremental search of the wide engine, or one from the roots where that is better.
void search_from_front(wide::Task& task, const math::Pose& pose, Pair::Implementation& pair) noexcept {
  const Spending& spending = task.spending;
  const math::Reaches reaches{task.encounter.a().reach(), task.encounter.b().reach()};
  const bool may_choose = may_search_from_roots(task.request, pair);
  const Cost before = spending.so_far();
  if (is_short(task.request, pair) && may_go_on_next_run(pair)) task.sweep = &pair.sweep;
  const auto work = [&] { return wide::Work::between(before, spending.so_far()); };
  if (may_choose && pair.front_worth.prefers_roots(pose, reaches.b, task.request.budget.is_limited())) {
    pair.wide->exact(task);
    return pair.front_worth.note_roots(work(), task.result.ended != Progressed::spent);
  }
  task.result.method = Method::incremental;
  if (may_choose && pair.front_worth.is_stale()) pair.front.restart();
  pair.front.move_to(pose, reaches);
  task.sample = task.wanted;
  if (task.wanted > 1) task.wanted = no_feature;
  const bool is_new = pair.front.size() == 1;
  pair.wide->incremental(task, pair.front);
  if (may_choose) pair.front_worth.note_front(work(), pair.front.size(), is_new, pair.front.last());
}

SearchResult search(const wide::Encounter& encounter, const PosedMeshes& meshes, const Request& request,
                    BucketQueue* queue, Pair::Implementation& pair, Spending& spending) noexcept {
  SearchResult result;
  if (encounter.far_apart()) return result;
  const std::uint32_t wanted = wanted_hits(request, pair);
  wide::Task task{encounter, request, wanted, queue, pair.hits, spending, result};
  const Method order = order_of(request);
  if (order == Method::exact) {
    pair.wide->exact(task);
    return result;
  }
  if (order == Method::time_critical) {
    pair.wide->time_critical(task);
    return result;
  }
  search_from_front(task, meshes.pose(), pair);
  remember_witness(pair);
  return result;
}

/// Whether a search borrows what it may push pairs into, and contacts are made in: not at the end of its time, when no
/// cache knows where that is.
template <volume::BoundingVolume V>
bool borrows_first(const Encounter<V>&, const Request&) noexcept {
  return true;
}
bool borrows_first(const wide::Encounter&, const Request& request) noexcept {
  return request.p_min < 1.0 || request.polygon_free ||
         (request.max_contacts > 0 && std::isfinite(request.budget.microseconds));
}

/// Verdict, basis and probability from what the search found; `undecided_probability` is that of a hit where it left
/// pairs undecided.
void judge(const SearchResult& result, double undecided_probability, bool any_hit, Answer& answer) noexcept {
  if (any_hit) {
    answer.verdict = Verdict::hit;
    answer.basis = Basis::proved;
    answer.probability = 1.0;
  } else if (result.estimated_hit) {
    answer.basis = Basis::estimated;
    // Below one half, the caller's threshold has it that they meet.
    answer.probability = std::max(static_cast<double>(result.estimate), 0.5);
  } else if (result.ended == Progressed::spent || !result.shortlist.empty()) {
    answer.basis = result.ended == Progressed::spent ? Basis::budget : Basis::estimated;
    answer.probability = undecided_probability;
  } else {
    answer.basis = Basis::proved;
    answer.probability = 0.0;
  }
  if (answer.basis != Basis::proved) {
    // Certainty belongs to proofs alone.
    answer.probability =
        std::clamp(answer.probability, tolerances::least_uncertainty, 1.0 - tolerances::least_uncertainty);
    answer.verdict = answer.probability >= 0.5 ? Verdict::hit : Verdict::clear;
  }
}

template <volume::BoundingVolume V>
Encounter<V> encounter_of(const tree::Hierarchy<V>& a, const tree::Hierarchy<V>& b, const PosedMeshes& meshes,
                          const Request& request) noexcept {
  return Encounter<V>(a, b, meshes.pose(), request);
}

wide::Encounter encounter_of(const tree::WideTree& a, const tree::WideTree& b, const PosedMeshes& meshes,
                             const Request& request) noexcept {
  return wide::Encounter(a, b, meshes, request.estimator);
}

/// Verdict, probability and place from what the search left undecided, if it did.
template <class Met>
void forecast(const Met& met, const math::Pose& pose_b_in_a, const SearchResult& result, const Request& request,
              const Spending& spending, Pair::Implementation& pair) noexcept {
  Answer& answer = pair.answer;
  for (const NodePair& open : result.shortlist) met.prefetch(open);
  double undecided = 0.5;  // of a hit; even odds if nothing is known of what is open
  float cell_probability = 0.0F;
  if (!result.shortlist.empty() && pair.hits.empty()) {
    const NodePair& likeliest = result.shortlist.highest();
    const AnswerOdds& odds = odds_for(pair.a->volume(), request.estimator, result.method, request.polygon_free);
    cell_probability = met.probability(likeliest.a, likeliest.b);
    undecided =
        probability_of_hit(odds, remains_of(met, result, spending.so_far(), cell_probability, request.polygon_free));
    if (!request.polygon_free) undecided = pair.recalibration(undecided);  // learnt with polygons
  }
  judge(result, undecided, !pair.hits.empty(), answer);
  if (answer.basis == Basis::proved || result.shortlist.empty()) return;
  answer.has_cell_pair = true;
  const auto apart = [&]() noexcept {
    return pair.previous_normal.isZero() ? way_apart(pair.a->mesh(), pair.b->mesh(), pose_b_in_a)
                                         : WayApart{pair.previous_normal, 0.0};
  };
  const bool both_solid = pair.a->is_solid() && pair.b->is_solid();
  answer.cell_pair = likeliest_place(met, result.shortlist, answer.probability, both_solid, apart);
  answer.cell_pair.position += met.a().origin();
  answer.cell_pair_probability = static_cast<double>(cell_probability);
}

/// How all are known to be apart without a search.
enum class Apart : std::uint8_t { unknown, far, still };

/// `far`: farther than both reach, or their boxes are apart; `still`: they were apart, and have hardly moved since.
template <volume::BoundingVolume V>
Apart known_apart(const tree::Hierarchy<V>&, const tree::Hierarchy<V>&, const PosedMeshes&, const Request&,
                  const Pair::Implementation&) noexcept {
  return Apart::unknown;
}

Apart known_apart(const tree::WideTree& a, const tree::WideTree& b, const PosedMeshes& meshes, const Request& request,
                  const Pair::Implementation& pair) noexcept {
  if (wide::Encounter::are_far_apart(a, b, meshes.pose())) return Apart::far;
  if (order_of(request) == Method::incremental && pair.front.is_apart(meshes.pose(), {a.reach(), b.reach()})) {
    return Apart::still;
  }
  // What met in the run before mostly meets now. Without polygons it is not asked, and of roots that are leaves nothing
  // else tells that they are apart.
  if (pair.has_witness && !request.polygon_free) return Apart::unknown;
  return wide::Encounter::are_roots_apart(a, b, meshes.pose()) ? Apart::far : Apart::unknown;
}

/// Directions are kept in A's frame, but where a small body turns on a large one they stay as they are in that one's:
/// those of one that turns slowly are seen anew before that tells.
void turn_with_larger(const math::Pose& before, const math::Pose& now, Pair::Implementation& pair) noexcept {
  if (pair.size_b <= pair.size_a || !(math::turn_between(before, now) > tolerances::late_turn)) return;
  const Mat3 turned = now.rotation * before.rotation.transpose();
  for (Vec3* direction : {&pair.previous_normal, &pair.came}) *direction = turned * *direction;
  pair.haste.turn(turned);
  pair.corners.turn(turned);
}

/// Bodies that have gone by more than half of the smaller one between two runs may have been anywhere: nothing is known
/// of the sides that they touched before.
void forget_if_elsewhere(const PosedMeshes& meshes, Pair::Implementation& pair) noexcept {
  constexpr double elsewhere = 0.5;
  const math::Pose& now = meshes.pose();
  if (pair.known_at) {
    turn_with_larger(*pair.known_at, now, pair);
    const Vec3 motion = centre_of_smaller(now, pair) - centre_of_smaller(*pair.known_at, pair);
    if (motion.norm() > elsewhere * smaller_size(pair)) {
      pair.came.setZero();
      pair.previous_normal.setZero();
      pair.sweep.forget();
      pair.haste.forget();
      pair.corners.forget();
      pair.flush.forget();
      pair.nothing_beside.reset();
      if (!pair.apart_last) pair.apart_at.reset();
    }
  }
  pair.known_at = now;
  pair.apart_last = false;
}

/// What follows a search: contacts, or what is known of bodies that are apart. `patches` to make contacts in.
void conclude(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const math::Reaches& reaches,
              const SearchResult& result, const Request& request, PatchBuilder* patches, Pair::Implementation& pair,
              Spending& spending) noexcept {
  const Answer& answer = pair.answer;
  pair.within_is_of_front = false;
  if (!pair.hits.empty()) pair.within = Within::neither;
  if (!pair.hits.empty() && request.max_contacts > 0) {
    const double most_depth = pair.known_depth.most(meshes.pose(), reaches);
    make_contacts(meshes, pose_b_in_a, result, most_depth, request, *patches, pair, spending);
  } else if (answer.basis == Basis::proved && answer.verdict == Verdict::clear) {
    pair.flush.note_clear();
    if (!answer_within(meshes, pose_b_in_a, request, reaches, false, pair, spending)) {
      note_clear(meshes, pose_b_in_a, request, pair);
    }
    pair.within_is_of_front = pair.within_is_of_front && result.method == Method::incremental;
  } else if (pair.within == Within::neither && answer.contacts.empty()) {
    pair.previous_normal.setZero();
  }
}

template <class Tree>
void search_and_answer(const Tree& a, const Tree& b, const PosedMeshes& meshes, const math::Pose& pose_b_in_a,
                       const Request& request, Pair::Implementation& pair, Spending& spending) noexcept {
  Answer& answer = pair.answer;
  const math::Reaches reaches{a.reach(), b.reach()};
  if (carry_contacts(meshes, pose_b_in_a, request, pair, spending)) return;
  if (carry_late_contacts(meshes, pose_b_in_a, request, pair, spending)) return;
  if (const Apart apart = known_apart(a, b, meshes, request, pair); apart != Apart::unknown) {
    pair.has_witness = false;
    pair.flush.note_clear();
    const bool same = apart == Apart::still && pair.within_is_of_front;
    if (!answer_within(meshes, pose_b_in_a, request, reaches, same, pair, spending)) {
      note_clear(meshes, pose_b_in_a, request, pair);
    }
    pair.within_is_of_front = pair.within_is_of_front && apart == Apart::still;
    return;
  }
  SearchResult result;
  const bool is_witnessed =
      order_of(request) == Method::incremental && witness_suffices(meshes, request, pair, spending);
  if (is_witnessed) {
    result.ended = Progressed::enough;
    result.method = Method::incremental;
    judge(result, 0.5, true, answer);
    // Nothing is worked in.
    if (request.max_contacts == 0) {
      return conclude(meshes, pose_b_in_a, reaches, result, request, nullptr, pair, spending);
    }
  }
  ScratchPool::Loan scratch;
  if (!is_witnessed) {
    const auto encounter = encounter_of(a, b, meshes, request);
    if (borrows_first(encounter, request)) scratch = pair.scratch.borrow();
    result = search(encounter, meshes, request, scratch ? &scratch->queue : nullptr, pair, spending);
    forecast(encounter, pose_b_in_a, result, request, spending, pair);
    if (answer.basis == Basis::budget) judge_by_flat_faces(meshes, request, pair, spending);
  }
  if (!scratch && !pair.hits.empty() && request.max_contacts > 0) scratch = pair.scratch.borrow();
  conclude(meshes, pose_b_in_a, reaches, result, request, scratch ? &scratch->patches : nullptr, pair, spending);
}

/// A hit that the search finds last still wants its contact, a rough one.
std::int64_t last_contact_ns(const Request& request, const EndingReserves& endings) noexcept {
  if (request.max_contacts == 0) return 0;
  if (request.max_contacts == 1) return endings.last.ns();
  return endings.rough.ns() * 2 / 3;  // of pages and triangles that it pays for, the search has just touched some
}

template <class Tree>
void run_on(const Tree& a, const Tree& b, const math::Pose& pose_b_in_a, const Request& request,
            Pair::Implementation& pair) noexcept {
  Spending spending(request.budget,
                    {.search_ns = pair.endings.search.ns(),
                     .contacts_ns = (request.max_contacts > 1 ? pair.endings.rough : pair.endings.single).ns(),
                     .last_contact_ns = last_contact_ns(request, pair.endings),
                     .pieces_are_long = are_pieces_long(pair.a->volume()),
                     .timed = request.timed});
  Answer& answer = pair.answer;
  answer = {};
  pair.hits.clear();
  pair.flush.begin();
  pair.haste_has_begun = false;
  pair.front.begin_run();
  if (pair.late) {
    pair.late->age(pose_b_in_a, smaller_size(pair));
    pair.corners.age(pose_b_in_a, smaller_size(pair));
    // Where guesses push one way, one that is still good leaves the time for a look at corners, or for better contacts.
    if (pair.corners.is_due() && pair.haste.is_unanimous()) pair.late->share_guess();
  }
  const PosedMeshes meshes(pair.a->mesh(), pair.b->mesh(), a.origin(), b.origin(), pose_b_in_a);
  forget_if_elsewhere(meshes, pair);
  search_and_answer(a, b, meshes, pose_b_in_a, request, pair, spending);
  if (request.margin > 0.0) {
    add_near_contacts(pose_b_in_a, request, pair, spending);
  } else {
    pair.near.forget();
  }
  settle_late(request, pair, spending);
  answer.cost = spending.close();
  if (spending.ending_ns() > 0 && pair.hits.empty()) pair.endings.search.note(spending.ending_ns());
}

bool usable(const math::Pose& pose, const Request& request) noexcept {
  return pose.is_rigid(tolerances::pose_orthonormality) && request.budget.microseconds > 0.0 &&
         request.budget.work_units > 0 && request.p_min > 0.0 && request.p_min <= 1.0 && request.k_min >= 1 &&
         request.max_contacts >= 0 && request.margin >= 0.0 && std::isfinite(request.margin) &&
         request.carry_motion >= 0.0 && request.carry_motion <= 1.0;
}

}  // namespace

Pair::Pair(std::unique_ptr<Implementation> implementation) : implementation_(std::move(implementation)) {}
Pair::~Pair() = default;
Pair::Pair(Pair&&) noexcept = default;
Pair& Pair::operator=(Pair&&) noexcept = default;

void run_pair(Pair::Implementation& pair, const math::Pose& pose_b_in_a, const Request& request) noexcept {
  if (!usable(pose_b_in_a, request)) {
    pair.answer = refused();
    pair.hits.clear();
    return;
  }
  if (pair.polygon_free && !request.polygon_free) {
    Request possible = request;
    possible.polygon_free = true;
    return run_pair(pair, pose_b_in_a, possible);
  }
  std::visit(
      [&](const auto& a) {
        using Tree = std::remove_cvref_t<decltype(a)>;
        run_on(a, *std::get_if<Tree>(&pair.b->data().tree), pose_b_in_a, request, pair);
      },
      pair.a->data().tree);
}

const Answer& Pair::run(const math::Pose& pose_b_in_a, const Request& request) noexcept {
  run_pair(*implementation_, pose_b_in_a, request);
  return implementation_->answer;
}

void Pair::note_apart(const math::Pose& pose_b_in_a) noexcept {
  Implementation& pair = *implementation_;
  if (!pose_b_in_a.is_rigid(tolerances::pose_orthonormality)) return;
  std::visit(
      [&](const auto& a) {
        using Tree = std::remove_cvref_t<decltype(a)>;
        const Tree& b = *std::get_if<Tree>(&pair.b->data().tree);
        const PosedMeshes meshes(pair.a->mesh(), pair.b->mesh(), a.origin(), b.origin(), pose_b_in_a);
        note_clear(meshes, pose_b_in_a, {.solids = true}, pair);
        pair.near.forget();
        pair.sweep.forget();
        pair.haste.forget();
        pair.corners.forget();
        pair.flush.forget();
        pair.nothing_beside.reset();
        if (pair.late) pair.late->forget();
        pair.within_is_of_front = false;
      },
      pair.a->data().tree);
}
std::uint32_t Pair::slice_size() const noexcept {
  if (implementation_->a->volume() != volume::Kind::wide) return implementation_->slice.size();
  return std::max(implementation_->front.size(), 1U);
}
std::span<const TrianglePair> Pair::crossings() const noexcept { return implementation_->hits.pairs(); }
const Shape& Pair::a() const noexcept { return *implementation_->a; }
const Shape& Pair::b() const noexcept { return *implementation_->b; }
void Pair::reset() noexcept {
  implementation_->answer = {};
  implementation_->hits.clear();
  implementation_->slice.reset();
  implementation_->front.reset();
  implementation_->front_worth.reset();
  implementation_->previous_normal.setZero();
  implementation_->came.setZero();
  implementation_->apart_at.reset();
  implementation_->known_at.reset();
  implementation_->apart_last = false;
  implementation_->known_depth.forget();
  implementation_->known_direction.forget();
  implementation_->carried.forget();
  implementation_->carried.keep_proofs({});
  implementation_->near.forget();
  implementation_->has_witness = false;
  implementation_->sweep.forget();
  implementation_->haste.forget();
  implementation_->corners.forget();
  implementation_->flush.forget();
  implementation_->nothing_beside.reset();
  implementation_->hasty_runs = 0;
  if (implementation_->late) implementation_->late->forget();
  implementation_->within = Within::neither;
  implementation_->within_is_of_front = false;
}

}  // namespace odds::query
