// Contacts from the pairs of triangles that a search has found, within what is left of the budget.
#include "query/contacts/pair_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "odds/math/tolerances.hpp"
#include "odds/query/ray.hpp"
#include "query/contacts/direction_about.hpp"
#include "query/contacts/flush_answer.hpp"
#include "query/contacts/rough_contacts.hpp"
#include "query/contacts/short_budget.hpp"
#include "query/patch/one_pair.hpp"

namespace odds::query {
namespace {

// A pair of triangles in a patch takes 0.3 us, half of it to be found; rays and choice up to 15 us whatever their
// number.
constexpr double hits_per_microsecond = 3.0;
constexpr double found_hits_per_microsecond = 6.0;
constexpr double patch_base_us = 15.0;
// Fewer may leave a gap in the rim of even two boxes, and the direction of a patch needs all of its rim.
constexpr double least_hits = 64.0;
constexpr double most_hits = 65536.0;
// For a direction that is looked for in haste, before what is there is written.
constexpr std::int64_t hasty_ns = 2500;
constexpr std::int64_t hasty_single_ns = 1000;
constexpr std::uint32_t pairs_of_a_depth = 12;  ///< a patch of fewer may show anything less than how deep bodies are

/// Pairs of triangles that a patch has time for.
std::uint32_t hits_in(double microseconds, double per_microsecond) noexcept {
  return static_cast<std::uint32_t>(
      std::clamp(per_microsecond * (microseconds - patch_base_us), least_hits, most_hits));
}

/// A few node visits' worth of a ray: a probe that finds nothing in them is left out.
constexpr std::uint64_t most_probe_nodes = 96;

/// Casts a ray for the depth inside a rim.
bool probe_depth(const void* shape, const Vec3& origin, const Vec3& direction, double max_distance, double* distance,
                 std::uint32_t* triangle) noexcept {
  const auto hit = cast_ray(*static_cast<const Shape*>(shape), origin, direction, max_distance, most_probe_nodes);
  if (!hit) return false;
  *distance = hit->distance;
  *triangle = hit->triangle;
  return true;
}

void probe_both_depths(const DepthProbe& a, ProbeRay& ray_a, const DepthProbe& b, ProbeRay& ray_b) noexcept {
  const CountedRay of_a{*static_cast<const Shape*>(a.self), ray_a.origin, ray_a.direction, ray_a.max_distance};
  const CountedRay of_b{*static_cast<const Shape*>(b.self), ray_b.origin, ray_b.direction, ray_b.max_distance};
  const auto hits = cast_two_rays(of_a, of_b, most_probe_nodes);
  const auto note = [](const std::optional<RayHit>& hit, ProbeRay& ray) noexcept {
    ray.found = hit.has_value();
    if (!hit) return;
    ray.distance = hit->distance;
    ray.triangle = hit->triangle;
  };
  note(hits[0], ray_a);
  note(hits[1], ray_b);
}

double deepest_of(std::span<const Contact> contacts) noexcept {
  double deepest = 0.0;
  for (const Contact& contact : contacts) deepest = std::max(deepest, contact.depth);
  return deepest;
}

/// The answer's contacts, to be changed: they stand in the pair's own memory.
std::span<Contact> own_contacts(Pair::Implementation& pair) noexcept {
  return std::span(pair.contacts).first(pair.answer.contacts.size());
}

/// The builder's memory is another pair's as soon as this run is over.
void keep(std::span<const Contact> made, Pair::Implementation& pair) noexcept {
  const std::size_t count = std::min(made.size(), pair.contacts.size());
  std::copy_n(made.begin(), count, pair.contacts.begin());
  pair.answer.contacts = std::span(pair.contacts).first(count);
}

/// Metres: what nobody need have measured.
double unmeasured_depth(const Pair::Implementation& pair) noexcept {
  return tolerances::unmeasured_depth * smaller_size(pair);
}

/// From a part of the rim a depth may be anything: a few pieces of a rim may be taken for one lump, which reaches from
/// end to end. No contact is deeper than `slack` times what is believed from motion along its own normal, but as deep
/// as it takes to hold a body up.
void limit_to_believed(const PosedMeshes& meshes, double slack, Pair::Implementation& pair) noexcept {
  const double unmeasured = unmeasured_depth(pair);
  for (Contact& contact : own_contacts(pair)) {
    const Vec3 place = contact.position - meshes.origin_a();
    const double believed = pair.known_depth.believed(place, contact.normal, meshes.pose());
    contact.depth = std::min(contact.depth, slack * std::max(believed, unmeasured));
  }
}

/// What a finished patch of a part of the rim says of the depth is taken for known as far as motion allows it.
void note_part(const PosedMeshes& meshes, Pair::Implementation& pair) noexcept {
  double deepest = 0.0;
  for (const Contact& contact : pair.answer.contacts) {
    const Vec3 place = contact.position - meshes.origin_a();
    deepest =
        std::max(deepest, std::min(contact.depth, pair.known_depth.believed(place, contact.normal, meshes.pose())));
  }
  pair.known_depth.note(meshes.pose(), deepest);
}

/// Bodies that were never seen apart, and never measured, or elsewhere only, may be as deep as they are; but what they
/// come from here on is known. Without it they would go through each other against a push that never grows.
void note_first_contact(const PosedMeshes& meshes, Pair::Implementation& pair) noexcept {
  pair.known_depth.note(meshes.pose(), std::min(deepest_of(pair.answer.contacts), unmeasured_depth(pair)));
}

/// Bodies that met since they were apart: whence, by the motion of the first place that was found, once it is more than
/// a tremor. Of the smaller body as the larger one sees it: what lies below a ball that spins would seem to have come
/// from the other side of it.
void note_side(const PosedMeshes& meshes, Pair::Implementation& pair) noexcept {
  if (!pair.apart_at) return;
  // Not of its triangles: the middle of one of a floor is far away, and where bodies turn it goes elsewhere.
  const Vec3 place = Crossing::of(meshes, pair.hits.pairs().front()).middle();
  const math::Pose& now = meshes.pose();
  const math::Pose back = now.inverse();
  const Vec3 came = pair.size_b <= pair.size_a
                        ? math::motion_of(place, *pair.apart_at, now)
                        : Vec3(-(now.rotation * math::motion_of(back * place, pair.apart_at->inverse(), back)));
  if (!(came.norm() > unmeasured_depth(pair))) return;
  pair.came = came.normalized();
  pair.apart_at.reset();
}

/// Whether what is known of the depth says nothing of contacts that were limited to it: it is of another side.
bool knows_nothing_here(bool moved_little, const Pair::Implementation& pair) noexcept {
  return !pair.known_depth.known() ||
         (!moved_little && deepest_of(pair.answer.contacts) <= unmeasured_depth(pair) * (1.0 + 1e-9));
}

/// What single pairs of triangles say, when there is no time for a patch.
void make_rough_contacts(const PosedMeshes& meshes, const Vec3* known_normal, bool moved_little, const Request& request,
                         Pair::Implementation& pair, Spending& spending) noexcept {
  const bool solid_a = pair.a->is_solid();
  const bool solid_b = pair.b->is_solid();
  const auto towards_a = [&](const Vec3& place) noexcept -> Vec3 {
    if (!pair.previous_normal.isZero()) return pair.previous_normal;
    return side_of_place(meshes, solid_a, solid_b, place) + tolerances::came_side * pair.came;
  };
  if (request.max_contacts > 1) {
    spending.reserve_for_contacts(pair.endings.rough);
  } else {
    spending.end_from_last_piece(pair.endings.last);
  }
  const std::span<Contact> room = room_for_contacts(request, pair);
  const std::size_t count = rough_contacts(meshes, pair.hits.pairs(), solid_a && solid_b, towards_a, known_normal, room,
                                           [&] { return spending.may_make_contacts(); });
  pair.answer.contacts = room.first(count);
  limit_to_believed(meshes, 1.0, pair);
  pair.answer.contacts_complete = false;
  if (request.max_contacts > 1 && count > 0 && knows_nothing_here(moved_little, pair)) note_first_contact(meshes, pair);
  pair.answer.contact_pairs = static_cast<std::uint32_t>(count);
}

/// A single contact is made of one pair of triangles, which says little about where curved bodies push each other. Its
/// depth remains that of the two along their own direction: along another they may overlap by as much as they are
/// large.
void look_around(const PosedMeshes& meshes, Pair::Implementation& pair, Spending& spending) noexcept {
  EndingReserve& takes = pair.endings.around;
  const double left_us = spending.left_us();
  if (left_us * 1e3 < static_cast<double>(takes.ns())) return takes.ease();
  spending.reserve_for_contacts(takes);  // so that what was made before counts as made
  for (Contact& contact : own_contacts(pair))
    contact.normal = direction_about(*pair.a, *pair.b, *pair.wide, meshes, contact);
  if (std::isfinite(left_us)) takes.note(static_cast<std::int64_t>((left_us - spending.left_us()) * 1e3));
}

/// All but how many of the hits there are.
PatchInput input_of(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const Vec3* known_normal,
                    const Request& request, Pair::Implementation& pair) noexcept {
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
  input.reference_b = meshes.pose().translation + meshes.origin_a();
  if (!pair.previous_normal.isZero()) {
    input.previous_normal = &pair.previous_normal;
    input.previous_position = &pair.previous_position;
  }
  if (!pair.came.isZero()) input.came = &pair.came;
  input.known_normal = known_normal;
  input.max_contacts = request.max_contacts;
  input.kernels = &pair.wide->patch;
  if (request.max_contacts > 1) {  // a single contact is asked for its speed
    input.probe_a = {&probe_depth, pair.a.get()};
    input.probe_b = {&probe_depth, pair.b.get()};
    input.probe_both = &probe_both_depths;
  }
  return input;
}

enum class Made : std::uint8_t { nothing, hastily, carefully };

/// Contacts of the hits, as carefully as there is time for.
Made make_of(const PatchInput& input, PatchBuilder& patches, Pair::Implementation& pair, Spending& spending) noexcept {
  if (input.max_contacts <= 1) {
    // Whatever the time: it takes no longer than a rough contact.
    if (const auto one = patch::contact_of_one_pair(input, *input.kernels)) {
      keep({&*one, 1}, pair);
      pair.answer.contact_pairs = 1;
      spending.end_from_last_piece(pair.endings.last);
      return Made::carefully;
    }
  }
  if (!spending.may_make_contacts()) return Made::nothing;
  const Deadline deadline{[](void* state) noexcept { return !static_cast<Spending*>(state)->may_go_on_making(); },
                          &spending};
  const Deadline last{[](void* state) noexcept { return !static_cast<Spending*>(state)->may_finish_contacts(); },
                      &spending};
  keep(patches.build(input, deadline, last), pair);
  pair.answer.contact_pairs = patches.pairs_used();
  return patches.finished() ? Made::carefully : Made::hastily;
}

/// Along the direction that is known, if any, metres: what was measured and what the bodies have come since, or what
/// nobody need have measured.
double believed_depth(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const Vec3* known_normal,
                      const Pair::Implementation& pair) noexcept {
  const double unmeasured = unmeasured_depth(pair);
  if (known_normal == nullptr) return unmeasured;
  const Vec3 place = pair.known_direction.place(pose_b_in_a) - meshes.origin_a();
  return std::max(unmeasured, pair.known_depth.believed(place, *known_normal, meshes.pose()));
}

}  // namespace

std::uint32_t wanted_hits(const Request& request, const Pair::Implementation& pair) noexcept {
  if (request.max_contacts <= 1) return 1;
  if (is_short(request, pair)) return hits_of_a_guess(request, pair);
  if (!std::isfinite(request.budget.microseconds)) return no_feature;
  return hits_in(request.budget.microseconds, hits_per_microsecond);
}

void make_contacts(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const SearchResult& searched,
                   double most_depth, const Request& request, PatchBuilder& patches, Pair::Implementation& pair,
                   Spending& spending) noexcept {
  const Progressed ended = searched.ended;
  const bool single = request.max_contacts <= 1;
  spending.reserve_for_contacts(single ? pair.endings.single : pair.endings.patch, single ? hasty_single_ns : hasty_ns);
  const double smaller = smaller_size(pair);
  const Vec3* known_normal = pair.known_direction.at(pose_b_in_a, smaller);
  const bool moved_little = most_depth - pair.known_depth.depth() <= tolerances::coherent_motion * smaller;
  note_side(meshes, pair);
  if (is_short(request, pair)) {
    make_contacts_over_runs(meshes, pose_b_in_a, known_normal, request, pair, spending);
    return;
  }
  PatchInput input = input_of(meshes, pose_b_in_a, known_normal, request, pair);
  // Other searches stop at as many as there is time for.
  const bool found_all = searched.method == Method::incremental && pair.a->volume() == volume::Kind::wide;
  if (found_all) input.most_pairs = hits_in(spending.left_us(), found_hits_per_microsecond);
  // As many hits as there was time for are a part of them; as many as were asked for, or as are kept where there is
  // time for more, are what was asked.
  const bool as_many_as_kept = pair.hits.size() == pair.hits.capacity() && pair.hits.capacity() <= input.most_pairs;
  const bool part = request.max_contacts > 1 &&
                    ((ended == Progressed::enough && !as_many_as_kept) || pair.hits.size() > input.most_pairs);
  const bool all = ended != Progressed::spent && !part;
  if (!all) input.believed_depth = believed_depth(meshes, pose_b_in_a, known_normal, pair);
  input.found_all = ended == Progressed::finished && pair.hits.size() <= input.most_pairs;
  const Made made = make_of(input, patches, pair, spending);
  if (made == Made::nothing) {
    (single ? pair.endings.single : pair.endings.patch).note(0);  // or it would never be tried again
    make_rough_contacts(meshes, known_normal, moved_little, request, pair, spending);
    note_unfinished(request, pair);
    return;
  }
  if (pair.answer.contacts.empty()) return;
  const bool finished = made == Made::carefully;
  pair.answer.contacts_complete = finished && all;
  const bool whole = pair.answer.contacts_complete && ended == Progressed::finished;
  if (!finished || (!all && pair.hits.size() < pair.hits.capacity())) note_unfinished(request, pair);
  if (!pair.answer.contacts_complete) {
    limit_to_believed(meshes, 1.0, pair);
  } else if (!whole && request.max_contacts > 1 && pair.known_depth.known() && moved_little) {
    limit_to_believed(meshes, tolerances::sampled_depth, pair);
  } else if (!whole) {  // a single contact, or one far from where the depth was known
    for (Contact& contact : own_contacts(pair)) contact.depth = std::min(contact.depth, most_depth);
  }
  if (single && finished) look_around(meshes, pair, spending);
  const bool flush = answer_by_flat_faces(meshes, pose_b_in_a, request, pair, spending);
  if (finished && request.max_contacts > 1) {
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
  const bool as_known = rests && known_normal != nullptr && finished &&
                        std::all_of(pair.answer.contacts.begin(), pair.answer.contacts.end(), is_known);
  const bool held_back = flush && !pair.flush.gives_all();
  if (!held_back && (pair.answer.contacts_complete || (as_known && request.max_contacts > 1))) {
    pair.carried.keep(pair.answer.contacts, request.max_contacts, pair.hits.pairs(), pose_b_in_a,
                      pair.answer.contacts_complete ? 0 : pair.answer.contact_pairs);
  }
  if (whole || (pair.answer.contacts_complete && request.max_contacts > 1)) {
    pair.known_depth.note(meshes.pose(), deepest_of(pair.answer.contacts));
  } else if (request.max_contacts > 1 && !flush) {
    if (knows_nothing_here(moved_little, pair)) {
      note_first_contact(meshes, pair);
    } else if (finished && pair.answer.contact_pairs >= pairs_of_a_depth) {
      note_part(meshes, pair);
    }
  }
  if (!pair.answer.contacts_complete) return;
  // From here on the contact itself says it, which may travel round a body.
  pair.came.setZero();
  pair.apart_at.reset();
  pair.previous_normal = pair.answer.contacts.front().normal;
  pair.previous_position = pair.answer.contacts.front().position;
}

bool prove_carried(const PosedMeshes& meshes, Pair::Implementation& pair, Spending& spending) noexcept {
  for (TrianglePair& proof : pair.carried.proofs()) {
    if (!spending.allows(1) || !spending.may_go_on_after(2)) return false;
    spending.spend_triangle_pairs(1);
    if (!meshes.meet(proof)) continue;
    std::swap(proof, pair.carried.proofs().front());  // the next run's first
    pair.hits.add(pair.carried.proofs().front());
    pair.answer.verdict = Verdict::hit;
    pair.answer.probability = 1.0;
    return true;
  }
  return false;
}

bool carry_contacts(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const Request& request,
                    Pair::Implementation& pair, Spending& spending) noexcept {
  if (request.max_contacts <= 1 || request.polygon_free) return false;
  const double size = smaller_size(pair);
  if (!pair.carried.serve(pose_b_in_a, request.max_contacts, request.carry_motion * size, size)) return false;
  if (!prove_carried(meshes, pair, spending)) return false;
  pair.answer.contacts = std::span(pair.contacts).first(pair.carried.write(pose_b_in_a, pair.contacts));
  pair.answer.contacts_carried = true;
  pair.answer.contacts_complete = pair.carried.part_of() == 0;
  pair.answer.contact_pairs = pair.carried.part_of();
  return true;
}

}  // namespace odds::query
