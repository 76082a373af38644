// The exact search: as Algorithm 4.2, two pairs at a time.
#pragma once

#include "query/wide/opening.hpp"

namespace odds::query::wide {

/// Two pairs are opened at a time: each waits for its numbers most of its time, and neither waits for the other. What
/// remains is kept without branches that nobody could predict.
///
/// Where contacts are wanted and a budget may end the search, it does not go on beside a hit but somewhere else: the
/// hits that are found until then come from all over the rim, and contacts made of them hold a body on all sides.
///
/// As the start of another search (`ranked`) it ends early, keeps the ranks of what is open, and leaves it to that.
template <class L, bool ranked = false>
class DepthFirst {
 public:
  static void run(Task& task, Slot start_a, Slot start_b) noexcept {
    DepthFirst search(task);
    search.run(start_a, start_b);
  }

  explicit DepthFirst(Task& task) noexcept
      : task_(task),
        met_(task.encounter),
        hits_(task.hits.size()),
        spreads_(task.wanted > 1 && task.request.budget.is_limited()) {}

  [[nodiscard]] const SlotPairs& open() const noexcept { return open_; }
  [[nodiscard]] const SlotPairs& leaf_pairs() const noexcept { return leaf_pairs_; }

  void run(Slot start_a, Slot start_b) noexcept {
    const bool leaves = met_.are_leaves(start_a, start_b);
    SlotPairs& start = leaves ? leaf_pairs_ : open_;
    start.of[0][0] = start_a;
    start.of[1][0] = start_b;
    start.size = 1;
    if constexpr (ranked) open_.ranks[0] = 0.0F;
    while (open_.size != 0 || leaf_pairs_.size != 0) {
      if constexpr (ranked) {
        if (!task_.spending.start_may_go_on_after(units_between_polls)) return;
      }
      if (leaf_pairs_.size >= leaf_batch || open_.size == 0) {
        if (!visit_leaf_pairs()) return;
        if (spreads_) go_elsewhere();
        continue;
      }
      if (!task_.spending.may_go_on_after(units_between_polls) || !task_.spending.allows(2 * wide_lanes)) return stop();
      if (task_.spending.nears_end()) ask_for_statistics();
      const Expanded<L> first = expand<L, ranked>(met_, open_.take());
      if (open_.size != 0) {
        const Expanded<L> second = expand<L, ranked>(met_, open_.take());
        task_.spending.spend_node_pairs(2 * wide_lanes);
        keep(second);
      } else {
        task_.spending.spend_node_pairs(wide_lanes);
      }
      keep(first);
    }
  }

 private:
  /// After a hit, to an open pair that follows no order; going down from there needs as much room again at most.
  void go_elsewhere() noexcept {
    if (task_.hits.size() == hits_ || open_.size < 2 || open_.size > wide_stack_capacity) return;
    hits_ = task_.hits.size();
    open_.bring_up<ranked>(elsewhere(hits_, open_.size - 1));
  }

  /// The deepest overlap is pushed last and so visited first: it is where a hit is found soonest.
  ODDS_LANES_INLINE void keep(const Expanded<L>& expanded) noexcept {
    if (expanded.leaf_lanes != 0) leaf_pairs_.add<false>(expanded, expanded.leaf_lanes);
    const unsigned inner = expanded.lanes & ~expanded.leaf_lanes;
    const unsigned deepest = 1U << L::least(expanded.gaps);
    open_.add<ranked>(expanded, inner & ~deepest);
    open_.add<ranked>(expanded, inner & deepest);
    prefetch(met_.nodes(expanded.side), expanded.first, static_cast<std::uint32_t>(std::countr_zero(deepest)));
  }

  /// Asks the caches for the node below a lane, which is probably opened next (measured: 5 % on poses that are new).
  ODDS_LANES_INLINE static void prefetch(const WideNode* nodes, Slot first, std::uint32_t lane) noexcept {
    const tree::ChildRef child = nodes[first / wide_lanes].child[lane];
    if (child.is_leaf()) return;
    const auto* node = reinterpret_cast<const char*>(nodes + child.index());
    for (std::size_t line = 0; line < sizeof(WideNode); line += 64) __builtin_prefetch(node + line);
  }

  bool visit_leaf_pairs() noexcept {
    while (leaf_pairs_.size != 0) {
      if (!task_.spending.may_go_on_after(units_between_polls) || !task_.spending.allows(wide_lanes)) {
        stop();
        return false;
      }
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
    for (const SlotPairs* pairs : {&leaf_pairs_, &open_}) {
      for (std::size_t i = pairs->size; i-- != 0 && pairs->size - i <= Shortlist::capacity;) {
        met_.prefetch({pairs->of[0][i], pairs->of[1][i], unranked});
      }
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
    for (const SlotPairs* pairs : {&leaf_pairs_, &open_}) {
      for (std::size_t i = pairs->size; i-- != 0 && pairs->size - i <= most_ranked;) {
        const float rank = ranked && pairs == &open_ ? pairs->ranks[i] : unranked;
        leave_open<L>(task_, {pairs->of[0][i], pairs->of[1][i], rank});
      }
    }
    task_.result.open = open;
  }

  static constexpr std::size_t leaf_batch = 1;
  static constexpr std::size_t capacity = 2 * wide_stack_capacity;

  Task& task_;
  const Encounter& met_;
  std::size_t hits_;
  bool spreads_;
  Slot open_slots_[2][capacity];
  Slot leaf_slots_[2][leaf_batch + 4 * wide_lanes];
  float ranks_[ranked ? capacity : 1];
  SlotPairs open_{{open_slots_[0], open_slots_[1]}, ranks_};
  SlotPairs leaf_pairs_{{leaf_slots_[0], leaf_slots_[1]}};
};

}  // namespace odds::query::wide
