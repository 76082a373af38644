// The exact search: as Algorithm 4.2, a few pairs at a time.
#pragma once

#include "query/wide/open_pairs.hpp"

namespace odds::query::wide {

/// The newest few pairs are opened at a time: what is found below one says which pair is next, so that one pair after
/// the other would wait for the end of every sum, and for its numbers from memory. What remains is kept without
/// branches that nobody could predict.
///
/// Where contacts are wanted and a budget may end the search, it does not go on beside a hit but somewhere else: the
/// hits that are found until then come from all over the rim, and contacts made of them hold a body on all sides.
///
/// Where one hit is enough and no budget may end the search, six pairs are opened at a time, as they come. If
/// `ordered`, where a budget may end it or several hits are kept, two, the deepest overlap first: it is where a hit is
/// found soonest.
template <class L, bool ordered = true>
class DepthFirst {
 public:
  static void run(Task& task, Slot start_a, Slot start_b) noexcept {
    if (task.wanted > 1 || task.request.budget.is_limited()) {
      DepthFirst<L>(task, task.wanted > 1 && task.request.budget.is_limited()).run(start_a, start_b);
    } else {
      DepthFirst<L, false>(task).run(start_a, start_b);
    }
  }

  /// `spreads`: it goes on elsewhere after a hit.
  explicit DepthFirst(Task& task, bool spreads = false) noexcept
      : task_(task), met_(task.encounter), opener_(task.encounter), hits_(task.hits.size()), spreads_(spreads) {}

  void run(Slot start_a, Slot start_b) noexcept {
    if (met_.are_leaves(start_a, start_b)) {
      leaf_pairs_.of[0][0] = start_a;
      leaf_pairs_.of[1][0] = start_b;
      leaf_pairs_.size = 1;
    } else {
      open_.add(met_, {{start_a, start_b}});
    }
    while (open_.size != 0 || leaf_pairs_.size != 0) {
      if (leaf_pairs_.size != 0) {
        if (!visit_leaf_pairs()) return;
        if (spreads_) go_elsewhere();
        continue;
      }
      if (!task_.spending.may_go_on_after(units_between_polls) || !task_.spending.allows(wide_lanes)) return stop();
      if (task_.spending.nears_end()) ask_for_statistics();
      open_newest();
    }
  }

 private:
  void open_newest() noexcept {
    const std::size_t allowed = std::max<std::size_t>(1, task_.spending.units_left() / wide_lanes);
    const std::size_t most = open_.size <= crowded ? std::min(at_once, allowed) : 1;
    const auto count = static_cast<std::uint32_t>(std::min(open_.size, most));
    open_.size -= count;
    task_.spending.spend_node_pairs(count * wide_lanes);
    opener_.template run<ordered>(count, open_, leaf_pairs_);
  }

  /// After a hit, to an open pair that follows no order. Not while crowded: what bounds the room is that then the
  /// newest is opened, always.
  void go_elsewhere() noexcept {
    if (task_.hits.size() == hits_ || open_.size < 2 || open_.size > crowded) return;
    hits_ = task_.hits.size();
    open_.bring_up(elsewhere(hits_, open_.size - 1));
  }

  bool visit_leaf_pairs() noexcept {
    while (leaf_pairs_.size != 0) {
      if (!task_.spending.may_go_on_after(units_between_polls) || !task_.spending.allows(wide_lanes)) {
        stop();
        return false;
      }
      if (task_.spending.nears_end()) ask_for_statistics();
      const SlotPair pair = leaf_pairs_.take();
      if (visit_leaves<L>(task_, pair.of[0], pair.of[1])) continue;
      if (task_.result.ended == Progressed::spent) {
        leave_open<L>(task_, {pair.of[0], pair.of[1], unranked});
        leave_rest_open();
      }
      return false;
    }
    return true;
  }

  /// Of the pairs that are left open if the search ends now.
  void ask_for_statistics() const noexcept {
    for (std::size_t i = leaf_pairs_.size; i-- != 0 && leaf_pairs_.size - i <= Shortlist::capacity;) {
      met_.prefetch({leaf_pairs_.of[0][i], leaf_pairs_.of[1][i], unranked});
    }
    for (std::size_t i = open_.size; i-- != 0 && open_.size - i <= Shortlist::capacity;) {
      const SlotPair pair = open_.pair(i);
      met_.prefetch({pair.of[0], pair.of[1], unranked});
    }
  }

  void stop() noexcept {
    task_.result.ended = Progressed::spent;
    leave_rest_open();
  }

  /// Of what is open the newest lies deepest, in trees and in the other body.
  void leave_rest_open() noexcept {
    constexpr std::size_t most_ranked = 4;  // each costs as much as opening a pair
    const std::uint32_t open = task_.result.open + static_cast<std::uint32_t>(leaf_pairs_.size + open_.size);
    task_.result.open = open;
    if (!task_.hits.empty()) return;  // nobody asks where else
    for (std::size_t i = leaf_pairs_.size; i-- != 0 && leaf_pairs_.size - i <= most_ranked;) {
      leave_open<L>(task_, {leaf_pairs_.of[0][i], leaf_pairs_.of[1][i], unranked});
    }
    for (std::size_t i = open_.size; i-- != 0 && open_.size - i <= most_ranked;) {
      const SlotPair pair = open_.pair(i);
      leave_open<L>(task_, {pair.of[0], pair.of[1], unranked});
    }
    task_.result.open = open;
  }

  /// Pairs. Of 1 to 8 these are fastest: more waste less time waiting, and open more for nothing where there is a hit.
  static constexpr std::size_t at_once = ordered ? 2 : 6;
  static_assert(at_once <= Opener<L>::most);
  /// With more than these open one pair is opened at a time, and then seven more a level are all there can be.
  static constexpr std::size_t crowded = wide_stack_capacity / 2;
  static constexpr std::size_t capacity = crowded + (at_once + 2) * wide_lanes + wide_stack_capacity;

  Task& task_;
  const Encounter& met_;
  Opener<L> opener_;
  std::size_t hits_;
  bool spreads_;
  LaneAddress open_lanes_[2][capacity];
  Slot leaf_slots_[2][(at_once + 1) * wide_lanes];
  OpenPairs open_{open_lanes_[0], open_lanes_[1]};
  SlotPairs leaf_pairs_{{leaf_slots_[0], leaf_slots_[1]}};
};

}  // namespace odds::query::wide
