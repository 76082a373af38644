#include "query/contacts/flush_answer.hpp"

#include <algorithm>
#include <array>

#include "odds/math/tolerances.hpp"

namespace odds::query {
namespace {

/// What contacts of one pair of flat faces take where caches are cold; of it its move takes a third.
constexpr double of_flush_us = 1.1;
constexpr double of_a_pair_us = 0.8;     ///< and the choice of contacts the rest
constexpr double of_a_contact_us = 0.4;  ///< to look whether it is one of flat faces

/// What is kept back for an ending learns what this takes, but of a very short time it cannot be enough.
bool has_time(double takes_us, const Request& request, Spending& spending) noexcept {
  return request.budget.microseconds >= very_short_us || spending.left_us() > takes_us;
}

}  // namespace

bool is_of_flat_faces(const PosedMeshes& meshes, const Crossing& crossing, Pair::Implementation& pair) noexcept {
  return pair.flush.explains_crossing(crossing.middle() + meshes.origin_a(), crossing.normal_a, crossing.normal_b);
}

void write_flush(const PosedMeshes& meshes, bool all, const Request& request, Pair::Implementation& pair,
                 Spending& spending) noexcept {
  const std::span<Contact> room = room_for_contacts(request, pair);
  const auto may_go_on = [&spending] { return spending.left_us() > of_a_pair_us; };
  pair.answer.contacts = room.first(pair.flush.write(room, may_go_on));
  pair.answer.contacts_flush = true;
  pair.answer.contacts_complete = all;
  pair.answer.contact_pairs = static_cast<std::uint32_t>(pair.answer.contacts.size());
  double deepest = 0.0;
  for (const Contact& contact : pair.answer.contacts) deepest = std::max(deepest, contact.depth);
  pair.known_depth.note(meshes.pose(), deepest);
}

void move_flush(const math::Pose& pose_b_in_a, bool measured, Pair::Implementation& pair, Spending& spending) noexcept {
  pair.flush.move_to(pose_b_in_a, smaller_size(pair), measured,
                     [&spending] { return spending.left_us() > of_flush_us; });
}

bool see_flush(const PosedMeshes& meshes, Pair::Implementation& pair, Spending& spending) noexcept {
  constexpr std::size_t most_seen = 3;
  if (!pair.flush.may_be()) return false;
  const std::span<const TrianglePair> hits = pair.hits.pairs();
  const std::size_t seen = std::min(hits.size(), most_seen);
  for (std::size_t i = 0; i < seen && (i == 0 || spending.may_make_contacts()); ++i) {
    // What is not of them does not end it: other faces may be known from the next one.
    pair.flush.note(is_of_flat_faces(meshes, Crossing::of(meshes, hits[i * hits.size() / seen]), pair), false);
  }
  return pair.flush.serves();
}

bool is_all_flush(std::span<const Contact> contacts, const math::Pose& pose, bool all, Pair::Implementation& pair,
                  Spending& spending) noexcept {
  if (!pair.flush.may_be()) return false;
  bool explained = true;
  for (const Contact& contact : contacts) {
    if (spending.left_us() < of_a_contact_us) return explained && pair.flush.serves();
    explained = explained && pair.flush.explains(contact, pose);
  }
  pair.flush.note(explained, all);
  return pair.flush.serves();
}

void add_flush(const Request& request, Pair::Implementation& pair, Spending& spending) noexcept {
  if (!pair.flush.overlap() || !has_time(of_a_pair_us, request, spending)) return;
  const std::span<Contact> room = room_for_contacts(request, pair);
  std::array<Contact, most_contacts> others;
  std::size_t other_count = 0;
  for (const Contact& contact : pair.answer.contacts) {
    if (!pair.flush.include(contact)) others[other_count++] = contact;
  }
  std::array<Contact, most_contacts> flush;
  const std::size_t flush_count = pair.flush.write(std::span(flush).first(room.size()), [] { return true; });
  std::size_t written = 0;
  for (std::size_t i = 0; i < most_contacts; ++i) {
    if (i < flush_count && written < room.size()) room[written++] = flush[i];
    if (i < other_count && written < room.size()) room[written++] = others[i];
  }
  pair.answer.contacts = room.first(written);
}

void learn_from_work(const PosedMeshes& meshes, Pair::Implementation& pair, Spending& spending) noexcept {
  constexpr std::size_t most_seen = 2;
  constexpr std::size_t stride = 7919;  // a prime: all of the list in time
  const std::span<const TrianglePair> hits = pair.late->hits();
  for (std::size_t i = 0; i < std::min(most_seen, hits.size()) && spending.left_us() > of_flush_us; ++i) {
    const TrianglePair& hit = hits[++pair.hasty_runs * stride % hits.size()];
    spending.spend_triangle_pairs(1);
    if (meshes.meet(hit)) pair.flush.note(is_of_flat_faces(meshes, Crossing::of(meshes, hit), pair), false);
  }
}

bool answer_by_flat_faces(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const Request& request,
                          Pair::Implementation& pair, Spending& spending) noexcept {
  const std::span<const Contact> made = pair.answer.contacts;
  if (!request.late_contacts || request.max_contacts <= 1 || !pair.flush.may_be()) return false;
  const double takes_us = of_flush_us + of_a_pair_us * static_cast<double>(FlushContacts::most_entries) +
                          of_a_contact_us * static_cast<double>(made.size());
  if (!(spending.left_us() > takes_us)) return false;
  const bool all = pair.answer.contacts_complete;
  move_flush(pose_b_in_a, all, pair, spending);
  if (!is_all_flush(made, pose_b_in_a, all, pair, spending) || (!all && !see_flush(meshes, pair, spending)))
    return false;
  write_flush(meshes, all, request, pair, spending);
  return true;
}

void judge_by_flat_faces(const PosedMeshes& meshes, const Request& request, Pair::Implementation& pair,
                         Spending& spending) noexcept {
  Answer& answer = pair.answer;
  if (answer.has_cell_pair && has_time(0.5 * of_a_pair_us, request, spending)) pair.flush.straighten(answer.cell_pair);
  if (!pair.flush.is_certain()) return;
  answer.verdict = Verdict::hit;
  answer.probability = std::max(answer.probability, tolerances::flush_probability);
  // Where something else is known to touch, a caller's contacts of the last run say more than these alone.
  if (request.max_contacts > 0 && pair.flush.serves() && has_time(of_a_pair_us, request, spending)) {
    write_flush(meshes, false, request, pair, spending);
  }
}

}  // namespace odds::query
