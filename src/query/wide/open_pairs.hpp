// Pairs of slots that the depth-first search has yet to open, and how it opens the newest of them.
#pragma once

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

/// Puts the lanes of a mask that are pairs of leaves where those are kept.
template <class L>
ODDS_LANES_INLINE void add_leaves(const Opened& opened, unsigned lanes, SlotPairs& leaf_pairs) noexcept {
  L::write_lanes(leaf_pairs.of[opened.side] + leaf_pairs.size, slot_at(opened.first), lanes);
  L::write_all(leaf_pairs.of[1 - opened.side] + leaf_pairs.size, slot_at(opened.other));
  leaf_pairs.size += static_cast<std::size_t>(std::popcount(lanes));
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

 private:
  template <bool ordered>
  ODDS_LANES_INLINE void run(const Opened& opened, OpenPairs& open, SlotPairs& leaf_pairs) const noexcept {
    using One = OnePair<L, TurnLanes<L>>;
    using F = typename L::Float;
    const TurnLanes<L>& turn = turns_[opened.side];
    const typename One::Boxes box{opened.box};
    const typename One::Nodes node{*opened.node};
    const Placed<One> placed(node, box, turn);
    const F gap = gaps<One>(node, box, turn, placed);
    const unsigned overlapping = L::less_equal(gap, L::all(met_.margin()));
    const bool other_is_leaf = opened.box.child().is_leaf();
    const unsigned leaves = L::highest_bits(opened.node->child);
    const unsigned both_leaves = other_is_leaf ? overlapping & leaves : 0U;
    if (both_leaves != 0) add_leaves<L>(opened, both_leaves, leaf_pairs);
    // Which is opened next: the larger of both, or what is no leaf.
    const F size = (placed.h[0] * placed.h[0] + placed.h[1] * placed.h[1]) + placed.h[2] * placed.h[2];
    // Of two of a size A's.
    const float box_size = other_is_leaf ? -1.0F : squared_radius(opened.box);
    const float other_size = std::bit_cast<float>(std::bit_cast<std::uint32_t>(box_size) + opened.side);
    const unsigned opens_lane = L::less_equal(L::all(other_size), size) & ~leaves;
    const LaneAddress mark = opened.side * OpenPairs::of_b;
    const auto add = [&](unsigned lanes) noexcept {
      L::write_either(open.opened + open.size, opened.first | mark, opened.other | (mark ^ OpenPairs::of_b), lanes,
                      opens_lane);
      L::write_either(open.other + open.size, opened.first, opened.other, lanes, ~opens_lane);
      open.size += static_cast<std::size_t>(std::popcount(lanes));
    };
    const unsigned inner = overlapping & ~both_leaves;
    const unsigned last = ordered ? inner & 1U << L::least(gap) : 0U;
    add(inner & ~last);
    if constexpr (ordered) add(last);
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

 private:
  using Two = TwoPairs<lanes::Avx512>;
  using Lanes = lanes::Sixteen;

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
