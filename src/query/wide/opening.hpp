// What all searches of the wide engine do with a pair of slots: open it, or test the triangles of two leaves.
#pragma once

#include <bit>
#include <utility>

#include "query/wide/searches.hpp"

namespace odds::query::wide {

/// Two pairs push at most sixteen, at most once a level of either tree.
inline constexpr std::size_t wide_stack_capacity = 2 * wide_lanes * 2 * (tree::deepest_level + 2);
/// Work units between two looks at the clock: some 100 ns.
inline constexpr std::uint32_t units_between_polls = 16;

/// The triangles of two leaves that may meet.
template <class L>
[[nodiscard]] ODDS_LANES_INLINE LeafPairs compare_leaves(Task& task, Slot slot_a, Slot slot_b) noexcept {
  const Encounter& met = task.encounter;
  float shift[3];
  met.shift(slot_a, slot_b, shift);
  const LeafPairs pairs =
      leaf_pairs<L>(met.leaf(0, slot_a), met.leaf(1, slot_b), met.turn_into(0), shift, met.margin());
  task.spending.spend_triangle_pairs(pairs.tested);
  return pairs;
}

/// Tests them exactly. False ends the search (the result says why).
ODDS_LANES_INLINE bool visit_triangles(Task& task, Slot slot_a, Slot slot_b, const LeafPairs& pairs) noexcept {
  const Encounter& met = task.encounter;
  for (unsigned rows = pairs.rows; rows != 0; rows &= rows - 1U) {
    const auto row = static_cast<unsigned>(std::countr_zero(rows));
    for (unsigned lanes = pairs.lanes_a[row]; lanes != 0; lanes &= lanes - 1U) {
      const std::uint32_t a = met.leaf(0, slot_a).leaf.triangle[std::countr_zero(lanes)];
      const std::uint32_t b = met.leaf(1, slot_b).leaf.triangle[row];
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

/// Tests all triangles of two leaves. False ends the search (the result says why).
template <class L>
ODDS_LANES_INLINE bool visit_leaves(Task& task, Slot slot_a, Slot slot_b) noexcept {
  return visit_triangles(task, slot_a, slot_b, compare_leaves<L>(task, slot_a, slot_b));
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
template <class L, bool ranked = false, bool far = false>
ODDS_LANES_INLINE Expanded<L> expand(const Encounter& met, const SlotPair& pair) noexcept {
  const WideNode* nodes[2] = {met.nodes(0) + pair.of[0] / wide_lanes, met.nodes(1) + pair.of[1] / wide_lanes};
  const std::uint32_t lanes[2] = {pair.of[0] % wide_lanes, pair.of[1] % wide_lanes};
  const std::uint32_t side = opening_size(*nodes[0], lanes[0]) >= opening_size(*nodes[1], lanes[1]) ? 0 : 1;
  const Turn& into = met.turn_into(side);
  const std::uint32_t opened = nodes[side]->child[lanes[side]].index();
  const TurnedBox box = turn(*nodes[1 - side], lanes[1 - side], into);
  const typename L::Float gap = gaps<L, far>(met.nodes(side)[opened], box, into);
  const WideNode& node = met.nodes(side)[opened];
  const unsigned overlapping = L::less_equal(gap, L::all(met.margin()));
  const unsigned other_is_leaf = nodes[1 - side]->child[lanes[1 - side]].is_leaf() ? 0xFFU : 0U;
  Expanded<L> expanded{side,
                       opened * wide_lanes,
                       pair.of[1 - side],
                       overlapping,
                       overlapping & L::highest_bits(node.child) & other_is_leaf,
                       gap,
                       gap};
  if constexpr (ranked) expanded.ranks = ranks<L>(node, box, gap);
  return expanded;
}

/// The lanes of the node in which one side's slot stands whose volumes overlap the other side's slot, its own among
/// them.
template <class L>
[[nodiscard]] unsigned overlapping_neighbours(const Encounter& met, std::uint32_t side, const SlotPair& pair) noexcept {
  const Slot other = pair.of[1 - side];
  const Turn& into = met.turn_into(side);
  const TurnedBox box = turn(met.nodes(1 - side)[other / wide_lanes], other % wide_lanes, into);
  const typename L::Float gap = gaps<L, false>(met.nodes(side)[pair.of[side] / wide_lanes], box, into);
  return L::less_equal(gap, L::all(met.margin()));
}

/// Stands for a rank that nobody has computed: above all others.
inline constexpr float unranked = 1e30F;

/// The rank of one pair, as `expand` gives it to lanes.
template <class L>
float rank_of(const Encounter& met, Slot slot_a, Slot slot_b) noexcept {
  const WideNode& node = met.nodes(0)[slot_a / wide_lanes];
  const TurnedBox box = turn(met.nodes(1)[slot_b / wide_lanes], slot_b % wide_lanes, met.turn_into(0));
  alignas(64) float rank[wide_lanes];
  L::store(rank, ranks<L>(node, box, gaps<L>(node, box, met.turn_into(0))));
  return rank[slot_a % wide_lanes];
}

/// Notes a pair that the search leaves undecided, with its rank.
template <class L>
void leave_open(Task& task, NodePair pair) noexcept {
  const bool by_depth = pair.rank < unranked && task.request.estimator == EstimatorKind::kinematic;
  if (!by_depth && !task.result.shortlist.full()) pair.rank = rank_of<L>(task.encounter, pair.a, pair.b);
  consider(task.result, pair);
}

/// Open pairs, newest last, each side's slots in one array.
struct SlotPairs {
  Slot* of[2];
  float* ranks = nullptr;  ///< of each pair, if they are wanted
  std::size_t size = 0;

  template <bool ranked, class L>
  ODDS_LANES_INLINE void add(const Expanded<L>& expanded, unsigned lanes) noexcept {
    L::write_lanes(of[expanded.side] + size, expanded.first, lanes);
    L::write_all(of[1 - expanded.side] + size, expanded.other);
    if constexpr (ranked) L::write_some(ranks + size, expanded.ranks, lanes);
    size += static_cast<std::size_t>(std::popcount(lanes));
  }
  /// Brings another pair to where the next one is taken from.
  template <bool ranked>
  void bring_up(std::size_t index) noexcept {
    std::swap(of[0][index], of[0][size - 1]);
    std::swap(of[1][index], of[1][size - 1]);
    if constexpr (ranked) std::swap(ranks[index], ranks[size - 1]);
  }
  ODDS_LANES_INLINE SlotPair take() noexcept {
    --size;
    return {{of[0][size], of[1][size]}};
  }
};

/// An index below `count` that follows no order: the golden section of the number of hits so far.
[[nodiscard]] inline std::size_t elsewhere(std::size_t hits, std::size_t count) noexcept {
  constexpr std::uint64_t golden = 0x9E3779B9U;  // of 2^32: no index comes again soon
  const std::uint64_t fraction = (hits * golden) & 0xFFFFFFFFU;
  return static_cast<std::size_t>((fraction * count) >> 32U);
}

}  // namespace odds::query::wide
