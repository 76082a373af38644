// Our class against itself: one query of the pair inside its budget, its answer as ODE contacts.
#include <algorithm>
#include <atomic>
#include <limits>

#include "odds/math/motion.hpp"
#include "ode/budget_clock.hpp"
#include "ode/collide/contact_writer.hpp"
#include "ode/frame/frame_share.hpp"
#include "ode/geom/broad_phase.hpp"
#include "ode/geom/colliders.hpp"
#include "ode/geom/pair_table.hpp"
#include "ode/last_error.hpp"
#include "ode/statistics.hpp"

namespace odds::ode {
namespace {

query::Request request_for(const Settings& settings, int limit) noexcept {
  query::Request request;
  request.method = settings.method;
  request.estimator = settings.estimator;
  request.budget.microseconds = settings.budget_us;
  request.budget.clock = budget_clock();
  if (settings.work_units > 0) request.budget.work_units = settings.work_units;
  request.p_min = settings.p_min;
  request.k_min = settings.k_min;
  request.max_contacts = limit;
  request.carry_motion = settings.carry_motion;
  request.margin = settings.margin_m;
  request.late_contacts = settings.late_contacts;
  request.solids = true;
  return request;
}

double smaller_size(const PairEntry& entry) noexcept {
  return std::min(entry.pair->a().mesh().size(), entry.pair->b().mesh().size());
}

// What met a moment ago, and has not moved far from there, touches unless it is decided that it does not. `place` in
// A's mesh frame.
bool still_touch(const PairEntry& entry, const Vec3& place, const math::Pose& b_in_a) noexcept {
  constexpr std::uint32_t a_moment = 16;  // runs
  constexpr double far = 0.5;             // of the smaller one's size
  if (entry.runs_undecided > a_moment) return false;
  const double size = smaller_size(entry);
  const double moved = math::motion_bound_about(b_in_a.inverse() * place, entry.met_at, b_in_a, size);
  return moved <= far * size;
}

// Whether the most probable pair of cells stands in for contacts. A hit that is proved or passed the caller's own
// threshold needs a contact to be felt; an undecided query follows the policy, which also holds on to what was a hit a
// moment ago.
bool use_cell_pair(const PairEntry& entry, const query::Answer& answer, const Settings& settings,
                   const math::Pose& b_in_a) noexcept {
  if (!answer.contacts.empty() || !answer.has_cell_pair) return false;
  if (answer.basis != query::Basis::budget) return answer.verdict == query::Verdict::hit;
  if (settings.undecided_policy != ODDS_UNDECIDED_HIT) return false;
  // The probability of a short search swings by a tenth about 0.5 from run to run; a contact must not come and go with
  // it. So fewer odds, p / (1 - p), are asked of one that goes on: 0.375 is enough instead of 0.5.
  constexpr double of_the_odds = 0.6;
  const double begins = settings.undecided_probability;
  const double goes_on = of_the_odds * begins / (1.0 - (1.0 - of_the_odds) * begins);
  return answer.probability > (entry.touched ? goes_on : begins) ||
         still_touch(entry, answer.cell_pair.position, b_in_a);
}

void note_decision(const query::Answer& answer, const math::Pose& b_in_a, PairEntry& entry) noexcept {
  if (answer.basis == query::Basis::budget) {
    entry.runs_undecided = std::min(entry.runs_undecided + 1, PairEntry::long_ago);
  } else if (answer.verdict == query::Verdict::hit) {
    entry.runs_undecided = 0;
    entry.met_at = b_in_a;
  } else {
    entry.runs_undecided = PairEntry::long_ago;
  }
}

std::span<const query::Contact> contacts_to_give(PairEntry& entry, const query::Answer& answer,
                                                 const Settings& settings, const math::Pose& b_in_a) noexcept {
  const bool decided = answer.basis == query::Basis::proved && answer.contacts_complete;
  const bool holds = answer.basis != query::Basis::estimated && settings.undecided_policy == ODDS_UNDECIDED_HIT;
  if (!decided && !holds) return answer.contacts;
  return entry.held.best_of(answer, b_in_a, smaller_size(entry));
}

// Contacts of an answer are in A's mesh frame with normals into A.
void write_contact(ContactWriter& writer, const query::Contact& contact, const math::Pose& pose_a,
                   bool o1_is_a) noexcept {
  const Vec3 into_a = pose_a.rotation * contact.normal;
  if (o1_is_a) {
    writer.add_signed(pose_a * contact.position, into_a, contact.depth, contact.triangle_a, contact.triangle_b);
  } else {
    writer.add_signed(pose_a * contact.position, -into_a, contact.depth, contact.triangle_b, contact.triangle_a);
  }
}

oddsAnswer record_of(const query::Answer& answer, const math::Pose& pose_a) noexcept {
  oddsAnswer record = {};
  record.verdict = static_cast<int>(answer.verdict);
  record.basis = static_cast<int>(answer.basis);
  record.probability = answer.probability;
  record.node_pairs = answer.cost.node_pairs;
  record.triangle_pairs = answer.cost.triangle_pairs;
  record.gross_us = answer.cost.gross_us;
  record.stall_us = answer.cost.stall_us;
  record.overshoot_us = answer.cost.overshoot_us;
  record.net_overshoot_us = answer.cost.net_overshoot_us;
  if (!answer.has_cell_pair) return record;
  record.has_cell_pair = 1;
  record.cell_probability = answer.cell_pair_probability;
  const Vec3 position = pose_a * answer.cell_pair.position;
  const Vec3 normal = pose_a.rotation * answer.cell_pair.normal;
  std::copy_n(position.data(), 3, record.cell_position);
  std::copy_n(normal.data(), 3, record.cell_normal);
  record.cell_depth = answer.cell_pair.depth;
  return record;
}

oddsAnswer record_of_bad_pose() noexcept {
  oddsAnswer record = {};
  record.verdict = ODDS_CLEAR;
  record.basis = ODDS_BUDGET;
  record.probability = 0.5;
  record.bad_pose = 1;
  return record;
}

// A larger share would have been of use if it was the share that ended the search, and not the geoms' own budgets.
Outcome outcome_of(const query::Answer& answer, const Settings& own, const Settings& settings, int limit) noexcept {
  if (answer.contacts_carried) return Outcome::carried;
  const bool decided = answer.basis != query::Basis::budget;
  const bool complete = decided && answer.contacts_complete;
  if (complete && answer.verdict == query::Verdict::hit && limit > 0) return Outcome::plenty;
  const std::uint64_t spent = answer.cost.node_pairs + answer.cost.triangle_pairs;
  if (complete || !is_ended_by_share(own, settings, spent)) return Outcome::finished;
  // Contacts of fewer pairs of triangles hold nothing up: bodies sink in while the frame believes them served.
  constexpr std::uint32_t pairs_of_use = 8;
  const bool of_use = answer.verdict == query::Verdict::clear || limit <= 1 || answer.contacts_flush ||
                      answer.contact_pairs >= pairs_of_use;
  return decided && of_use ? Outcome::enough : Outcome::starved;
}

void count_basis(query::Basis basis) noexcept {
  switch (basis) {
    case query::Basis::proved:
      count(statistics().queries_proved);
      return;
    case query::Basis::estimated:
      count(statistics().queries_estimated);
      return;
    case query::Basis::budget:
      count(statistics().queries_budget);
      return;
  }
}

// A frame in which it is not this pair's turn: what is held, where the bodies are now. Nothing is asked.
int give_held(PairEntry& entry, const Settings& settings, const math::Pose& pose_a, const math::Pose& b_in_a,
              bool o1_is_a, ContactWriter& writer) noexcept {
  if (settings.undecided_policy == ODDS_UNDECIDED_HIT) {
    for (const query::Contact& contact : entry.held.at(b_in_a, smaller_size(entry)))
      write_contact(writer, contact, pose_a, o1_is_a);
  }
  const oddsAnswer before = entry.last;
  entry.last = {};
  entry.last.verdict = before.verdict;
  entry.last.basis = ODDS_BUDGET;
  entry.last.probability = before.probability;
  entry.last.contacts = writer.count();
  entry.last.only_held = 1;
  current_share->report(0, writer.count(), Outcome::unknown);
  count(statistics().contacts, static_cast<unsigned long long>(writer.count()));
  return writer.count();
}

// Bodies for which the broad phase before this one did not ask were apart where it saw them.
void note_if_apart(std::uint64_t asked_in, PairEntry& entry) noexcept {
  if (current_broad_phase == 0 || asked_in + 1 >= current_broad_phase) return;
  const std::optional<math::Pose> before = before_this_broad_phase(*entry.a, *entry.b);
  if (!before) return;
  entry.runs_undecided = PairEntry::long_ago;
  entry.touched = false;
  entry.pair->note_apart(*before);
  entry.held.note_apart(*before);
}

// The last broad phase that has asked for the pair; from here on it is this one. Also of a pair that another thread is
// at: the next broad phase must not take it for apart.
std::uint64_t note_asked(PairEntry& entry) noexcept {
  const std::uint64_t before = entry.asked_in.load(std::memory_order_relaxed);
  if (current_broad_phase != 0) entry.asked_in.store(current_broad_phase, std::memory_order_relaxed);
  return before;
}

// Precondition: this thread holds `entry.busy`, and `entry.pair` is set. `asked_in`: the last broad phase that asked
// before.
int answer_pair(PairEntry& entry, std::uint64_t asked_in, dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts,
                int skip) noexcept {
  const bool o1_is_a = entry.a == &own_data(o1);
  const std::optional<math::Pose> pose_a = world_pose(o1_is_a ? o1 : o2);
  const std::optional<math::Pose> pose_b = world_pose(o1_is_a ? o2 : o1);
  entry.answered = true;
  if (!pose_a || !pose_b) {
    count(statistics().bad_poses);
    entry.last = record_of_bad_pose();
    entry.touched = false;
    return 0;
  }
  const Settings own = combine(entry.a->settings, entry.b->settings);
  Settings settings = within_share(own);
  // Contacts that take some dozens of runs would be of long ago where a pair waits for its turns in a frame, and keep
  // their memory from others meanwhile.
  if (current_share != nullptr && entry.last.only_held != 0) settings.late_contacts = false;
  const int limit = room_for(flags, settings.max_contacts);
  const math::Pose b_in_a = pose_a->inverse() * *pose_b;
  ContactWriter writer(o1, o2, limit, contacts, skip);
  if (gives_only_held()) return give_held(entry, settings, *pose_a, b_in_a, o1_is_a, writer);
  note_if_apart(asked_in, entry);
  const query::Answer& answer = entry.pair->run(b_in_a, request_for(settings, limit));
  count_basis(answer.basis);
  note_decision(answer, b_in_a, entry);
  entry.last = record_of(answer, *pose_a);
  const std::span<const query::Contact> given = contacts_to_give(entry, answer, settings, b_in_a);
  for (const query::Contact& contact : given) write_contact(writer, contact, *pose_a, o1_is_a);
  if (given.empty() && use_cell_pair(entry, answer, settings, b_in_a)) {
    // A place and a direction, but no push: a depth that nobody has measured could throw a body away.
    query::Contact contact = answer.cell_pair;
    if (answer.basis == query::Basis::budget) contact.depth = 0.0;
    write_contact(writer, contact, *pose_a, o1_is_a);
    entry.last.from_cell_pair = writer.count();
    count(statistics().cell_pair_contacts, static_cast<unsigned long long>(writer.count()));
  }
  entry.last.contacts = writer.count();
  const bool apart = answer.basis == query::Basis::proved && answer.verdict == query::Verdict::clear;
  entry.touched = writer.count() > 0 && !apart;
  count(statistics().contacts, static_cast<unsigned long long>(writer.count()));
  if (current_share != nullptr) {
    current_share->report(answer.cost.node_pairs + answer.cost.triangle_pairs, writer.count(),
                          outcome_of(answer, own, settings, limit));
    current_share->stall_us += answer.cost.stall_us;
  }
  return writer.count();
}

// A pair that nobody prepared: made now, inside the loop, and counted; a pair that cannot be made is said once.
PairEntry* prepare_late(dGeomID o1, dGeomID o2) noexcept {
  const PairTable::Made made = pair_table().prepare(own_data(o1), own_data(o2), false);
  if (made.inserted) {
    made.entry->asked_in.store(current_broad_phase, std::memory_order_relaxed);  // there was no entry to note it in
    count(statistics().lazy_pairs);
    if (!made.entry->pair) dMessage(0, "odds: a pair of meshes cannot collide: %s", oddsGetLastError());
  }
  return made.entry;
}

}  // namespace

int collide_mesh(dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts, int skip) noexcept {
  if (!gives_only_held()) count(statistics().queries);
  PairEntry* entry = pair_table().find(own_data(o1), own_data(o2));
  if (entry == nullptr && gives_only_held()) return 0;
  if (entry == nullptr) entry = prepare_late(o1, o2);
  if (entry == nullptr || !entry->pair) {
    count(statistics().failed_pairs);
    return 0;
  }
  const std::uint64_t asked_in = note_asked(*entry);
  if (entry->busy.exchange(true, std::memory_order_acquire)) {
    count(statistics().busy_pairs);
    return 0;
  }
  const int written = answer_pair(*entry, asked_in, o1, o2, flags, contacts, skip);
  entry->busy.store(false, std::memory_order_release);
  return written;
}

}  // namespace odds::ode
