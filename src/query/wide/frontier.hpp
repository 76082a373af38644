// What a search of the wide engine has yet to look into: open pairs and pairs of leaves.
#pragma once

#include "query/wide/open_pairs.hpp"

namespace odds::query::wide {

/// Shared by the parts of an exact search, one after the other. It starts with one pair, open or of leaves.
template <class L>
class Frontier {
 public:
  /// With more than these open the newest is opened, one at a time, and then seven more a level are all there can be.
  static constexpr std::size_t crowded = wide_stack_capacity / 2;
  static constexpr std::size_t most_leaf_pairs = (Opener<L>::most + 1) * wide_lanes;

 private:
  LaneAddress open_lanes_[2][crowded + (Opener<L>::most + 2) * wide_lanes + wide_stack_capacity];
  Slot leaf_slots_[2][most_leaf_pairs];

 public:
  Task& task;
  const Encounter& met;
  const Opener<L> opener;
  OpenPairs open{open_lanes_[0], open_lanes_[1]};
  SlotPairs leaf_pairs{{leaf_slots_[0], leaf_slots_[1]}};
  const Sweep::MetLeaves* looked_at = nullptr;  ///< in this run already, if not null: passed over

  Frontier(Task& given, Slot start_a, Slot start_b) noexcept
      : task(given), met(given.encounter), opener(given.encounter) {
    start(start_a, start_b);
  }
  Frontier(const Frontier&) = delete;
  Frontier& operator=(const Frontier&) = delete;

  /// With one pair, and nothing else.
  void start(Slot start_a, Slot start_b) noexcept {
    open.size = leaf_pairs.size = 0;
    if (met.are_leaves(start_a, start_b)) {
      leaf_pairs.of[0][0] = start_a;
      leaf_pairs.of[1][0] = start_b;
      leaf_pairs.size = 1;
    } else {
      open.add(met, {{start_a, start_b}});
    }
  }

  /// Whether the budget allows to open one more pair.
  [[nodiscard]] bool may_open() noexcept {
    return task.spending.may_go_on_in_time(units_between_polls) && task.spending.allows(wide_lanes);
  }

  /// False: the search has ended. If for the budget, the pairs of leaves are left open.
  bool visit_leaf_pairs() noexcept {
    while (leaf_pairs.size != 0) {
      if (!may_open()) {
        task.result.ended = Progressed::spent;
        leave_leaf_pairs();
        return false;
      }
      if (task.spending.nears_end()) ask_for_statistics();
      const SlotPair pair = leaf_pairs.take();
      if (looked_at != nullptr && looked_at->has({pair.of[0], pair.of[1]})) continue;
      if (visit_leaves<L>(task, pair.of[0], pair.of[1])) continue;
      if (task.result.ended == Progressed::spent) {
        leave_open<L>(task, {pair.of[0], pair.of[1], unranked});
        leave_leaf_pairs();
      }
      return false;
    }
    return true;
  }

  /// Of the pairs that are left open if the search ends now.
  void ask_for_statistics() const noexcept {
    for (std::size_t i = leaf_pairs.size; i-- != 0 && leaf_pairs.size - i <= Shortlist::capacity;) {
      met.prefetch({leaf_pairs.of[0][i], leaf_pairs.of[1][i], unranked});
    }
    for (std::size_t i = open.size; i-- != 0 && open.size - i <= Shortlist::capacity;) {
      const SlotPair pair = open.pair(i);
      met.prefetch({pair.of[0], pair.of[1], unranked});
    }
  }

  /// Leaves the open pairs open. The newest lie deepest, in trees and in the other body.
  void leave_newest() noexcept {
    const std::uint32_t all = task.result.open + static_cast<std::uint32_t>(open.size);
    for (std::size_t i = open.size; i-- != 0 && open.size - i <= most_ranked;) {
      const SlotPair pair = open.pair(i);
      leave_open<L>(task, {pair.of[0], pair.of[1], unranked});
    }
    task.result.open = all;
  }

 private:
  static constexpr std::size_t most_ranked = 4;  // each costs as much as opening a pair

  void leave_leaf_pairs() noexcept {
    const std::uint32_t all = task.result.open + static_cast<std::uint32_t>(leaf_pairs.size);
    for (std::size_t i = leaf_pairs.size; i-- != 0 && leaf_pairs.size - i <= most_ranked;) {
      leave_open<L>(task, {leaf_pairs.of[0][i], leaf_pairs.of[1][i], unranked});
    }
    task.result.open = all;
  }
};

}  // namespace odds::query::wide
