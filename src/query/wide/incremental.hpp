// The incremental search: from a kinetic front.
#pragma once

#include "query/wide/opening.hpp"

namespace odds::query::wide {

/// Looks at what has expired in the front, and goes down from there. As exact as a search from the roots: every pair of
/// triangles is below a lane that was apart by more than the motion since, or is looked at.
template <class L>
class Incremental {
 public:
  static void run(Task& task, KineticFront& front) noexcept {
    Incremental search(task, front);
    search.run();
    front.note_end();
  }

 private:
  /// Entries passed over between two looks at the clock: some 250 ns.
  static constexpr std::uint32_t entries_between_polls = 256;

  Incremental(Task& task, KineticFront& front) noexcept : task_(task), met_(task.encounter), front_(front) {}

  void run() noexcept {
    const std::uint32_t kept = front_.size();
    for (std::uint32_t i = 0; i < kept; ++i) {
      if (!front_.expired(i)) {
        if (i % entries_between_polls == entries_between_polls - 1 && !task_.spending.may_go_on()) {
          task_.result.ended = Progressed::spent;
          return leave_rest_open(i + 1, kept);
        }
        continue;
      }
      if (!may_go_on()) return leave_rest_open(i, kept);
      KineticFront::Entry& entry = front_.entry(i);
      if (met_.are_leaves(entry.a, entry.b)) {
        front_.set_expiry(i, KineticFront::at_once);
        double expiry = KineticFront::at_once;
        if (!test_leaves(entry.a, entry.b, expiry)) return leave_rest_open(i + 1, kept);
        front_.set_expiry(i, expiry);
      } else {
        front_.set_expiry(i, open(entry));
      }
      if (!go_down()) return leave_rest_open(i + 1, kept);
    }
  }

  /// Notes what has expired and was not looked at, among the next of the `kept` ones.
  void leave_rest_open(std::uint32_t from, std::uint32_t kept) noexcept {
    if (task_.result.ended != Progressed::spent) return;
    const std::uint32_t end = std::min(kept, from + entries_between_polls);
    for (std::uint32_t i = from; i < end && !task_.result.shortlist.full(); ++i) {
      if (front_.expired(i)) leave_open<L>(task_, {front_.entry(i).a, front_.entry(i).b, unranked});
    }
  }

  [[nodiscard]] bool may_go_on() noexcept {
    if (task_.spending.may_go_on_after(units_between_polls) && task_.spending.allows(wide_lanes)) {
      return true;
    }
    task_.result.ended = Progressed::spent;
    return false;
  }

  /// Puts the lanes that overlap and were not open on the stack; returns when the others must be looked at again.
  double open(KineticFront::Entry& entry) noexcept {
    const Expanded<L> expanded = expand<L>(met_, {{entry.a, entry.b}});
    task_.spending.spend_node_pairs(wide_lanes);
    stack_.add<false>(expanded, expanded.lanes & ~entry.opened);
    entry.opened |= expanded.lanes;
    alignas(64) float gap[wide_lanes];
    L::store(gap, expanded.gaps);
    float least = 1e30F;  // empty lanes are farther
    for (std::uint32_t lane = 0; lane < wide_lanes; ++lane) {
      if ((entry.opened >> lane & 1U) == 0) least = std::min(least, gap[lane]);
    }
    return front_.travelled() + static_cast<double>(least) - static_cast<double>(met_.margin());
  }

  /// Down from the stack. False ends the search; what it did not look into is kept as expired.
  bool go_down() noexcept {
    while (stack_.size != 0) {
      if (!may_go_on()) return leave();
      const SlotPair pair = stack_.take();
      KineticFront::Entry entry{pair.of[0], pair.of[1], 0};
      double expiry = KineticFront::at_once;
      bool goes_on = true;
      if (met_.are_leaves(entry.a, entry.b)) {
        goes_on = test_leaves(entry.a, entry.b, expiry);
      } else {
        expiry = open(entry);
      }
      front_.add(entry, expiry);
      if (!goes_on) return leave();
    }
    return true;
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
    while (stack_.size != 0) {
      const SlotPair pair = stack_.take();
      front_.add({pair.of[0], pair.of[1], 0}, KineticFront::at_once);
    }
    return false;
  }

  bool test_leaves(Slot a, Slot b, double& expiry) noexcept {
    const std::size_t hits = task_.hits.size();
    if (!visit_leaves<L>(task_, a, b)) {
      if (task_.result.ended == Progressed::spent) leave_open<L>(task_, {a, b, unranked});
      return false;
    }
    if (task_.hits.size() == hits) {
      const float gap = gap_of_leaves(a, b);
      if (gap > 0.0F) expiry = front_.travelled() + static_cast<double>(gap);
    }
    return true;
  }

  [[nodiscard]] float gap_of_leaves(Slot slot_a, Slot slot_b) const noexcept {
    float shift[3];
    met_.shift(slot_a, slot_b, shift);
    return leaf_gap<L>(met_.leaf(0, slot_a), met_.leaf(1, slot_b), met_.turn_into(0), shift, met_.margin());
  }

  Task& task_;
  const Encounter& met_;
  KineticFront& front_;
  Slot slots_[2][wide_stack_capacity];
  SlotPairs stack_{{slots_[0], slots_[1]}};
};

}  // namespace odds::query::wide
