#include "query/contacts/guess_contacts.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "odds/math/tolerances.hpp"
#include "query/contacts/flush_answer.hpp"
#include "query/contacts/pair_contacts.hpp"
#include "query/contacts/rough_contacts.hpp"

namespace odds::query {
namespace {

/// Of what a run has left, for a guess; the rest is for the work on contacts.
constexpr double share_of_a_guess = 0.5;

/// Some of the pair's hits, others in each run, spread over their list, as they cross.
struct Sample {
  std::array<Crossing, most_contacts> crossings;
  std::array<TrianglePair, most_contacts> hits;
  std::size_t count = 0;

  [[nodiscard]] std::span<const Crossing> made() const noexcept { return std::span(crossings).first(count); }
  /// Brings those to the front of which something holds; how many.
  template <class Holds>
  std::size_t partition(Holds holds) noexcept {
    std::size_t first = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (!holds(crossings[i])) continue;
      std::swap(crossings[first], crossings[i]);
      std::swap(hits[first++], hits[i]);
    }
    return first;
  }
};

template <class MayGoOn>
Sample sample_of(const PosedMeshes& meshes, std::span<const TrianglePair> hits, std::size_t first,
                 MayGoOn may_go_on) noexcept {
  Sample sample;
  const std::size_t most = std::min(hits.size(), sample.hits.size());
  for (const std::size_t eighth : spread_eighths) {
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
  /// Of crossings about `place`. `anew`: whatever is known of other places.
  Judge(const PosedMeshes& meshes, const Vec3& place, const Pair::Implementation& pair, bool anew) noexcept
      : both_solid_(pair.a->is_solid() && pair.b->is_solid()),
        expected_(anew ? Vec3(Vec3::Zero()) : pair.previous_normal),
        little_(tolerances::hasty_alike * smaller_size(pair)) {
    const Vec3 by_place = side_of_place(meshes, pair.a->is_solid(), pair.b->is_solid(), place);
    towards_a_ = expected_.isZero() ? Vec3(by_place + tolerances::came_side * pair.came) : expected_;
  }

  [[nodiscard]] Vote vote_of(const Crossing& crossing) const noexcept {
    const Vec3 by_b = turned(crossing.normal_b);
    const Vec3 by_a = turned(-crossing.normal_a);
    return Vote::of(-by_a, by_b, crossing.overlap_along(by_a), crossing.overlap_along(by_b),
                    (crossing.segment.end - crossing.segment.begin).norm(), little_, expected_);
  }
  /// Whether bodies that part in a direction (unit, into A) slide along both surfaces there, or go into them, or would
  /// part sooner in another: it is another place than the one that the direction is known from. Never where none is
  /// known (zero).
  [[nodiscard]] bool is_elsewhere(const Crossing& crossing, const Vec3& direction) const noexcept {
    if (direction.isZero()) return false;
    const Vec3 by_b = turned(crossing.normal_b);
    const Vec3 by_a = turned(-crossing.normal_a);
    const double agreement = std::max(direction.dot(by_a), direction.dot(by_b));
    if (agreement > tolerances::hasty_along) return false;
    if (agreement < tolerances::hasty_across) return true;  // along it, or into both, however little they overlap there
    const double least = std::min(crossing.overlap_along(by_a), crossing.overlap_along(by_b));
    return crossing.overlap_along(direction) + little_ > tolerances::hasty_elsewhere * (least + little_);
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

/// The direction into A, unit, in which contacts were found to push so far; zero if there were none.
Vec3 expected_direction(const Pair::Implementation& pair, const Vec3* known_normal) noexcept {
  if (known_normal != nullptr) return *known_normal;
  return pair.haste.has_seen() && pair.haste.is_of_one_mind() ? pair.haste.direction() : pair.previous_normal;
}

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

void limit_depths(std::span<Contact> contacts, double most) noexcept {
  for (Contact& contact : contacts) contact.depth = std::min(contact.depth, most);
}

}  // namespace

void begin_haste(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, Pair::Implementation& pair) noexcept {
  if (pair.haste_has_begun) return;
  pair.haste_has_begun = true;
  const double size = smaller_size(pair);
  pair.haste.begin(pose_b_in_a, centre_of_smaller(meshes.pose(), pair), tolerances::hasty_slack * size,
                   tolerances::coherent_motion * size);
}

bool guess_contacts(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const Vec3* known_normal,
                    const Request& request, Pair::Implementation& pair, Spending& spending) noexcept {
  const double kept_us = (1.0 - share_of_a_guess) * spending.left_us();
  Sample sample = sample_of(meshes, pair.hits.pairs(), pair.hasty_runs,
                            [&] { return spending.may_make_contacts() && spending.left_us() >= kept_us; });
  leave_out_flush(meshes, sample, pair, spending);
  pair.answer.contacts = {};
  if (sample.count == 0) return false;
  // Beside such faces the rest has a direction of its own, of which nothing is known; and so has what crosses elsewhere
  // than before, which must not push as that did: a body that comes off a wall onto the floor is held from below.
  const bool beside = pair.flush.overlap();
  const Vec3 middle = middle_of(sample.made());
  const Judge anew(meshes, middle, pair, true);
  const Judge as_before(meshes, middle, pair, false);
  const Vec3 expected = expected_direction(pair, known_normal);
  const std::size_t known = beside ? 0 : sample.partition([&](const Crossing& crossing) noexcept {
    return !as_before.is_elsewhere(crossing, expected);
  });
  if (known == 0) known_normal = nullptr;
  const double size = smaller_size(pair);
  if (!beside) pair.haste.spread.begin(meshes.pose().translation, tolerances::hasty_line * size);
  // Those elsewhere have a say, too: where they are many, or all around as in a thread, there is no one direction.
  for (const Crossing& crossing : sample.made()) {
    if (beside) break;
    pair.haste.spread.see(crossing.middle());
    const Vote vote = as_before.vote_of(crossing);
    pair.haste.see(vote.weight * vote.direction, vote.weight);
  }
  const bool each_its_own =
      known > 0 && known_normal == nullptr && pair.haste.has_seen() && !pair.haste.is_of_one_mind();
  const Vec3 direction = known_normal != nullptr ? *known_normal
                         : known > 0             ? as_before.direction_of(sample.made().first(known), pair.haste)
                                                 : anew.direction_of(sample.made(), HastyMemory());
  // A corner that has just come through is not deeper than its rim is wide, though the triangles reach on.
  const double extent = extent_of(sample.made());
  const double given = pair.haste.guessed.most() * size;
  double overlaps = 0.0;
  const std::span<Contact> room = room_for_contacts(request, pair);
  const std::size_t count = std::min(sample.count, room.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Crossing& crossing = sample.crossings[i];
    Vec3 normal = direction;
    const bool elsewhere = !beside && i >= known;
    if (each_its_own || elsewhere) {
      const Vote vote = (elsewhere ? anew : as_before).vote_of(crossing);
      if (vote.weight > 0.0) normal = vote.direction;
    }
    const double overlap = std::min(extent, crossing.overlap_along(normal));
    overlaps += overlap;
    room[i] = {crossing.middle() + meshes.origin_a(), normal, std::min(given, overlap), sample.hits[i].a,
               sample.hits[i].b};
  }
  const double near = tolerances::hasty_spacing * size;
  const std::size_t all =
      pair.haste.add_to(room, count, each_its_own || known == 0 ? nullptr : &direction, pose_b_in_a, near);
  limit_depths(room.first(all), given);
  pair.haste.guessed.note(overlaps / (static_cast<double>(count) * size));
  double deepest = 0.0;
  for (const Contact& contact : room.first(all)) deepest = std::max(deepest, contact.depth);
  pair.haste.remember(room.first(count), pose_b_in_a, near);
  if (!pair.known_depth.known()) pair.known_depth.note(meshes.pose(), deepest);
  pair.answer.contacts = room.first(all);
  pair.answer.contact_pairs = static_cast<std::uint32_t>(sample.count);
  return true;
}

bool recall_guess(const math::Pose& pose_b_in_a, const Request& request, Pair::Implementation& pair) noexcept {
  const double size = smaller_size(pair);
  const std::span<Contact> room = room_for_contacts(request, pair);
  const std::size_t count = pair.haste.add_to(room, 0, nullptr, pose_b_in_a, tolerances::hasty_spacing * size);
  if (count == 0) return false;
  limit_depths(room.first(count), pair.haste.guessed.most() * size);
  pair.answer.contacts = room.first(count);
  pair.answer.contact_pairs = static_cast<std::uint32_t>(count);
  return true;
}

}  // namespace odds::query
