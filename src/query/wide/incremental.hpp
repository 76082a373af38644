// The incremental search: from a kinetic front.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "query/spread_step.hpp"
#include "query/wide/opening.hpp"
#include "query/wide/part_leaves.hpp"

namespace odds::query::wide {

/// Looks at what has expired in the front, and goes down from there. As exact as a search from the roots: every pair of
/// triangles is below a lane that was apart by more than the motion since, or is parted by a plane, or is looked at.
template <class L>
class Incremental {
 public:
  static void run(Task& task, KineticFront& front) noexcept {
    Incremental search(task, front);
    search.outcome_.resume_at = search.run();
    search.outcome_.work = search.spent();
    search.outcome_.starved = task.result.ended == Progressed::spent;
    search.outcome_.irreplaceable = !is_enough_from_roots(task.request.budget);
    front.note_end(search.outcome_);
  }

 private:
  /// Entries passed over, and planes asked, between two looks at the clock: some 100 ns.
  static constexpr std::uint32_t entries_between_polls = 256;
  static constexpr std::uint32_t planes_between_polls = 8;

  Incremental(Task& task, KineticFront& front) noexcept : task_(task), met_(task.encounter), front_(front) {}

  /// The entries that met, then those that the last search was going down into when it ended, so that even a few pairs
  /// a run get to the leaves; then the others from where the last search stopped. Returns where this one stopped.
  std::uint32_t run() noexcept {
    const std::uint32_t kept = front_.size();
    const std::uint32_t crossing = front_.crossing();
    const std::uint32_t left = std::clamp(front_.left_at(), crossing, kept);
    const std::uint32_t middle = std::clamp(front_.resume_at(), crossing, left);
    outcome_.left_at = left;
    const bool all = look_at_crossing(crossing);
    if (goes_on() && task_.hits.empty() && !is_enough_from_roots(task_.request.budget)) look_around();
    if (!goes_on()) {
      leave_rest_open(0, crossing);
      leave_rest_open(left, kept);
      leave_rest_open(middle, left);
      return middle;
    }
    const std::uint32_t stopped = look_at_others(crossing, middle, left, kept);
    if (!goes_on() && first_left_ != no_feature) outcome_.left_at = first_left_;
    if (!all && goes_on()) task_.result.ended = task_.hits.empty() ? Progressed::spent : Progressed::enough;
    return stopped;
  }

  std::uint32_t look_at_others(std::uint32_t crossing, std::uint32_t middle, std::uint32_t left,
                               std::uint32_t kept) noexcept {
    outcome_.left_at = look_at(left, kept);
    if (!goes_on()) leave_rest_open(middle, left);
    if (!goes_on() || outcome_.left_at != kept) return middle;
    std::uint32_t stopped = look_at(middle, left);
    if (!goes_on()) {
      leave_rest_open(crossing, middle);
      return stopped == left ? crossing : stopped;
    }
    if (stopped != left) return stopped;
    stopped = look_at(crossing, middle);
    outcome_.explored = stopped == middle && goes_on();
    return stopped;
  }

  [[nodiscard]] bool goes_on() const noexcept { return task_.result.ended == Progressed::finished; }

  /// In an order that is spread over all, so that an early end leaves a sample of the rim; on from where the last
  /// search had to leave off. Leaves time for what has begun to meet elsewhere. False if not all were looked at.
  bool look_at_crossing(std::uint32_t count) noexcept {
    if (count == 0) return true;
    constexpr double time_share = 0.375;  // of which contacts leave half to the search
    constexpr double work_share = 0.75;
    task_.spending.begin_start(time_share, work_share);
    const auto step = static_cast<std::uint32_t>(spread_step(count));
    std::uint32_t i = front_.next_crossing() % count;
    for (std::uint32_t k = 0; k < count; ++k, i = (i + step) % count) {
      outcome_.next_crossing = i;
      if (task_.hits.size() >= task_.sample) {
        if (!front_.is_fresh()) last_unit_ = spent() + spent() / 2;
        return false;
      }
      if (!task_.spending.start_may_go_on_after(units_between_polls) || !may_go_on()) return false;
      const bool more = look_at(i);
      if (more || task_.result.ended == Progressed::enough) {
        ++outcome_.looked_at;
        if (front_.entry(i).met) ++outcome_.still_met;
      }
      if (more) continue;
      if (k == 0) outcome_.next_crossing = (i + step) % count;  // else one that takes more than a run would be all
      return false;
    }
    outcome_.next_crossing = 0;
    return true;
  }

  /// What slides on goes from one leaf to the next: the neighbours of the two that met last, where none of those that
  /// met is left. Far sooner there than in the order of the front. No more of them meet than can be told from entries
  /// afterwards.
  void look_around() noexcept {
    KineticFront::LastMet& last = front_.last_met();
    if (!last.known) return;
    last.known = false;
    const SlotPair from{{last.a, last.b}};
    if (!last.is_entry && !look_at_leaves(from)) return;
    for (std::uint32_t side = 0; side < 2 && task_.hits.empty(); ++side) {
      if (!may_go_on()) return;
      task_.spending.spend_node_pairs(wide_lanes);
      SlotPair pair = from;
      const Slot first = from.of[side] - from.of[side] % wide_lanes;
      for (unsigned lanes = overlapping_neighbours<L>(met_, side, from); lanes != 0 && !around_.is_full();
           lanes &= lanes - 1U) {
        pair.of[side] = first + static_cast<Slot>(std::countr_zero(lanes));
        if (pair.of[side] == from.of[side] || !met_.are_leaves(pair.of[0], pair.of[1])) continue;
        if (!look_at_leaves(pair)) return;
      }
    }
  }
  /// Two leaves that need not be an entry. False ends the search.
  bool look_at_leaves(const SlotPair& pair) noexcept {
    if (!may_go_on()) return false;
    const std::size_t hits = task_.hits.size();
    const bool goes_on = visit_leaves<L>(task_, pair.of[0], pair.of[1]);
    if (task_.hits.size() > hits) {
      note_met(pair.of[0], pair.of[1], false);
      around_.note({pair.of[0], pair.of[1]});
    }
    return goes_on;
  }
  void note_met(Slot a, Slot b, bool is_entry) noexcept { front_.last_met() = {a, b, is_entry, true}; }
  /// Whether its hits are known already in this run.
  [[nodiscard]] bool was_met_around(Slot a, Slot b) const noexcept { return around_.has({a, b}); }

  [[nodiscard]] std::uint64_t spent() const noexcept {
    const Cost& cost = task_.spending.so_far();
    return cost.node_pairs + cost.triangle_pairs;
  }

  /// Returns the first entry that was not done with, or `end`.
  std::uint32_t look_at(std::uint32_t begin, std::uint32_t end) noexcept {
    std::uint32_t i = begin;
    std::uint32_t next_poll = std::min(end, begin + entries_between_polls);
    while (i < end) {
      i = front_.next_expired(i, next_poll);
      if (i == next_poll) {
        next_poll = std::min(end, i + entries_between_polls);
        if (i == end || task_.spending.may_go_on()) continue;
        task_.result.ended = Progressed::spent;
        leave_rest_open(i, end);
        return i;
      }
      if (front_.is_parted(i)) {
        task_.spending.hasten_poll(1);
        ++i;
        next_poll = std::min(next_poll, i + planes_between_polls);
        continue;
      }
      if (spent() >= last_unit_) return i;
      if (!may_go_on()) {
        leave_rest_open(i, end);
        return i;
      }
      if (!look_at(i)) {
        leave_rest_open(i + 1, end);
        return i == begin ? i + 1 : i;  // else one that takes more than a whole run would be all that is looked at
      }
      ++i;
    }
    return end;
  }

  /// Tests one entry anew and goes down from it. False ends the search.
  bool look_at(std::uint32_t i) noexcept {
    KineticFront::Entry& entry = front_.entry(i);
    if (!met_.are_leaves(entry.a, entry.b)) {
      front_.set_expiry(i, open(entry));
      return go_down();
    }
    const std::size_t hits = task_.hits.size();
    bool close = false;
    const bool goes_on = test_leaves(entry.a, entry.b, close);
    const bool met = task_.hits.size() > hits || was_met_around(entry.a, entry.b);
    front_.set_met(i, met || (!goes_on && entry.met));
    Parting parting;
    // Leaves that are looked at again are near each other for a while, where a plane is worth its time.
    if (goes_on && !met) {
      const LaneNumbers leaf_b = met_.numbers(1, entry.b);
      const bool by_plane = looks_for_plane(i, leaf_b);
      const bool tried = (by_plane || !close) && part(entry.a, entry.b, by_plane, parting);
      if (tried && by_plane) front_.note_parting(i, parting, leaf_b);
      if (by_plane && !parting.parts) ++planes_missed_;
    }
    front_.set_expiry(i, expiry_of(parting));
    return goes_on;
  }

  /// Notes what has expired and was not looked at, among the next of the `kept` ones.
  void leave_rest_open(std::uint32_t from, std::uint32_t kept) noexcept {
    if (task_.result.ended != Progressed::spent || !task_.hits.empty()) return;  // beside a hit nobody asks
    const std::uint32_t end = std::min(kept, from + entries_between_polls);
    for (std::uint32_t i = from; i < end && !task_.result.shortlist.full(); ++i) {
      if (front_.expired(i)) leave_open<L>(task_, {front_.entry(i).a, front_.entry(i).b, unranked});
    }
  }

  [[nodiscard]] bool may_go_on() noexcept {
    if (task_.spending.may_go_on_in_time(units_between_polls) && task_.spending.allows(wide_lanes)) {
      return true;
    }
    task_.result.ended = Progressed::spent;
    return false;
  }

  /// Puts the lanes that overlap and were not open on the stack; returns when the others must be looked at again.
  double open(KineticFront::Entry& entry) noexcept {
    const Expanded<L> expanded = expand<L>(met_, {{entry.a, entry.b}});
    task_.spending.spend_node_pairs(wide_lanes);
    const unsigned lanes = expanded.lanes & ~static_cast<unsigned>(entry.opened);
    // Taken first is what comes last: leaves, then the deepest overlap, where a hit is found soonest.
    const unsigned inner = lanes & ~expanded.leaf_lanes;
    const unsigned deepest = 1U << L::least(expanded.gaps);
    stack_.add(expanded, inner & ~deepest);
    stack_.add(expanded, inner & deepest);
    stack_.add(expanded, lanes & expanded.leaf_lanes);
    entry.opened = static_cast<std::uint8_t>(entry.opened | expanded.lanes);
    alignas(64) float gap[wide_lanes];
    L::store(gap, expanded.gaps);
    keep_near(expanded, gap, entry);
    float least = 1e30F;  // empty lanes are farther
    for (std::uint32_t lane = 0; lane < wide_lanes; ++lane) {
      if ((entry.opened >> lane & 1U) == 0) least = std::min(least, gap[lane]);
    }
    return expiry_of_gap(least);
  }

  /// Lanes that are apart by little become entries of their own, so that they do not have all others looked at again.
  void keep_near(const Expanded<L>& expanded, const float (&gap)[wide_lanes], KineticFront::Entry& entry) noexcept {
    // Where B moves by much of a node in a run, others are near each other soon.
    const float radius = std::sqrt(squared_radius(met_.numbers(1, entry.b)));
    // A budget of a few pairs has none for each of them, and beside a hit nobody asks.
    if (front_.skin() > 0.5 * static_cast<double>(radius) || !front_.has_room_for_near() ||
        !is_enough_from_roots(task_.request.budget) || !task_.hits.empty()) {
      return;
    }
    const float skin = met_.margin() + static_cast<float>(front_.skin());
    const unsigned near = L::less_equal(expanded.gaps, L::all(skin)) & ~static_cast<unsigned>(entry.opened);
    entry.opened = static_cast<std::uint8_t>(entry.opened | near);
    for (unsigned lanes = near; lanes != 0; lanes &= lanes - 1U) {
      const auto lane = static_cast<unsigned>(std::countr_zero(lanes));
      const Slot slots[2] = {expanded.first + lane, expanded.other};
      front_.add({slots[expanded.side], slots[1 - expanded.side]}, expiry_of_gap(gap[lane]));
    }
  }
  [[nodiscard]] double expiry_of_gap(float gap) const noexcept {
    return front_.travelled() + static_cast<double>(gap) - static_cast<double>(met_.margin());
  }

  /// Down from the stack. False ends the search; what it did not look into is kept as expired.
  bool go_down() noexcept {
    while (stack_.size != 0) {
      if (!may_go_on()) return leave();
      const SlotPair pair = stack_.take();
      KineticFront::Entry entry{pair.of[0], pair.of[1], 0};
      double expiry = KineticFront::at_once;
      const std::size_t hits = task_.hits.size();
      bool goes_on = true;
      if (met_.are_leaves(entry.a, entry.b)) {
        bool close = false;
        goes_on = test_leaves(entry.a, entry.b, close);
        if (goes_on && !close && !was_met_around(entry.a, entry.b)) {
          Parting parting;
          part(entry.a, entry.b, false, parting);
          expiry = expiry_of(parting);
        }
      } else {
        expiry = open(entry);
      }
      entry.met = task_.hits.size() > hits || was_met_around(entry.a, entry.b);
      if (!goes_on && !entry.met) first_left_ = front_.size();  // what met is looked at first as it is
      front_.add(entry, expiry);
      if (!goes_on) return leave();
      if (entry.met && task_.wanted > 1) go_elsewhere();
    }
    return true;
  }

  /// After a hit, to an open pair that follows no order, as DepthFirst does: what is found until an early end comes
  /// from all over the rim. Going down from there needs as much room again at most.
  void go_elsewhere() noexcept {
    if (stack_.size < 2 || stack_.size > wide_stack_capacity) return;
    stack_.bring_up(elsewhere(task_.hits.size(), stack_.size - 1));
  }

  bool leave() noexcept {
    if (task_.result.ended == Progressed::spent) {
      constexpr std::size_t most_ranked = 4;  // each costs as much as opening a pair
      const std::uint32_t open = task_.result.open + static_cast<std::uint32_t>(stack_.size);
      for (std::size_t i = stack_.size; i-- != 0 && stack_.size - i <= most_ranked;) {
        leave_open<L>(task_, {stack_.of[0][i], stack_.of[1][i], unranked});
      }
      task_.result.open = open;
    }
    if (first_left_ == no_feature) first_left_ = front_.size();
    while (stack_.size != 0) {
      const SlotPair pair = stack_.take();
      front_.add({pair.of[0], pair.of[1], 0}, KineticFront::at_once);
    }
    return false;
  }

  /// `close`: single precision sees no gap. False ends the search.
  bool test_leaves(Slot a, Slot b, bool& close) noexcept {
    if (was_met_around(a, b)) {
      KineticFront::LastMet& last = front_.last_met();
      last.is_entry = last.is_entry || (last.a == a && last.b == b);
      return true;
    }
    const std::size_t hits = task_.hits.size();
    const LeafPairs pairs = compare_leaves<L>(task_, a, b);
    close = pairs.rows != 0;
    const bool goes_on = visit_triangles(task_, a, b, pairs);
    if (task_.hits.size() > hits) note_met(a, b, true);
    if (!goes_on && task_.result.ended == Progressed::spent) leave_open<L>(task_, {a, b, unranked});
    return goes_on;
  }

  /// Not beside a hit: that is all a verdict wants, and contacts want the time. Nor where none is found: faces that lie
  /// on each other are near each other everywhere, and no plane parts them.
  [[nodiscard]] bool looks_for_plane(std::uint32_t i, const LaneNumbers& leaf_b) noexcept {
    constexpr std::uint32_t enough_missed = 4;  // in a run
    return task_.hits.empty() && planes_missed_ < enough_missed && front_.takes_look(i, leaf_b) &&
           task_.spending.may_go_on() && !task_.spending.nears_end();
  }

  /// Of two leaves that do not meet. False: there was no time for all of it.
  bool part(Slot a, Slot b, bool by_plane, Parting& parting) noexcept {
    float shift[3];
    met_.shift(a, b, shift);
    const PlacedLeaf leaf_a = met_.leaf(0, a);
    const PlacedLeaf leaf_b = met_.leaf(1, b);
    const SpreadLeaves<L> leaves(leaf_a, leaf_b, met_.turn_into(0), shift, met_.margin());
    task_.spending.hasten_poll(units_between_polls);
    if (by_plane) {
      part_by_triangles<L>(leaves, leaf_a.count(), leaf_b.count(), parting);
      if (parting.parts) return true;
    }
    const GapsOfTriangles<L> gaps(leaves, leaf_b.count());
    parting.gap = gaps.least;
    if (!by_plane) return true;
    if (!task_.spending.may_go_on()) return false;
    const Vec3 way = met_.shortest_way(leaf_a.leaf.triangle[gaps.lane], leaf_b.leaf.triangle[gaps.row]);
    part_by_nearest<L>(leaves, gaps, way, parting);
    return true;
  }
  [[nodiscard]] double expiry_of(const Parting& parting) const noexcept {
    const float gap = parting.parts ? std::max(parting.gap, std::min(parting.along, parting.beside)) : parting.gap;
    return gap > 0.0F ? front_.travelled() + static_cast<double>(gap) : KineticFront::at_once;
  }

  Task& task_;
  const Encounter& met_;
  KineticFront& front_;
  KineticFront::Outcome outcome_;
  std::uint64_t last_unit_ = std::numeric_limits<std::uint64_t>::max();  ///< for what is not yet known to meet
  std::uint32_t first_left_ = no_feature;
  std::uint32_t planes_missed_ = 0;
  FewLeafPairs<8> around_;
  Slot slots_[2][2 * wide_stack_capacity];
  SlotPairs stack_{{slots_[0], slots_[1]}};
};

}  // namespace odds::query::wide
