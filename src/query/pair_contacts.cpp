// Contacts from the pairs of triangles that a search has found, within what is left of the budget.
#include "query/pair_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "odds/math/tolerances.hpp"
#include "odds/query/ray.hpp"
#include "query/rough_contacts.hpp"

namespace odds::query {
extern long dbg[10];
namespace {

// A pair of triangles in a patch takes 0.3 us, half of it to be found; rays and choice some 25 us whatever their
// number.
constexpr double hits_per_microsecond = 3.0;
constexpr double found_hits_per_microsecond = 6.0;
constexpr double patch_base_us = 25.0;
// Fewer may leave a gap in the rim of even two boxes, and the direction of a patch needs all of its rim.
constexpr double least_hits = 64.0;
constexpr double most_hits = 65536.0;
// For a direction that is looked for in haste, before what is there is written.
constexpr std::int64_t hasty_ns = 2500;
constexpr std::int64_t hasty_single_ns = 1000;
/// Budgets of less have no time for a patch beside the search.
constexpr double late_below_us = 50.0;
constexpr std::uint32_t pairs_of_a_depth = 12;  ///< a patch of fewer may show anything less than how deep bodies are

/// Pairs of triangles that a patch has time for.
std::uint32_t hits_in(double microseconds, double per_microsecond) noexcept {
  return static_cast<std::uint32_t>(
      std::clamp(per_microsecond * (microseconds - patch_base_us), least_hits, most_hits));
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
  return tolerances::unmeasured_depth * std::min(pair.a->mesh().size(), pair.b->mesh().size());
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

/// The same of contacts made in haste, whose direction is a guess: what bodies have come along it says little if it was
/// not seen from run to run.
void limit_in_haste(const PosedMeshes& meshes, Pair::Implementation& pair) noexcept {
  limit_to_believed(meshes, 1.0, pair);
  const double most = pair.late ? unmeasured_depth(pair) : 1e9;
  for (Contact& contact : own_contacts(pair)) contact.depth = std::min(contact.depth, most);
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

/// What contacts say that were made in haste, of a few pairs of triangles. They err now and then, so that each moves
/// what is taken for known only by a share. Where two that follow each other push elsewhere, nothing has been seen to
/// come nearer: what is known fades, or bodies that slide along each other would be taken for deeper and deeper.
void note_in_haste(const PosedMeshes& meshes, double measured, std::size_t made, Pair::Implementation& pair) noexcept {
  const Vec3 normal = pair.answer.contacts.front().normal;
  const bool agrees = normal.dot(pair.hasty_normal) > tolerances::hasty_agreement;
  pair.hasty_normal = normal;
  double followed = pair.known_depth.depth();
  if (agrees && pair.known_depth.is_fresh()) {
    followed = 0.0;
    for (const Contact& contact : pair.answer.contacts.first(made)) {
      const Vec3 place = contact.position - meshes.origin_a();
      followed = std::max(followed, pair.known_depth.followed(place, contact.normal, meshes.pose()));
    }
  }
  const double towards = std::min({measured, followed, agrees ? followed : unmeasured_depth(pair)});
  pair.known_depth.note(meshes.pose(), followed + tolerances::hasty_say * (towards - followed));
}

/// Bodies that were never seen apart, and never measured, or elsewhere only, may be as deep as they are; but what they
/// come from here on is known. Without it they would go through each other against a push that never grows.
void note_first_contact(const PosedMeshes& meshes, Pair::Implementation& pair) noexcept {
  pair.known_depth.note(meshes.pose(), std::min(deepest_of(pair.answer.contacts), unmeasured_depth(pair)));
}

/// Bodies that met since they were apart: whence, by the motion of the first place that was found, once it is more than
/// a tremor.
void note_side(const PosedMeshes& meshes, Pair::Implementation& pair) noexcept {
  if (!pair.apart_at) return;
  const tree::TriangleCorners met = meshes.corners_b(pair.hits.pairs().front().b);
  const Vec3 came = math::motion_of((met[0] + met[1] + met[2]) / 3.0, *pair.apart_at, meshes.pose());
  if (!(came.norm() > unmeasured_depth(pair))) return;
  pair.came = came.normalized();
  pair.apart_at.reset();
}

/// Whether what is known of the depth says nothing of contacts that were limited to it: it is of another side.
bool knows_nothing_here(bool moved_little, const Pair::Implementation& pair) noexcept {
  return !pair.known_depth.known() ||
         (!moved_little && deepest_of(pair.answer.contacts) <= unmeasured_depth(pair) * (1.0 + 1e-9));
}

/// The memory of contacts made in haste, at the start of a run that makes some.
void begin_in_haste(const math::Pose& pose_b_in_a, double smaller, Pair::Implementation& pair) noexcept {
  ++pair.hasty_runs;
  pair.haste.begin(pose_b_in_a, tolerances::hasty_slack * smaller);
}

/// Adds the places that runs before found to this run's contacts. `normal`: of all, or null where each has its own.
void add_remembered(const math::Pose& pose_b_in_a, const Vec3* normal, const Request& request,
                    Pair::Implementation& pair) noexcept {
  const double near = tolerances::hasty_spacing * std::min(pair.a->mesh().size(), pair.b->mesh().size());
  const std::size_t room = std::min(static_cast<std::size_t>(request.max_contacts), pair.contacts.size());
  const std::size_t all =
      pair.haste.add_to(std::span(pair.contacts).first(room), pair.answer.contacts.size(), normal, pose_b_in_a, near);
  pair.answer.contacts = std::span(pair.contacts).first(all);
}

/// Keeps the places of the first `made` contacts for later runs.
void remember(const math::Pose& pose_b_in_a, std::size_t made, Pair::Implementation& pair) noexcept {
  const double near = tolerances::hasty_spacing * std::min(pair.a->mesh().size(), pair.b->mesh().size());
  pair.haste.remember(std::span(pair.contacts).first(made), pose_b_in_a, near);
}

/// Whether contacts may be made over several runs.
bool may_be_late(const Request& request, const Pair::Implementation& pair) noexcept {
  return pair.late != nullptr && request.max_contacts > 1 && !request.polygon_free &&
         request.budget.microseconds < late_below_us;
}

/// What single pairs of triangles say, when there is no time for a patch.
void make_rough_contacts(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const Vec3* known_normal,
                         bool moved_little, const Request& request, Pair::Implementation& pair,
                         Spending& spending) noexcept {
  const Vec3 centre_b = meshes.pose().translation + meshes.origin_a();
  const Vec3 by_place = (meshes.origin_a() - centre_b).stableNormalized();
  const Vec3 towards_a =
      pair.previous_normal.isZero() ? Vec3(by_place + tolerances::came_side * pair.came) : pair.previous_normal;
  spending.reserve_for_contacts(pair.endings.rough);
  const double kept_us = may_be_late(request, pair) ? 0.5 * spending.left_us() : 0.0;
  const auto room =
      std::span(pair.contacts).first(std::min(static_cast<std::size_t>(request.max_contacts), pair.contacts.size()));
  HastyMemory* const memory = may_be_late(request, pair) ? &pair.haste : nullptr;
  const double little = tolerances::hasty_alike * std::min(pair.a->mesh().size(), pair.b->mesh().size());
  Vec3 common;
  const Vec3 expected = pair.previous_normal.isZero() ? pair.came : pair.previous_normal;
  const RoughContacts made =
      rough_contacts(meshes, pair.hits.pairs(), pair.a->is_solid() && pair.b->is_solid(), towards_a, known_normal,
                     memory, memory != nullptr ? pair.hasty_runs : 0, little, expected, common, room,
                     [&] { return spending.may_make_contacts() && spending.left_us() >= kept_us; });
  const std::size_t count = made.count;
  pair.answer.contacts = room.first(count);
  const double measured = made.measured;
  if (memory != nullptr) add_remembered(pose_b_in_a, made.direction, request, pair);
  limit_in_haste(meshes, pair);
  if (memory != nullptr) remember(pose_b_in_a, count, pair);
  pair.answer.contacts_complete = false;
  if (request.max_contacts > 1 && count > 0) {
    if (knows_nothing_here(moved_little, pair)) {
      note_first_contact(meshes, pair);
    } else {
      note_in_haste(meshes, measured, count, pair);
    }
  }
  pair.answer.contact_pairs = static_cast<std::uint32_t>(count);
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

/// Whether one of the pairs of triangles that met where the contacts are from meets now: a hit.
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

/// Whether the contacts of earlier poses are of use now, far as the bodies may have moved.
bool serves_late(const math::Pose& pose_b_in_a, const Pair::Implementation& pair) noexcept {
  return pair.late->manifold().serves(pose_b_in_a, std::min(pair.a->mesh().size(), pair.b->mesh().size()));
}

/// Those of them that overlap.
void write_late(const math::Pose& pose_b_in_a, const Request& request, Pair::Implementation& pair) noexcept {
  const std::span<Contact> room =
      std::span(pair.contacts).first(std::min(static_cast<std::size_t>(request.max_contacts), pair.contacts.size()));
  pair.answer.contacts = room.first(pair.late->manifold().write(pose_b_in_a, std::min(pair.a->mesh().size(), pair.b->mesh().size()), room));
  pair.answer.contacts_complete = false;
  pair.answer.contacts_late = true;
  pair.answer.contact_pairs = pair.late->manifold().made_from();
}

/// A search that ends early has found hits on one side only. Some of those of the work under way, which has looked
/// everywhere, still are hits.
void add_hits_of_work(const PosedMeshes& meshes, Pair::Implementation& pair, Spending& spending) noexcept {
  const std::span<const TrianglePair> hits = pair.late->hits();
  constexpr std::size_t most_tried = 4;
  for (std::size_t i = 0; i < std::min(most_tried, hits.size()) && spending.may_make_contacts(); ++i) {
    const TrianglePair tried = hits[(i * hits.size() / most_tried + 5 * pair.hasty_runs) % hits.size()];
    spending.spend_triangle_pairs(1);
    if (meshes.meet(tried)) pair.hits.add(tried);
  }
}

/// The guess of a run before, if it will do.
bool write_guess(const math::Pose& pose_b_in_a, const Request& request, Pair::Implementation& pair) noexcept {
  const std::span<Contact> room =
      std::span(pair.contacts).first(std::min(static_cast<std::size_t>(request.max_contacts), pair.contacts.size()));
  const std::size_t written = pair.late->write_guess(pose_b_in_a, room);
  if (written == 0) return false;
  pair.answer.contacts = room.first(written);
  pair.answer.contacts_complete = false;
  pair.answer.contact_pairs = static_cast<std::uint32_t>(written);
  return true;
}

}  // namespace

std::uint32_t wanted_hits(const Request& request, const Pair::Implementation& pair) noexcept {
  if (request.max_contacts <= 1) return 1;
  if (may_be_late(request, pair)) return pair.late->has_guess() ? 1 : most_contacts;
  if (!std::isfinite(request.budget.microseconds)) return no_feature;
  return hits_in(request.budget.microseconds, hits_per_microsecond);
}

void make_contacts(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const SearchResult& searched,
                   double most_depth, const Request& request, PatchBuilder& patches, Pair::Implementation& pair,
                   Spending& spending) noexcept {
  const Progressed ended = searched.ended;
  const Vec3 centre_b = meshes.pose().translation + meshes.origin_a();
  const bool single = request.max_contacts <= 1;
  spending.reserve_for_contacts(single ? pair.endings.single : pair.endings.patch, single ? hasty_single_ns : hasty_ns);
  const double smaller = std::min(pair.a->mesh().size(), pair.b->mesh().size());
  const Vec3* known_normal = pair.known_direction.at(pose_b_in_a, smaller);
  const bool moved_little = most_depth - pair.known_depth.depth() <= tolerances::coherent_motion * smaller;
  note_side(meshes, pair);
  if (may_be_late(request, pair)) {
    const double l0 = spending.left_us();
    begin_in_haste(pose_b_in_a, smaller, pair);
    struct P { double l0; Spending& s; double l1; ~P() { static double a=0,b=0,c=0; static int n=0; a+=l0; b+=l1; c+=s.left_us(); if (++n % 2000 == 0) std::fprintf(stderr,"TIME left at entry %.2f after rough %.2f end %.2f\n",a/2000,b/2000,c/2000),a=b=c=0; } } pp{l0, spending, 0};
    if (serves_late(pose_b_in_a, pair)) {
      ++dbg[7];
      write_late(pose_b_in_a, request, pair);
    } else if (!write_guess(pose_b_in_a, request, pair)) {
      ++dbg[0];
      add_hits_of_work(meshes, pair, spending);
      make_rough_contacts(meshes, pose_b_in_a, known_normal, moved_little, request, pair, spending);
      pair.late->keep_guess(pair.answer.contacts, pose_b_in_a);
    } else ++dbg[8];
    pp.l1 = spending.left_us();
    if (getenv("TR")) { const auto& c = pair.answer.contacts; std::fprintf(stderr, "TR run %u %s n %zu", pair.hasty_runs, pair.answer.contacts_late ? "late" : "guess", c.size()); if (!c.empty()) std::fprintf(stderr, " nrm %.2f %.2f %.2f d %.4f mm at %.1f %.1f %.1f", c[0].normal.x(), c[0].normal.y(), c[0].normal.z(), c[0].depth*1e3, c[0].position.x()*1e3, c[0].position.y()*1e3, c[0].position.z()*1e3); std::fprintf(stderr, " came %.2f %.2f %.2f prev %.2f t %.4f %.4f %.4f mm left %.2f\n", pair.came.x(), pair.came.y(), pair.came.z(), pair.previous_normal.z(), pose_b_in_a.translation.x()*1e3, pose_b_in_a.translation.y()*1e3, pose_b_in_a.translation.z()*1e3, pp.l1); }
    spending.reserve_for_contacts(pair.endings.late);
    if (pair.late->work(pose_b_in_a, request, pair, spending) && serves_late(pose_b_in_a, pair)) {
      write_late(pose_b_in_a, request, pair);
    }
    return;
  }
  if (!spending.may_make_contacts()) {
    (single ? pair.endings.single : pair.endings.patch).note(0);  // or it would never be tried again
    make_rough_contacts(meshes, pose_b_in_a, known_normal, moved_little, request, pair, spending);
    return;
  }
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
  if (!pair.came.isZero()) input.came = &pair.came;
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
  const Deadline last{[](void* state) noexcept { return !static_cast<Spending*>(state)->may_finish_contacts(); },
                      &spending};
  keep(patches.build(input, deadline, last), pair);
  if (pair.answer.contacts.empty()) return;
  pair.answer.contact_pairs = patches.pairs_used();
  pair.answer.contacts_complete = patches.finished() && all;
  const bool whole = pair.answer.contacts_complete && ended == Progressed::finished;
  if (!pair.answer.contacts_complete) {
    limit_to_believed(meshes, 1.0, pair);
  } else if (!whole && request.max_contacts > 1 && pair.known_depth.known() && moved_little) {
    limit_to_believed(meshes, tolerances::sampled_depth, pair);
  } else if (!whole) {  // a single contact, or one far from where the depth was known
    for (Contact& contact : own_contacts(pair)) contact.depth = std::min(contact.depth, most_depth);
  }
  if (patches.finished() && request.max_contacts > 1) {
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
  const bool as_known = rests && known_normal != nullptr && patches.finished() &&
                        std::all_of(pair.answer.contacts.begin(), pair.answer.contacts.end(), is_known);
  if (pair.answer.contacts_complete || (as_known && request.max_contacts > 1)) {
    pair.carried.keep(pair.answer.contacts, request.max_contacts, pair.hits.pairs(), pose_b_in_a,
                      pair.answer.contacts_complete ? 0 : pair.answer.contact_pairs);
  }
  if (whole || (pair.answer.contacts_complete && request.max_contacts > 1)) {
    pair.known_depth.note(meshes.pose(), deepest_of(pair.answer.contacts));
  } else if (request.max_contacts > 1) {
    if (knows_nothing_here(moved_little, pair)) {
      note_first_contact(meshes, pair);
    } else if (patches.finished() && patches.pairs_used() >= pairs_of_a_depth) {
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

bool carry_contacts(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const Request& request,
                    Pair::Implementation& pair, Spending& spending) noexcept {
  if (request.max_contacts <= 1 || request.polygon_free) return false;
  const double size = std::min(pair.a->mesh().size(), pair.b->mesh().size());
  if (!pair.carried.serve(pose_b_in_a, request.max_contacts, request.carry_motion * size, size)) return false;
  if (!prove_carried(meshes, pair, spending)) return false;
  pair.answer.contacts = std::span(pair.contacts).first(pair.carried.write(pose_b_in_a, pair.contacts));
  pair.answer.contacts_carried = true;
  pair.answer.contacts_complete = pair.carried.part_of() == 0;
  pair.answer.contact_pairs = pair.carried.part_of();
  return true;
}

bool carry_late_contacts(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const Request& request,
                         Pair::Implementation& pair, Spending& spending) noexcept {
  if (!may_be_late(request, pair)) return false;
  if (!serves_late(pose_b_in_a, pair) || !prove_carried(meshes, pair, spending)) return false;
  write_late(pose_b_in_a, request, pair);
  ++dbg[1];
  spending.reserve_for_contacts(pair.endings.late);
  if (pair.late->work(pose_b_in_a, request, pair, spending) && serves_late(pose_b_in_a, pair)) {
    write_late(pose_b_in_a, request, pair);
  }
  return true;
}

}  // namespace odds::query
