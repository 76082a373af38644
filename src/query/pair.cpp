#include "odds/query/pair.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>

#include "odds/math/tolerances.hpp"
#include "odds/query/ray.hpp"
#include "query/answer_odds_table.hpp"
#include "query/likeliest_place.hpp"
#include "query/pair_memory.hpp"
#include "query/rough_contacts.hpp"
#include "query/search.hpp"
#include "query/shape_data.hpp"
#include "query/within.hpp"

namespace odds::query {

namespace {

// A pair of triangles in a patch takes 0.3 us, half of it to be found; rays and choice some 25 us whatever their
// number.
constexpr double hits_per_microsecond = 3.0;
constexpr double found_hits_per_microsecond = 6.0;
constexpr double patch_base_us = 25.0;
// Fewer may leave a gap in the rim of even two boxes, and the direction of a patch needs all of its rim.
constexpr double least_hits = 64.0;
constexpr double most_hits = 65536.0;
// What a patch takes from hearing of the deadline to its end: a ray or two, and one made hastily of what there is.
constexpr std::int64_t patch_finish_ns = 6500;
constexpr std::int64_t hasty_finish_ns = 6500;   ///< of one that is hasty from the start
constexpr std::int64_t single_finish_ns = 3000;  ///< of a single contact
constexpr std::int64_t rough_finish_ns = 1500;   ///< of one more rough contact, their direction, and writing the answer
constexpr std::int64_t ray_finish_ns = 2000;  ///< of one ray, and writing the answer
/// What is believed of a shape within another, or without, that there is no time to look at: few pass through a surface
/// from one run to the next.
constexpr double stays_within = 0.9;

/// Pairs of triangles that a patch has time for.
std::uint32_t hits_in(double microseconds, double per_microsecond) noexcept {
  return static_cast<std::uint32_t>(
      std::clamp(per_microsecond * (microseconds - patch_base_us), least_hits, most_hits));
}

/// Hits that are wanted: one proves; a patch takes as many as its making has time for.
std::uint32_t wanted_hits(const Request& request) noexcept {
  if (request.max_contacts <= 1) return 1;
  if (!std::isfinite(request.budget.microseconds)) return no_feature;
  return hits_in(request.budget.microseconds, hits_per_microsecond);
}

/// A pose or request that no query can be run with: answered as undecided, never as a NaN.
Answer refused() noexcept {
  Answer answer;
  answer.basis = Basis::budget;
  answer.probability = 0.5;
  return answer;
}

/// Only a search from the roots, the likeliest pair first, may end on probability.
bool by_probability(const Request& request) noexcept { return request.polygon_free || request.p_min < 1.0; }

/// The witness of the last hit. True: it still is one, and no more are wanted.
bool witness_suffices(const PosedMeshes& meshes, const Request& request, Pair::Implementation& pair,
                      Spending& spending) noexcept {
  if (request.method != Method::incremental || by_probability(request) || wanted_hits(request) != 1 ||
      !pair.has_witness || !spending.allows(1)) {
    return false;
  }
  spending.spend_triangle_pairs(1);
  if (!meshes.meet(pair.witness)) return false;
  pair.hits.add(pair.witness);
  return true;
}

void remember_witness(Pair::Implementation& pair) noexcept {
  pair.has_witness = !pair.hits.empty();
  if (pair.has_witness) pair.witness = pair.hits.pairs().front();
}

/// With less than a dozen looks at it a front finds less than the likeliest pairs do: at 1 us 12 of 19 hard cases are
/// safe without it, and 9 with it.
bool is_enough_for_front(const Budget& budget) noexcept {
  return budget.work_units >= 100 && budget.microseconds >= 5.0;
}

template <volume::BoundingVolume V>
SearchResult search(const Encounter<V>& encounter, const PosedMeshes&, const Request& request,
                    Pair::Implementation& pair, Spending& spending) noexcept {
  SearchResult result;
  if (encounter.far_apart()) return result;
  spending.spend_node_pairs(1);
  if (!encounter.volumes_overlap(0, 0)) return result;
  const std::uint32_t wanted = wanted_hits(request);
  if (request.method == Method::exact && !request.polygon_free) {
    result.method = Method::exact;
    search_depth_first(encounter, {0, 0, 0.0F}, wanted, pair.hits, spending, result);
    return result;
  }
  if (request.method == Method::incremental && !by_probability(request) &&
      !(request.budget.is_limited() && pair.slice.pauses())) {
    result.method = Method::incremental;
    pair.slice.search(encounter, wanted, pair.hits, spending, result);
    remember_witness(pair);
    return result;
  }
  return TimeCriticalSearch<V>(encounter, request, wanted, pair.queue, pair.hits, spending).run({0, 0, 0.0F});
}

SearchResult search(const wide::Encounter& encounter, const PosedMeshes& meshes, const Request& request,
                    Pair::Implementation& pair, Spending& spending) noexcept {
  SearchResult result;
  if (encounter.far_apart()) return result;
  const std::uint32_t wanted = wanted_hits(request);
  wide::Task task{encounter, request, wanted, pair.queue, pair.hits, spending, result};
  if (request.method == Method::exact && !request.polygon_free) {
    result.method = Method::exact;
    pair.wide->depth_first(task, tree::WideTree::root, tree::WideTree::root);
    return result;
  }
  if (request.method == Method::time_critical || by_probability(request)) {
    pair.wide->time_critical(task);
    return result;
  }
  if (!is_enough_for_front(request.budget) || (request.budget.is_limited() && pair.front.pauses())) {
    pair.wide->time_critical(task);
    remember_witness(pair);
    return result;
  }
  result.method = Method::incremental;
  pair.front.move_to(meshes.pose(), encounter.b().reach());
  task.sample = wanted;
  if (wanted > 1) task.wanted = no_feature;
  pair.wide->incremental(task, pair.front);
  remember_witness(pair);
  return result;
}

/// Verdict, basis and probability from what the search found; `undecided_probability` is that of a hit if the budget
/// ended it.
void judge(const SearchResult& result, double undecided_probability, const Request& request, bool any_hit,
           Answer& answer) noexcept {
  if (any_hit) {
    answer.verdict = Verdict::hit;
    answer.basis = Basis::proved;
    answer.probability = 1.0;
  } else if (result.estimated_hit || (request.polygon_free && result.ended == Progressed::finished)) {
    answer.basis = Basis::estimated;
    answer.probability = static_cast<double>(result.estimate);
  } else if (result.ended == Progressed::spent) {
    answer.basis = Basis::budget;
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

/// Casts a ray for the depth inside a rim. A few node visits' worth: a probe that finds nothing in them is left out.
bool probe_depth(const void* shape, const Vec3& origin, const Vec3& direction, double max_distance, double* distance,
                 std::uint32_t* triangle) noexcept {
  constexpr std::uint64_t most_nodes = 96;
  const auto hit = cast_ray(*static_cast<const Shape*>(shape), origin, direction, max_distance, most_nodes);
  if (!hit) return false;
  *distance = hit->distance;
  *triangle = hit->triangle;
  return true;
}

double deepest_of(std::span<const Contact> contacts) noexcept {
  double deepest = 0.0;
  for (const Contact& contact : contacts) deepest = std::max(deepest, contact.depth);
  return deepest;
}

/// The answer's contacts in memory of our own, to be changed.
std::span<Contact> own_contacts(Pair::Implementation& pair) noexcept {
  const std::size_t count = std::min(pair.answer.contacts.size(), pair.rough.size());
  std::copy_n(pair.answer.contacts.begin(), count, pair.rough.begin());
  const std::span<Contact> own = std::span(pair.rough).first(count);
  pair.answer.contacts = own;
  return own;
}

/// From a part of the rim a depth may be anything. What nobody has measured is pushed apart no harder than is known
/// from motion, or than that a body does not sink in.
void limit_to_believed(const PosedMeshes& meshes, Pair::Implementation& pair) noexcept {
  const double smaller = std::min(pair.a->mesh().size(), pair.b->mesh().size());
  const double unmeasured = tolerances::unmeasured_depth * smaller;
  for (Contact& contact : own_contacts(pair)) {
    const Vec3 place = contact.position - meshes.origin_a();
    const double believed = pair.known_depth.believed(place, contact.normal, meshes.pose());
    contact.depth = std::min(contact.depth, std::max(believed, unmeasured));
  }
}

/// Part of the rim may be enough, and yet nothing is deeper than can be.
void limit_depth(double most_depth, Pair::Implementation& pair) noexcept {
  for (Contact& contact : own_contacts(pair)) contact.depth = std::min(contact.depth, most_depth);
}

/// What single pairs of triangles say, when there is no time for a patch.
void make_rough_contacts(const PosedMeshes& meshes, const Vec3* known_normal, const Request& request,
                         Pair::Implementation& pair, Spending& spending) noexcept {
  const Vec3 centre_b = meshes.pose().translation + meshes.origin_a();
  const Vec3 towards_a = pair.previous_normal.isZero() ? Vec3(meshes.origin_a() - centre_b) : pair.previous_normal;
  spending.reserve_for_contacts(rough_finish_ns);
  const auto room =
      std::span(pair.rough).first(std::min(static_cast<std::size_t>(request.max_contacts), pair.rough.size()));
  const std::size_t count = rough_contacts(meshes, pair.hits.pairs(), pair.a->is_solid() && pair.b->is_solid(),
                                           towards_a, known_normal, room, [&] { return spending.may_make_contacts(); });
  pair.answer.contacts = room.first(count);
  limit_to_believed(meshes, pair);
  pair.answer.contacts_complete = false;
  pair.answer.contact_pairs = static_cast<std::uint32_t>(count);
}

/// Along the direction that is known, if any, metres: what was measured and what the bodies have come since, or what
/// nobody need have measured.
double believed_depth(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const Vec3* known_normal,
                      const Pair::Implementation& pair) noexcept {
  const double unmeasured = tolerances::unmeasured_depth * std::min(pair.a->mesh().size(), pair.b->mesh().size());
  if (known_normal == nullptr) return unmeasured;
  const Vec3 place = pair.known_direction.place(pose_b_in_a) - meshes.origin_a();
  return std::max(unmeasured, pair.known_depth.believed(place, *known_normal, meshes.pose()));
}

/// `searched`: how the hits were found; `most_depth`: what is known of the depth, metres.
void make_contacts(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const SearchResult& searched,
                   double most_depth, const Request& request, Pair::Implementation& pair, Spending& spending) noexcept {
  const Progressed ended = searched.ended;
  const Vec3 centre_b = meshes.pose().translation + meshes.origin_a();
  spending.reserve_for_contacts(request.max_contacts > 1 ? hasty_finish_ns : single_finish_ns);
  const double smaller = std::min(pair.a->mesh().size(), pair.b->mesh().size());
  const Vec3* known_normal = pair.known_direction.at(pose_b_in_a, smaller);
  if (!spending.may_make_contacts()) {
    make_rough_contacts(meshes, known_normal, request, pair, spending);
    return;
  }
  if (request.max_contacts > 1) spending.reserve_for_contacts(patch_finish_ns);
  PatchInput input;
  input.hits = pair.hits.pairs();
  input.vertices_a = pair.a->mesh().vertices();
  input.triangles_a = pair.a->mesh().triangles();
  input.vertices_b = pair.b->mesh().vertices();
  input.triangles_b = pair.b->mesh().triangles();
  input.pose_b_in_a = pose_b_in_a;
  input.solid_a = pair.a->is_solid();
  input.solid_b = pair.b->is_solid();
  input.reference_a = meshes.origin_a();
  input.reference_b = centre_b;
  if (!pair.previous_normal.isZero()) {
    input.previous_normal = &pair.previous_normal;
    input.previous_position = &pair.previous_position;
  }
  input.known_normal = known_normal;
  // Other searches stop at as many as there is time for.
  const bool found_all = searched.method == Method::incremental && pair.a->volume() == volume::Kind::wide;
  if (found_all) input.most_pairs = hits_in(spending.left_us(), found_hits_per_microsecond);
  input.max_contacts = request.max_contacts;
  if (request.max_contacts > 1) {  // a single contact is asked for its speed
    input.probe_a = {&probe_depth, pair.a.get()};
    input.probe_b = {&probe_depth, pair.b.get()};
  }
  // As many hits as there was time for are a part of them; as many as were asked for, or as are kept, are what was
  // asked.
  const bool as_many_as_kept =
      pair.hits.size() == pair.hits.capacity() && !(found_all && std::isfinite(request.budget.microseconds));
  const bool part = request.max_contacts > 1 &&
                    ((ended == Progressed::enough && !as_many_as_kept) || pair.hits.size() > input.most_pairs);
  const bool all = ended != Progressed::spent && !part;
  if (!all) input.believed_depth = believed_depth(meshes, pose_b_in_a, known_normal, pair);
  const Deadline deadline{[](void* state) noexcept { return !static_cast<Spending*>(state)->may_make_contacts(); },
                          &spending};
  pair.answer.contacts = pair.patches.build(input, deadline);
  if (pair.answer.contacts.empty()) return;
  pair.answer.contact_pairs = pair.patches.pairs_used();
  pair.answer.contacts_complete = pair.patches.finished() && all;
  // A finished patch of a part of the rim has measured its depth, and errs seldom; a hasty one has not.
  const bool measured = pair.patches.finished() && pair.known_depth.known();
  if (!pair.answer.contacts_complete && !measured) {
    limit_to_believed(meshes, pair);
  } else if (ended != Progressed::finished || part) {
    limit_depth(most_depth, pair);
  }
  if (pair.patches.finished() && request.max_contacts > 1) {
    const Contact& first = pair.answer.contacts.front();
    pair.known_direction.note(first.position, first.normal, pose_b_in_a, smaller, pair.answer.contacts_complete);
  }
  // A part of the rim that pushes nowhere but as those before it did, of bodies that have hardly moved: they rest on
  // it.
  const auto is_known = [known_normal](const Contact& contact) noexcept {
    return contact.normal.dot(*known_normal) > tolerances::same_face;
  };
  const bool rests =
      pair.carried.rests(pair.answer.contacts.front().position, pose_b_in_a, request.carry_motion * smaller, smaller);
  const bool as_known = rests && known_normal != nullptr && pair.patches.finished() &&
                        std::all_of(pair.answer.contacts.begin(), pair.answer.contacts.end(), is_known);
  if (pair.answer.contacts_complete || (as_known && request.max_contacts > 1)) {
    pair.carried.keep(pair.answer.contacts, request.max_contacts, pair.hits.pairs(), pose_b_in_a,
                      pair.answer.contacts_complete ? 0 : pair.answer.contact_pairs);
  }
  if (!pair.answer.contacts_complete) return;
  if (ended == Progressed::finished) pair.known_depth.note(meshes.pose(), deepest_of(pair.answer.contacts));
  pair.previous_normal = pair.answer.contacts.front().normal;
  pair.previous_position = pair.answer.contacts.front().position;
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
void forecast(const Met& met, const SearchResult& result, const Request& request, const Spending& spending,
              Pair::Implementation& pair) noexcept {
  Answer& answer = pair.answer;
  for (const NodePair& open : result.shortlist) met.prefetch(open);
  double undecided = 0.5;  // of a hit; even odds if nothing is known of what is open
  float cell_probability = 0.0F;
  if (!result.shortlist.empty() && pair.hits.empty()) {
    const NodePair& likeliest = result.shortlist.highest();
    const AnswerOdds& odds = answer_odds[odds_index(pair.a->volume(), request.estimator, result.method)];
    cell_probability = met.probability(likeliest.a, likeliest.b);
    undecided =
        pair.recalibration(probability_of_hit(odds, remains_of(met, result, spending.so_far(), cell_probability)));
  }
  judge(result, undecided, request, !pair.hits.empty(), answer);
  if (answer.basis == Basis::proved || result.shortlist.empty()) return;
  answer.has_cell_pair = true;
  answer.cell_pair = likeliest_place(met, result.shortlist, answer.probability);
  answer.cell_pair.position += met.a().origin();
  answer.cell_pair_probability = static_cast<double>(cell_probability);
}

/// The contacts of an earlier run, where the bodies have hardly moved since: false if they will not do.
bool carry_contacts(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const Request& request,
                    Pair::Implementation& pair, Spending& spending) noexcept {
  if (request.max_contacts <= 1 || request.polygon_free) return false;
  const double size = std::min(pair.a->mesh().size(), pair.b->mesh().size());
  if (!pair.carried.serve(pose_b_in_a, request.max_contacts, request.carry_motion * size, size)) return false;
  for (TrianglePair& proof : pair.carried.proofs()) {
    if (!spending.allows(1) || !spending.may_go_on_after(2)) return false;
    spending.spend_triangle_pairs(1);
    if (!meshes.meet(proof)) continue;
    std::swap(proof, pair.carried.proofs().front());  // the next run's first
    pair.hits.add(pair.carried.proofs().front());
    pair.answer.verdict = Verdict::hit;
    pair.answer.probability = 1.0;
    pair.answer.contacts = std::span(pair.rough).first(pair.carried.write(pose_b_in_a, pair.rough));
    pair.answer.contacts_carried = true;
    pair.answer.contacts_complete = pair.carried.part_of() == 0;
    pair.answer.contact_pairs = pair.carried.part_of();
    return true;
  }
  return false;
}

/// Whether all are apart because they were, and have hardly moved since.
template <volume::BoundingVolume V>
bool is_still_apart(const tree::Hierarchy<V>&, const PosedMeshes&, const Request&,
                    const Pair::Implementation&) noexcept {
  return false;
}

bool is_still_apart(const tree::WideTree& b, const PosedMeshes& meshes, const Request& request,
                    const Pair::Implementation& pair) noexcept {
  return request.method == Method::incremental && !by_probability(request) &&
         pair.front.is_apart(meshes.pose(), b.reach());
}

/// No surfaces meet, and, where solids are asked for, neither lies within the other.
void note_clear(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const Request& request,
                Pair::Implementation& pair) noexcept {
  pair.within = Within::neither;
  pair.previous_normal.setZero();
  pair.known_depth.note(meshes.pose(), 0.0);
  if (!request.solids && may_be_within(*pair.a, *pair.b, pose_b_in_a)) pair.known_depth.forget();
}

/// The contact that leads the inner one of two nested shapes out.
void make_way_out(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, double most_depth, bool enters,
                  Pair::Implementation& pair, RayBudget& budget) noexcept {
  std::array<Vec3, 2> preferred;
  std::size_t count = 0;
  if (!pair.previous_normal.isZero()) preferred[count++] = -pair.previous_normal;
  const Vec3 came = pair.known_depth.motion_of(meshes.pose().translation, meshes.pose());
  if (enters && came.norm() > tolerances::resting_motion * pair.a->mesh().size()) preferred[count++] = -came.normalized();
  const std::optional<Contact> out =
      way_out(*pair.a, *pair.b, pose_b_in_a, pair.within, std::span(preferred).first(count), budget);
  pair.answer.contacts_complete = out.has_value();
  if (!out) return;
  Contact& contact = pair.rough.front();
  contact = *out;
  // It cannot be deeper than it has come: a body that was clear a moment ago is not thrown out of a mountain.
  contact.depth = std::min(contact.depth, most_depth);
  pair.answer.contacts = std::span(pair.rough).first(1);
  pair.known_depth.note(meshes.pose(), contact.depth);
  pair.previous_normal = contact.normal;
  pair.previous_position = contact.position;
}

/// Where no surfaces meet, and solids are asked for: whether one shape lies within the other all the same. `same`: no
/// surface has been crossed since `pair.within` was last looked at. False if not; then the answer stands.
bool answer_within(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const Request& request, double reach_b,
                   bool same, Pair::Implementation& pair, Spending& spending) noexcept {
  pair.within_is_of_front = false;
  if (!request.solids || request.polygon_free) return false;
  const bool before = pair.within == Within::b_in_a || pair.within == Within::a_in_b;
  const bool may_be = same ? before : may_be_within(*pair.a, *pair.b, pose_b_in_a);
  pair.within_is_of_front = request.method == Method::incremental;
  if (!may_be) return false;
  Answer& answer = pair.answer;
  spending.reserve_for_contacts(ray_finish_ns);
  const Deadline deadline{[](void* state) noexcept { return !static_cast<Spending*>(state)->may_make_contacts(); },
                          &spending};
  RayBudget budget{deadline, spending.units_left()};
  const Within now = same ? pair.within : within(*pair.a, *pair.b, pose_b_in_a, budget);
  if (now == Within::unknown) {
    pair.within_is_of_front = false;
    answer.basis = Basis::budget;
    answer.probability = before ? stays_within : 1.0 - stays_within;
    answer.verdict = before ? Verdict::hit : Verdict::clear;
  } else {
    pair.within = now;
    if (now != Within::neither) {
      answer.verdict = Verdict::hit;
      answer.probability = 1.0;
      pair.carried.forget();
      if (request.max_contacts > 0) {
        const double most_depth = pair.known_depth.most(meshes.pose(), reach_b);
        make_way_out(meshes, pose_b_in_a, most_depth, !before, pair, budget);
      }
    }
  }
  spending.spend_node_pairs(static_cast<std::uint32_t>(budget.spent));
  return now != Within::neither;
}

template <class Tree>
void run_on(const Tree& a, const Tree& b, const math::Pose& pose_b_in_a, const Request& request,
            Pair::Implementation& pair) noexcept {
  Spending spending(request.budget, pair.ending.ns());
  Answer& answer = pair.answer;
  answer = {};
  pair.hits.clear();
  const PosedMeshes meshes(pair.a->mesh(), pair.b->mesh(), a.origin(), b.origin(), pose_b_in_a);
  if (carry_contacts(meshes, pose_b_in_a, request, pair, spending)) {
    answer.cost = spending.close();
    return;
  }
  if (is_still_apart(b, meshes, request, pair)) {
    pair.has_witness = false;
    if (!answer_within(meshes, pose_b_in_a, request, b.reach(), pair.within_is_of_front, pair, spending)) {
      note_clear(meshes, pose_b_in_a, request, pair);
    }
    answer.cost = spending.close();
    return;
  }
  SearchResult result;
  if (witness_suffices(meshes, request, pair, spending)) {
    result.ended = Progressed::enough;
    result.method = Method::incremental;
    judge(result, 0.5, request, true, answer);
  } else {
    const auto encounter = encounter_of(a, b, meshes, request);
    result = search(encounter, meshes, request, pair, spending);
    forecast(encounter, result, request, spending, pair);
  }
  pair.within_is_of_front = false;
  if (!pair.hits.empty()) pair.within = Within::neither;
  if (!pair.hits.empty() && request.max_contacts > 0) {
    const double most_depth = pair.known_depth.most(meshes.pose(), b.reach());
    make_contacts(meshes, pose_b_in_a, result, most_depth, request, pair, spending);
  } else if (answer.basis == Basis::proved && answer.verdict == Verdict::clear) {
    if (!answer_within(meshes, pose_b_in_a, request, b.reach(), false, pair, spending)) {
      note_clear(meshes, pose_b_in_a, request, pair);
    }
    pair.within_is_of_front = pair.within_is_of_front && result.method == Method::incremental;
  } else if (pair.within == Within::neither) {
    pair.previous_normal.setZero();
  }
  answer.cost = spending.close();
  if (spending.ending_ns() > 0 && pair.hits.empty()) pair.ending.note(spending.ending_ns());
}

bool usable(const math::Pose& pose, const Request& request) noexcept {
  return pose.is_rigid(tolerances::pose_orthonormality) && request.budget.microseconds > 0.0 &&
         request.budget.work_units > 0 && request.p_min > 0.0 && request.p_min <= 1.0 && request.k_min >= 1 &&
         request.max_contacts >= 0 && request.carry_motion >= 0.0 && request.carry_motion <= 1.0;
}

}  // namespace

Result<Pair> Pair::make(std::shared_ptr<const Shape> a, std::shared_ptr<const Shape> b, const PairOptions& options) {
  if (!a || !b) return Error{"", "", "a pair needs two shapes", "build both shapes first"};
  if (a->volume() != b->volume()) {
    return Error{b->mesh().name(), "",
                 "its bounding volume is " + std::string(volume::name(b->volume())) + ", but that of " +
                     a->mesh().name() + " is " + std::string(volume::name(a->volume())),
                 "build both shapes with the same volume"};
  }
  if (options.queue_capacity < 64 || options.queue_capacity > (1U << 20U)) {
    return Error{"", "", "queue_capacity is " + std::to_string(options.queue_capacity), "choose 64 to 1048576"};
  }
  if (options.hit_capacity < 8 || options.hit_capacity > 65536) {
    return Error{"", "", "hit_capacity is " + std::to_string(options.hit_capacity), "choose 8 to 65536"};
  }
  if (options.slice_capacity < 64 || options.slice_capacity > (1U << 24U)) {
    return Error{"", "", "slice_capacity is " + std::to_string(options.slice_capacity), "choose 64 to 16777216"};
  }
  if (options.calibration_poses > 1'000'000) {
    return Error{"", "", "calibration_poses is " + std::to_string(options.calibration_poses), "choose 0 to 1000000"};
  }
  if (wide::searches_for(options.instruction_set) == nullptr) {
    return Error{"", "", "this processor, or this build, lacks the instructions asked for",
                 "choose InstructionSet::best"};
  }
  static_cast<void>(realtime::fastest_clock());  // calibrates now, so that no query has to
  Pair pair(std::make_unique<Implementation>(std::move(a), std::move(b), options));
  // Once through what a query ends with, so that the first real one does not wait for pages of code.
  Request first;
  first.budget = {.microseconds = 1.0, .work_units = 64};
  first.max_contacts = 0;
  static_cast<void>(pair.run({}, first));
  pair.reset();
  if (options.calibration_poses > 0) {
    pair.implementation_->recalibration = learn_recalibration(pair, options.calibration_poses);
    pair.reset();
  }
  return pair;
}

Pair::Pair(std::unique_ptr<Implementation> implementation) : implementation_(std::move(implementation)) {}
Pair::~Pair() = default;
Pair::Pair(Pair&&) noexcept = default;
Pair& Pair::operator=(Pair&&) noexcept = default;

const Answer& Pair::run(const math::Pose& pose_b_in_a, const Request& request) noexcept {
  Implementation& pair = *implementation_;
  if (!usable(pose_b_in_a, request)) {
    pair.answer = refused();
    return pair.answer;
  }
  Request possible = request;
  possible.polygon_free = request.polygon_free || pair.polygon_free;
  std::visit(
      [&](const auto& a) {
        using Tree = std::remove_cvref_t<decltype(a)>;
        run_on(a, *std::get_if<Tree>(&pair.b->data().tree), pose_b_in_a, possible, pair);
      },
      pair.a->data().tree);
  return pair.answer;
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
  implementation_->slice.reset();
  implementation_->front.reset();
  implementation_->previous_normal.setZero();
  implementation_->known_depth.forget();
  implementation_->known_direction.forget();
  implementation_->carried.forget();
  implementation_->has_witness = false;
  implementation_->within = Within::neither;
  implementation_->within_is_of_front = false;
}

}  // namespace odds::query
