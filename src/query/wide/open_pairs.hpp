// Pairs of slots that an exact search has yet to open, and how it opens them.
#pragma once

#include <limits>

#include "query/wide/opening.hpp"
#include "query/wide/two_pairs.hpp"

namespace odds::query::wide {

/// An address of a lane's numbers from a tree's first node on, in floats: slot s stands at `s / 8 * 96 + s % 8`.
using LaneAddress = std::uint32_t;
inline constexpr LaneAddress floats_per_node = sizeof(WideNode) / sizeof(float);
static_assert(tree::WideTree::most_nodes <= (1U << 31U) / floats_per_node, "the highest bit is the opened side's");

[[nodiscard]] ODDS_LANES_INLINE LaneAddress address_of(Slot slot) noexcept {
  return slot / wide_lanes * floats_per_node + slot % wide_lanes;
}
[[nodiscard]] ODDS_LANES_INLINE Slot slot_at(LaneAddress address) noexcept {
  return address / floats_per_node * wide_lanes + address % floats_per_node;
}

struct Opened;

/// Open pairs, newest last. Of each, which of its slots is opened was decided when it was found, among all lanes at
/// once.
struct OpenPairs {
  /// Marks in `opened` that it is B's.
  static constexpr LaneAddress of_b = 1U << 31U;

  LaneAddress* opened;  ///< the slot that is opened, and whose it is
  LaneAddress* other;   ///< what its node's lanes are compared with, of the other side
  std::size_t size = 0;

  [[nodiscard]] ODDS_LANES_INLINE SlotPair pair(std::size_t index) const noexcept {
    const Slot own = slot_at(opened[index] % of_b);
    const Slot its = slot_at(other[index]);
    const bool is_b = opened[index] >= of_b;
    return {{is_b ? its : own, is_b ? own : its}};
  }
  /// Precondition: not both are leaves.
  ODDS_LANES_INLINE void add(const Encounter& met, const SlotPair& pair) noexcept {
    const std::uint32_t side =
        opening_size(met.numbers(0, pair.of[0])) >= opening_size(met.numbers(1, pair.of[1])) ? 0 : 1;
    opened[size] = address_of(pair.of[side]) + side * of_b;
    other[size] = address_of(pair.of[1 - side]);
    ++size;
  }
  /// Lanes of an opened pair; `opens_lane` as in FoundLanes.
  template <class L>
  ODDS_LANES_INLINE void add(const Opened& from, unsigned lanes, unsigned opens_lane) noexcept;
  /// Brings another pair to where the next one is taken from.
  ODDS_LANES_INLINE void bring_up(std::size_t index) noexcept {
    std::swap(opened[index], opened[size - 1]);
    std::swap(other[index], other[size - 1]);
  }
};

/// An open pair, taken apart.
struct Opened {
  std::uint32_t side;
  LaneAddress first;  ///< of the opened node's lanes
  LaneAddress other;
  const WideNode* node;
  LaneNumbers box;  ///< the other slot's

  ODDS_LANES_INLINE Opened(const Encounter& met, LaneAddress opened, LaneAddress against) noexcept
      : side(opened / OpenPairs::of_b), other(against), box(at(met, 1 - side, against)) {
    const std::uint32_t index = at(met, side, opened % OpenPairs::of_b).child().node_index();
    first = index * floats_per_node;
    node = met.nodes(side) + index;
  }
  [[nodiscard]] ODDS_LANES_INLINE static LaneNumbers at(const Encounter& met, std::uint32_t side,
                                                        LaneAddress address) noexcept {
    return LaneNumbers(&met.nodes(side)->center[0][0] + address);
  }
};

template <class L>
ODDS_LANES_INLINE void OpenPairs::add(const Opened& from, unsigned lanes, unsigned opens_lane) noexcept {
  const LaneAddress mark = from.side * of_b;
  L::write_either(opened + size, from.first | mark, from.other | (mark ^ of_b), lanes, opens_lane);
  L::write_either(other + size, from.first, from.other, lanes, ~opens_lane);
  size += static_cast<std::size_t>(std::popcount(lanes));
}

/// Puts the lanes of a mask that are pairs of leaves where those are kept.
template <class L>
ODDS_LANES_INLINE void add_leaves(const Opened& opened, unsigned lanes, SlotPairs& leaf_pairs) noexcept {
  L::write_lanes(leaf_pairs.of[opened.side] + leaf_pairs.size, slot_at(opened.first), lanes);
  L::write_all(leaf_pairs.of[1 - opened.side] + leaf_pairs.size, slot_at(opened.other));
  leaf_pairs.size += static_cast<std::size_t>(std::popcount(lanes));
}

/// What opening a pair finds, by lanes.
template <class L>
struct FoundLanes {
  typename L::Float gap;
  typename L::Float bound;      ///< of the gaps of lanes that are open: no gap is as small where both are leaves
  typename L::Float thickness;  ///< of both surfaces
  unsigned leaf_pairs;          ///< that overlap, both of them leaves
  unsigned open;                ///< that overlap, not both of them leaves
  unsigned opens_lane;          ///< of these, where the lane's own slot is opened next, not the other
};

template <class L, class Turned>
[[nodiscard]] ODDS_LANES_INLINE FoundLanes<L> find_lanes(const Opened& opened, const Turned& turn,
                                                         float margin) noexcept {
  using One = OnePair<L, Turned>;
  using F = typename L::Float;
  const typename One::Boxes box{opened.box};
  const typename One::Nodes node{*opened.node};
  const Placed<One> placed(node, box, turn);
  const F gap = gaps<One>(node, box, turn, placed);
  const bool other_is_leaf = opened.box.child().is_leaf();
  const unsigned leaves = L::highest_bits(opened.node->child);
  const F bound =
      L::choose(other_is_leaf ? leaves : 0U, L::all(-std::numeric_limits<float>::infinity()), L::all(margin));
  const unsigned overlapping = L::less_equal(gap, L::all(margin));
  const unsigned leaf_pairs = other_is_leaf ? overlapping & leaves : 0U;
  // Which is opened next: the larger of both, or what is no leaf.
  const F size = (placed.h[0] * placed.h[0] + placed.h[1] * placed.h[1]) + placed.h[2] * placed.h[2];
  // Of two of a size A's.
  const float box_size = other_is_leaf ? -1.0F : squared_radius(opened.box);
  const float other_size = std::bit_cast<float>(std::bit_cast<std::uint32_t>(box_size) + opened.side);
  const unsigned opens_lane = L::less_equal(L::all(other_size), size) & ~leaves;
  return {gap, bound, node.thickness() + box.thickness(), leaf_pairs, overlapping & ~leaf_pairs, opens_lane};
}

/// Opens pairs: what overlaps is added to `open`, or to `leaf_pairs` where both are leaves.
template <class L>
class Opener {
 public:
  ODDS_LANES_INLINE explicit Opener(const Encounter& met) noexcept
      : met_(met), turns_{TurnLanes<L>(met.turn_into(0)), TurnLanes<L>(met.turn_into(1))} {}

  /// Opens the `count` pairs, at most `most`, that were taken from the end of `open` last. If `ordered` the deepest
  /// overlap of each is added after its others; else as the lanes come, which is faster.
  template <bool ordered>
  ODDS_LANES_INLINE void run(std::uint32_t count, OpenPairs& open, SlotPairs& leaf_pairs) const noexcept {
    LaneAddress opened[most];
    LaneAddress other[most];
    for (std::uint32_t k = 0; k < count; ++k) {  // what is found is written over them
      opened[k] = open.opened[open.size + k];
      other[k] = open.other[open.size + k];
    }
    for (std::uint32_t k = 0; k < count; ++k) run<ordered>({met_, opened[k], other[k]}, open, leaf_pairs);
  }

  static constexpr std::uint32_t most = 6;

  /// What opening one pair finds.
  [[nodiscard]] ODDS_LANES_INLINE FoundLanes<L> find(const Opened& opened) const noexcept {
    return find_lanes<L>(opened, turns_[opened.side], met_.margin());
  }

 private:
  template <bool ordered>
  ODDS_LANES_INLINE void run(const Opened& opened, OpenPairs& open, SlotPairs& leaf_pairs) const noexcept {
    const FoundLanes<L> found = find(opened);
    if (found.leaf_pairs != 0) add_leaves<L>(opened, found.leaf_pairs, leaf_pairs);
    const unsigned last = ordered ? found.open & 1U << L::least(found.gap) : 0U;
    open.add<L>(opened, found.open & ~last, found.opens_lane);
    if constexpr (ordered) open.add<L>(opened, last, found.opens_lane);
  }

  const Encounter& met_;
  TurnLanes<L> turns_[2];
};

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
template <>
class Opener<lanes::Avx512> {
 public:
  ODDS_LANES_INLINE explicit Opener(const Encounter& met) noexcept : met_(met) {
    for (std::uint32_t lower = 0; lower < 2; ++lower) {
      for (std::uint32_t upper = 0; upper < 2; ++upper) {
        turns_[2 * lower + upper].fill(met.turn_into(lower), met.turn_into(upper));
      }
    }
  }

  template <bool ordered>
  ODDS_LANES_INLINE void run(std::uint32_t count, OpenPairs& open, SlotPairs& leaf_pairs) const noexcept {
    LaneAddress opened[most];
    LaneAddress other[most];
    for (std::uint32_t k = 0; k < count; ++k) {
      opened[k] = open.opened[open.size + k];
      other[k] = open.other[open.size + k];
    }
    for (std::uint32_t k = 0; k < count; k += 2) {
      const std::uint32_t upper = k + 1 < count ? k + 1 : k;
      const unsigned in_use = k + 1 < count ? 0xFFFFU : 0xFFU;
      run_two<ordered>({met_, opened[k], other[k]}, {met_, opened[upper], other[upper]}, in_use, open, leaf_pairs);
    }
  }

  static constexpr std::uint32_t most = 6;

  [[nodiscard]] ODDS_LANES_INLINE FoundLanes<lanes::Avx512> find(const Opened& opened) const noexcept {
    return find_lanes<lanes::Avx512>(opened, LowerHalf{turns_[3 * opened.side]}, met_.margin());
  }

 private:
  using Two = TwoPairs<lanes::Avx512>;

  /// Where both pairs are turned into one tree, eight lanes do for one.
  struct LowerHalf {
    using F = lanes::Avx512::Float;
    const Two::Turned& both;

    [[nodiscard]] ODDS_LANES_INLINE F of(int j, int i) const noexcept { return lanes::Avx512::load(both.column[j][i]); }
    [[nodiscard]] ODDS_LANES_INLINE F abs_of(int j, int i) const noexcept {
      return lanes::Avx512::load(both.abs_column[j][i]);
    }
    [[nodiscard]] ODDS_LANES_INLINE F t(int i) const noexcept { return lanes::Avx512::load(both.translation[i]); }
  };

  template <bool ordered>
  ODDS_LANES_INLINE void run_two(const Opened& lower, const Opened& upper, unsigned in_use, OpenPairs& open,
                                 SlotPairs& leaf_pairs) const noexcept {
    const Two::Turned& turn = turns_[2 * lower.side + upper.side];
    const Two::Boxes boxes{lower.box, upper.box};
    const Two::Nodes nodes{{lower.node, upper.node}};
    const Placed<Two> placed(nodes, boxes, turn);
    const Two::F gap = gaps<Two>(nodes, boxes, turn, placed);
    const __m512i children = _mm512_inserti64x4(_mm512_castsi256_si512(load_children(lower)), load_children(upper), 1);
    const __mmask16 leaves = _mm512_movepi32_mask(children);
    const unsigned other_leaves =
        (lower.box.child().is_leaf() ? 0xFFU : 0U) | (upper.box.child().is_leaf() ? 0xFF00U : 0U);
    const __m512 margin = _mm512_set1_ps(met_.margin());
    const auto leaf_pair = static_cast<__mmask16>(leaves & other_leaves & in_use);
    const auto no_leaf_pair = static_cast<__mmask16>(in_use & ~leaf_pair);
    const __mmask16 inner = _mm512_mask_cmp_ps_mask(no_leaf_pair, gap.v, margin, _CMP_LE_OQ);
    if (leaf_pair != 0) {
      const __mmask16 both_leaves = _mm512_mask_cmp_ps_mask(leaf_pair, gap.v, margin, _CMP_LE_OQ);
      if ((both_leaves & 0xFFU) != 0) add_leaves<lanes::Avx512>(lower, both_leaves & 0xFFU, leaf_pairs);
      if (both_leaves >> 8U != 0) add_leaves<lanes::Avx512>(upper, both_leaves >> 8U, leaf_pairs);
    }
    const auto squares = [](const Two::F(&h)[3]) noexcept { return (h[0] * h[0] + h[1] * h[1]) + h[2] * h[2]; };
    const __m512 box_size =
        _mm512_mask_mov_ps(squares(placed.own_h).v, static_cast<__mmask16>(other_leaves), _mm512_set1_ps(-1.0F));
    const __m512 other_size =
        _mm512_castsi512_ps(_mm512_add_epi32(_mm512_castps_si512(box_size), both(lower.side, upper.side)));
    const __mmask16 opens_lane =
        _mm512_mask_cmp_ps_mask(static_cast<__mmask16>(~leaves), other_size, squares(placed.h).v, _CMP_LE_OQ);

    const __m512i lane = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7);
    const __m512i lanes = _mm512_add_epi32(both(lower.first, upper.first), lane);
    const __m512i others = both(lower.other, upper.other);
    const __m512i mark = both(lower.side * OpenPairs::of_b, upper.side * OpenPairs::of_b);
    const __m512i other_mark = _mm512_xor_si512(mark, _mm512_set1_epi32(static_cast<int>(OpenPairs::of_b)));
    const __m512i opened = _mm512_mask_or_epi32(_mm512_or_si512(others, other_mark), opens_lane, lanes, mark);
    const __m512i against = _mm512_mask_mov_epi32(lanes, opens_lane, others);
    const auto add = [&](unsigned lanes_added) noexcept {
      const auto which = static_cast<__mmask16>(lanes_added);
      _mm512_storeu_si512(open.opened + open.size, _mm512_maskz_compress_epi32(which, opened));
      _mm512_storeu_si512(open.other + open.size, _mm512_maskz_compress_epi32(which, against));
      open.size += static_cast<std::size_t>(std::popcount(lanes_added));
    };
    if constexpr (ordered) {
      const unsigned deepest = least_of_both(gap.v);
      for (const unsigned half : {0xFFU, 0xFF00U}) {
        add(inner & half & ~deepest);
        add(inner & half & deepest);
      }
    } else {
      add(inner);
    }
  }

  /// The bit of the lane with the least number in either half.
  [[nodiscard]] ODDS_LANES_INLINE static unsigned least_of_both(__m512 a) noexcept {
    __m512 least = _mm512_min_ps(a, _mm512_shuffle_f32x4(a, a, 0xB1));
    least = _mm512_min_ps(least, _mm512_permute_ps(least, 0x4E));
    least = _mm512_min_ps(least, _mm512_permute_ps(least, 0xB1));
    const unsigned lanes = _mm512_cmp_ps_mask(a, least, _CMP_LE_OQ);
    const unsigned lower = lanes & 0xFFU;
    const unsigned upper = lanes & 0xFF00U;
    return (lower & (0U - lower)) | (upper & (0U - upper));
  }

  [[nodiscard]] ODDS_LANES_INLINE static __m256i load_children(const Opened& opened) noexcept {
    return _mm256_load_si256(reinterpret_cast<const __m256i*>(opened.node->child));
  }
  [[nodiscard]] ODDS_LANES_INLINE static __m512i both(std::uint32_t lower, std::uint32_t upper) noexcept {
    return _mm512_mask_set1_epi32(_mm512_set1_epi32(static_cast<int>(lower)), 0xFF00, static_cast<int>(upper));
  }

  const Encounter& met_;
  Two::Turned turns_[4];
};
#endif

}  // namespace odds::query::wide
