// What all searches of the wide engine do with a pair of slots: open it, or test the triangles of two leaves.
#pragma once

#include <bit>
#include <utility>

#include "query/wide/searches.hpp"

namespace odds::query::wide {

/// One pair pushes at most eight, at most once a level of either tree; with room for twice as many.
inline constexpr std::size_t wide_stack_capacity = 2 * wide_lanes * 2 * (tree::deepest_level + 2);
/// Work units between two looks at the clock: some 100 ns.
inline constexpr std::uint32_t units_between_polls = 16;

/// After so many exact tests of triangles that were apart, those to come are looked at more finely first: where a hit
/// is soon found that takes longer than it saves, but of slivers and flush faces hundreds are apart by what no plane
/// shows. Not near the end of the time: of two leaves it may take half a microsecond between two looks at the clock.
inline constexpr std::uint32_t enough_apart = 3;

/// The triangles of two leaves that may meet.
template <class L>
[[nodiscard]] ODDS_LANES_INLINE LeafPairs compare_leaves(Task& task, Slot slot_a, Slot slot_b) noexcept {
  const Encounter& met = task.encounter;
  float shift[3];
  met.shift(slot_a, slot_b, shift);
  const LeafPairs pairs = leaf_pairs<L>(met.leaf(0, slot_a), met.leaf(1, slot_b), met.turn_into(0), shift, met.margin(),
                                        task.apart >= enough_apart && !task.spending.nears_end());
  task.spending.spend_triangle_pairs(pairs.tested);
  task.spending.hasten_poll(pairs.parted);
  return pairs;
}

/// Tests them exactly, but for those that are certain. False ends the search (the result says why). Of no interest is
/// what `passes_over(triangle of A, of B)`.
template <class PassesOver>
ODDS_LANES_INLINE bool visit_triangles(Task& task, Slot slot_a, Slot slot_b, const LeafPairs& pairs,
                                       PassesOver passes_over) noexcept {
  const Encounter& met = task.encounter;
  for (unsigned rows = pairs.rows; rows != 0; rows &= rows - 1U) {
    const auto row = static_cast<unsigned>(std::countr_zero(rows));
    for (unsigned lanes = pairs.lanes_a[row]; lanes != 0; lanes &= lanes - 1U) {
      const auto lane = static_cast<unsigned>(std::countr_zero(lanes));
      const std::uint32_t a = met.leaf(0, slot_a).leaf.triangle[lane];
      const std::uint32_t b = met.leaf(1, slot_b).leaf.triangle[row];
      if (!task.spending.allows(1) || !task.spending.may_test_triangles()) {
        task.result.ended = Progressed::spent;
        return false;
      }
      task.spending.spend_triangle_pairs(1);
      if (passes_over(a, b)) continue;
      if (!pairs.certainly_meet(row, lane) && !met.triangles_meet(a, b)) {
        ++task.apart;
        continue;
      }
      if (task.hits.empty() && task.wanted > 1) task.spending.keep_time_for_contacts();
      task.hits.add({a, b});
      if (task.sweep != nullptr) task.sweep->met.note({slot_a, slot_b});
      if (task.hits.full(task.wanted)) {
        task.result.ended = Progressed::enough;
        return false;
      }
    }
  }
  return true;
}

ODDS_LANES_INLINE bool visit_triangles(Task& task, Slot slot_a, Slot slot_b, const LeafPairs& pairs) noexcept {
  return visit_triangles(task, slot_a, slot_b, pairs, [](std::uint32_t, std::uint32_t) noexcept { return false; });
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
  unsigned leaf_lanes;  ///< those of them that are leaves, if the other is one, too
  typename L::Float gaps;
  typename L::Float ranks;  ///< if they were asked for
};

/// -1 for a leaf, which cannot be opened.
ODDS_LANES_INLINE float opening_size(const LaneNumbers& lane) noexcept {
  const float size = squared_radius(lane);
  return lane.child().is_leaf() ? -1.0F : size;
}

/// Opens the larger of both, or the one that is no leaf. Not both may be leaves. Without branches on which side it is:
/// nobody could predict them.
template <class L, bool ranked = false, bool far = false>
ODDS_LANES_INLINE Expanded<L> expand(const Encounter& met, const SlotPair& pair) noexcept {
  using One = OnePair<L>;
  const LaneNumbers of[2] = {met.numbers(0, pair.of[0]), met.numbers(1, pair.of[1])};
  const std::uint32_t side = opening_size(of[0]) >= opening_size(of[1]) ? 0 : 1;
  const std::uint32_t opened = of[side].child().node_index();
  const typename One::Turned turn{met.turn_into(side)};
  const typename One::Boxes box{of[1 - side]};
  const typename One::Nodes node{met.nodes(side)[opened]};
  const Placed<One> placed(node, box, turn);
  const typename L::Float gap = gaps<One, far>(node, box, turn, placed);
  const unsigned overlapping = L::less_equal(gap, L::all(met.margin()));
  const unsigned other_is_leaf = of[1 - side].child().is_leaf() ? 0xFFU : 0U;
  Expanded<L> expanded{side,
                       opened * wide_lanes,
                       pair.of[1 - side],
                       overlapping,
                       overlapping & L::highest_bits(node.node.child) & other_is_leaf,
                       gap,
                       gap};
  if constexpr (ranked) expanded.ranks = ranks<One>(node, box, gap);
  return expanded;
}

/// The gaps between one side's slot and the lanes of the node in which the other side's slot stands.
template <class L>
ODDS_LANES_INLINE typename L::Float gaps_beside(const Encounter& met, std::uint32_t side, Slot slot,
                                                Slot other) noexcept {
  using One = OnePair<L>;
  const typename One::Turned turn{met.turn_into(side)};
  const typename One::Boxes box{met.numbers(1 - side, other)};
  const typename One::Nodes node{met.nodes(side)[slot / wide_lanes]};
  return gaps<One>(node, box, turn, Placed<One>(node, box, turn));
}

/// The lanes of the node in which one side's slot stands whose volumes overlap the other side's slot, its own among
/// them.
template <class L>
[[nodiscard]] unsigned overlapping_neighbours(const Encounter& met, std::uint32_t side, const SlotPair& pair) noexcept {
  return L::less_equal(gaps_beside<L>(met, side, pair.of[side], pair.of[1 - side]), L::all(met.margin()));
}

/// Stands for a rank that nobody has computed: above all others.
inline constexpr float unranked = 1e30F;

/// The rank of one pair, as `expand` gives it to lanes.
template <class L>
float rank_of(const Encounter& met, Slot slot_a, Slot slot_b) noexcept {
  using One = OnePair<L>;
  const typename One::Boxes box{met.numbers(1, slot_b)};
  const typename One::Nodes node{met.nodes(0)[slot_a / wide_lanes]};
  alignas(64) float rank[wide_lanes];
  L::store(rank, ranks<One>(node, box, gaps_beside<L>(met, 0, slot_a, slot_b)));
  return rank[slot_a % wide_lanes];
}

/// Notes a pair that the search leaves undecided, with its rank. Beside a hit it is only counted: nobody asks where
/// else.
template <class L>
void leave_open(Task& task, NodePair pair) noexcept {
  if (!task.hits.empty()) {
    ++task.result.open;
    return;
  }
  const bool by_depth = pair.rank < unranked && task.request.estimator == EstimatorKind::kinematic;
  if (!by_depth && !task.result.shortlist.full()) pair.rank = rank_of<L>(task.encounter, pair.a, pair.b);
  consider(task.result, pair);
}

/// An index below `count` that follows no order: the golden section of the number of hits so far.
[[nodiscard]] ODDS_LANES_INLINE std::size_t elsewhere(std::size_t hits, std::size_t count) noexcept {
  constexpr std::uint64_t golden = 0x9E3779B9U;  // of 2^32: no index comes again soon
  const std::uint64_t fraction = (hits * golden) & 0xFFFFFFFFU;
  return static_cast<std::size_t>((fraction * count) >> 32U);
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
  /// Brings another pair to where the next one is taken from.
  void bring_up(std::size_t index) noexcept {
    std::swap(of[0][index], of[0][size - 1]);
    std::swap(of[1][index], of[1][size - 1]);
  }
  ODDS_LANES_INLINE SlotPair take() noexcept {
    --size;
    return {{of[0][size], of[1][size]}};
  }
};

}  // namespace odds::query::wide
