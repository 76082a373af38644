// Bodies of the wide searches, for the files that compile them with one instruction set each; nobody else includes
// this.
#pragma once

#include <bit>

#include "query/wide_search.hpp"

namespace odds::query::wide {

/// Two pairs push at most sixteen, at most once a level of either tree.
inline constexpr std::size_t wide_stack_capacity = 2 * wide_lanes * 2 * (tree::deepest_level + 2);
/// Work units between two looks at the clock: some 100 ns.
inline constexpr std::uint32_t units_between_polls = 32;

/// Tests all triangles of two leaves. False ends the search (the result says why).
template <class L>
ODDS_LANES_INLINE bool visit_leaves(Task& task, Slot slot_a, Slot slot_b) noexcept {
  const Encounter& met = task.encounter;
  const WideNode& node_a = met.a().nodes()[slot_a / wide_lanes];
  const WideNode& node_b = met.b().nodes()[slot_b / wide_lanes];
  const std::uint32_t lane_a = slot_a % wide_lanes;
  const std::uint32_t lane_b = slot_b % wide_lanes;
  const WideLeaf& leaf_a = met.a().leaves()[node_a.child[lane_a].index()];
  const WideLeaf& leaf_b = met.b().leaves()[node_b.child[lane_b].index()];
  float shift[3];
  met.shift(slot_a, slot_b, shift);
  const LeafPairs pairs =
      leaf_pairs<L>(leaf_a, leaf_b, node_a, lane_a, node_b, lane_b, met.turn_into(0), shift, met.margin());
  task.spending.spend_triangle_pairs(pairs.tested);
  for (unsigned rows = pairs.rows; rows != 0; rows &= rows - 1U) {
    const auto row = static_cast<unsigned>(std::countr_zero(rows));
    for (unsigned lanes = pairs.lanes_a[row]; lanes != 0; lanes &= lanes - 1U) {
      const std::uint32_t a = leaf_a.triangle[std::countr_zero(lanes)];
      const std::uint32_t b = leaf_b.triangle[row];
      if (!task.spending.allows(1) || !task.spending.may_go_on()) {
        task.result.ended = Progressed::spent;
        return false;
      }
      task.spending.spend_triangle_pairs(1);
      if (!met.triangles_meet(a, b)) continue;
      if (task.hits.empty() && task.wanted > 1) task.spending.keep_time_for_contacts();
      task.hits.add({a, b});
      if (task.hits.full(task.wanted)) {
        task.result.ended = Progressed::enough;
        return false;
      }
    }
  }
  return true;
}

/// Two slots, by side.
struct SlotPair {
  Slot of[2];
};

/// The lanes of one side's node whose volumes overlap the other side's slot.
template <class L>
struct Expanded {
  std::uint32_t side;  ///< whose node was opened
  Slot first;          ///< slot of its first lane
  Slot other;          ///< the other side's
  unsigned lanes;
  unsigned leaf_lanes;  ///< of those the ones that make a pair of leaves
  typename L::Float gaps;
  typename L::Float ranks;  ///< if asked for
};

/// -1 for a leaf, which cannot be opened.
ODDS_LANES_INLINE float opening_size(const WideNode& node, std::uint32_t lane) noexcept {
  const float size = squared_radius(node, lane);
  return node.child[lane].is_leaf() ? -1.0F : size;
}

/// Opens the larger of both, or the one that is no leaf. Not both may be leaves. Without branches on which side it is:
/// nobody could predict them.
template <class L, bool ranked = false>
ODDS_LANES_INLINE Expanded<L> expand(const Encounter& met, const SlotPair& pair) noexcept {
  const WideNode* nodes[2] = {met.nodes(0) + pair.of[0] / wide_lanes, met.nodes(1) + pair.of[1] / wide_lanes};
  const std::uint32_t lanes[2] = {pair.of[0] % wide_lanes, pair.of[1] % wide_lanes};
  const std::uint32_t side = opening_size(*nodes[0], lanes[0]) >= opening_size(*nodes[1], lanes[1]) ? 0 : 1;
  const Turn& into = met.turn_into(side);
  const std::uint32_t opened = nodes[side]->child[lanes[side]].index();
  const TurnedBox box = turn(*nodes[1 - side], lanes[1 - side], into);
  const Gaps<L> found = gaps<L>(met.nodes(side)[opened], box, into);
  const WideNode& node = met.nodes(side)[opened];
  const unsigned overlapping = L::less_equal(found.gap, L::all(met.margin()));
  const unsigned other_is_leaf = nodes[1 - side]->child[lanes[1 - side]].is_leaf() ? 0xFFU : 0U;
  Expanded<L> expanded{side,
                       opened * wide_lanes,
                       pair.of[1 - side],
                       overlapping,
                       overlapping & L::highest_bits(node.child) & other_is_leaf,
                       found.gap,
                       found.gap};
  if constexpr (ranked) expanded.ranks = ranks<L>(node, *nodes[1 - side], lanes[1 - side], box, found);
  return expanded;
}

/// Open pairs, newest last, each side's slots in one array.
struct SlotPairs {
  Slot* of[2];
  std::size_t size = 0;

  template <class L>
  ODDS_LANES_INLINE void add(const Expanded<L>& expanded, unsigned lanes) noexcept {
    L::write_lanes(of[expanded.side] + size, expanded.first, lanes);
    L::write_all(of[1 - expanded.side] + size, expanded.other);
    size += static_cast<std::size_t>(std::popcount(lanes));
  }
  ODDS_LANES_INLINE SlotPair take() noexcept {
    --size;
    return {{of[0][size], of[1][size]}};
  }
};

/// Two pairs are opened at a time: each waits for its numbers most of its time, and neither waits for the other. What
/// remains is kept without branches that nobody could predict.
template <class L>
class DepthFirst {
 public:
  static void run(Task& task, Slot start_a, Slot start_b) noexcept {
    DepthFirst search(task);
    search.run(start_a, start_b);
  }

 private:
  explicit DepthFirst(Task& task) noexcept : task_(task), met_(task.encounter) {}

  void run(Slot start_a, Slot start_b) noexcept {
    const bool leaves = met_.nodes(0)[start_a / wide_lanes].child[start_a % wide_lanes].is_leaf() &&
                        met_.nodes(1)[start_b / wide_lanes].child[start_b % wide_lanes].is_leaf();
    SlotPairs& start = leaves ? leaf_pairs_ : open_;
    start.of[0][0] = start_a;
    start.of[1][0] = start_b;
    start.size = 1;
    while (open_.size != 0 || leaf_pairs_.size != 0) {
      if (leaf_pairs_.size >= leaf_batch || open_.size == 0) {
        if (!visit_leaf_pairs()) return;
        continue;
      }
      if (!task_.spending.may_go_on_after(units_between_polls) || !task_.spending.allows(2 * wide_lanes)) return stop();
      const Expanded<L> first = expand<L>(met_, open_.take());
      if (open_.size != 0) {
        const Expanded<L> second = expand<L>(met_, open_.take());
        task_.spending.spend_node_pairs(2 * wide_lanes);
        keep(second);
      } else {
        task_.spending.spend_node_pairs(wide_lanes);
      }
      keep(first);
    }
  }

  /// The deepest overlap is pushed last and so visited first: it is where a hit is found soonest.
  ODDS_LANES_INLINE void keep(const Expanded<L>& expanded) noexcept {
    leaf_pairs_.add(expanded, expanded.leaf_lanes);
    const unsigned inner = expanded.lanes & ~expanded.leaf_lanes;
    const unsigned deepest = 1U << L::least(expanded.gaps);
    open_.add(expanded, inner & ~deepest);
    open_.add(expanded, inner & deepest);
  }

  bool visit_leaf_pairs() noexcept {
    while (leaf_pairs_.size != 0) {
      if (!task_.spending.may_go_on_after(units_between_polls) || !task_.spending.allows(wide_lanes * wide_lanes)) {
        stop();
        return false;
      }
      const SlotPair pair = leaf_pairs_.take();
      if (visit_leaves<L>(task_, pair.of[0], pair.of[1])) continue;
      if (task_.result.ended == Progressed::spent) {
        consider(task_.result, {pair.of[0], pair.of[1], met_.rank(pair.of[0], pair.of[1])});
        consider_newest(open_);
      }
      return false;
    }
    return true;
  }

  void stop() noexcept {
    task_.result.ended = Progressed::spent;
    consider_newest(leaf_pairs_);
    consider_newest(open_);
  }

  void consider_newest(const SlotPairs& pairs) noexcept {
    constexpr std::size_t estimated_at_most = 4;  // each estimate costs about as much as a node
    for (std::size_t n = 0; n < estimated_at_most && n < pairs.size; ++n) {
      const Slot a = pairs.of[0][pairs.size - 1 - n];
      const Slot b = pairs.of[1][pairs.size - 1 - n];
      consider(task_.result, {a, b, met_.rank(a, b)});
    }
  }

  static constexpr std::size_t leaf_batch = 1;

  Task& task_;
  const Encounter& met_;
  Slot open_slots_[2][wide_stack_capacity];
  Slot leaf_slots_[2][leaf_batch + 4 * wide_lanes];
  SlotPairs open_{{open_slots_[0], open_slots_[1]}};
  SlotPairs leaf_pairs_{{leaf_slots_[0], leaf_slots_[1]}};
};

template <class L>
class TimeCritical {
 public:
  static void run(Task& task) noexcept {
    TimeCritical search(task);
    search.run();
  }

 private:
  explicit TimeCritical(Task& task) noexcept : task_(task), met_(task.encounter) {}

  void run() noexcept {
    task_.queue.clear();
    push({tree::WideTree::root, tree::WideTree::root, 0.0F});
    while (!task_.queue.empty() && !finished_) {
      if (!task_.spending.may_go_on_after(units_between_polls)) {
        finish(Progressed::spent);
        break;
      }
      visit(task_.queue.pop());
    }
    if (task_.result.ended != Progressed::finished && !task_.queue.empty()) consider(task_.result, task_.queue.top());
  }

  void finish(Progressed how) noexcept {
    task_.result.ended = how;
    finished_ = true;
  }

  [[nodiscard]] std::uint32_t levels_left(const NodePair& pair) const noexcept {
    return met_.a().nodes()[pair.a / wide_lanes].child[pair.a % wide_lanes].height() +
           met_.b().nodes()[pair.b / wide_lanes].child[pair.b % wide_lanes].height();
  }

  void push(const NodePair& pair) noexcept {
    task_.queue.push(bucket_of(pair.rank, 3 * static_cast<int>(levels_left(pair))), pair);
  }

  void visit(const NodePair& pair) noexcept {
    if (levels_left(pair) == 0) return visit_leaf_pair(pair);
    if (!task_.spending.allows(wide_lanes)) {
      consider(task_.result, pair);
      return finish(Progressed::spent);
    }
    const Expanded<L> expanded = expand<L, true>(met_, {{pair.a, pair.b}});
    task_.spending.spend_node_pairs(wide_lanes);
    alignas(64) float rank[wide_lanes];
    L::store(rank, expanded.ranks);
    for (unsigned lanes = expanded.lanes; lanes != 0 && !finished_; lanes &= lanes - 1U) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
      NodePair child = expanded.side == 0 ? NodePair{expanded.first + lane, pair.b, rank[lane]}
                                          : NodePair{pair.a, expanded.first + lane, rank[lane]};
      if (task_.request.estimator == EstimatorKind::cells) child.rank = met_.rank(child.a, child.b);
      meet(child);
    }
  }

  void visit_leaf_pair(const NodePair& pair) noexcept {
    if (task_.request.polygon_free) {
      const float p = met_.probability(pair.a, pair.b);
      task_.result.estimate = std::max(task_.result.estimate, p);
      if (p >= 0.5F) {
        task_.result.estimated_hit = true;
        consider(task_.result, pair);
        finish(Progressed::enough);
      }
      return;
    }
    if (!task_.spending.allows(wide_lanes * wide_lanes)) {
      consider(task_.result, pair);
      return finish(Progressed::spent);
    }
    if (visit_leaves<L>(task_, pair.a, pair.b)) return;
    if (task_.result.ended == Progressed::spent) consider(task_.result, pair);
    finished_ = true;
  }

  void meet(const NodePair& pair) noexcept {
    if (task_.request.p_min < 1.0) {
      const float p = met_.probability(pair.a, pair.b);
      if (static_cast<double>(p) >= task_.request.p_min) {
        task_.result.estimate = std::max(task_.result.estimate, p);
        if (++sure_pairs_ >= task_.request.k_min) {
          task_.result.estimated_hit = true;
          consider(task_.result, pair);
          return finish(Progressed::enough);
        }
      }
    }
    if (!task_.queue.full()) return push(pair);
    // Nothing is dropped: what finds no room is searched to its end at once.
    task_.spending.note_full_queue();
    if (task_.request.polygon_free) {
      task_.result.estimate = std::max(task_.result.estimate, met_.probability(pair.a, pair.b));
      consider(task_.result, pair);
      return;
    }
    DepthFirst<L>::run(task_, pair.a, pair.b);
    if (task_.result.ended != Progressed::finished) finished_ = true;
  }

  Task& task_;
  const Encounter& met_;
  std::uint32_t sure_pairs_ = 0;
  bool finished_ = false;
};

template <class L>
constexpr Searches searches_of() noexcept {
  return {L::name, &DepthFirst<L>::run, &TimeCritical<L>::run};
}

}  // namespace odds::query::wide
