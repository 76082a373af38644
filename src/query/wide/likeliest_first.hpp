// The start of an exact search: one pair after the other, the likeliest first.
#pragma once

#include <algorithm>
#include <bit>
#include <iterator>
#include <limits>
#include <utility>

#include "odds/math/elementary.hpp"
#include "query/wide/frontier.hpp"

namespace odds::query::wide {

/// Where surfaces meet, volumes overlap deeply for how thick the surfaces are (see `ranks`): the order of Algorithm 4.3
/// leads to a hit with half to three quarters of the pairs that a depth-first search opens.
///
/// A queue would cost more than that saves. Here what is open stands in one array, and the likeliest of the newest
/// `window` is found by comparing them all, while the kernel is busy with a pair; of what that pair brings the
/// likeliest is known without a look at memory.
template <class L>
class LikeliestFirst {
 public:
  explicit LikeliestFirst(Frontier<L>& frontier) noexcept : at_(frontier), task_(frontier.task) {
    for (std::size_t i = 0; i < window; i += wide_lanes) L::store(keys_ + i, L::all(nothing));
  }

  /// Goes on until a hit, through at most `most_opened` pairs and, where no budget wants to know where they may meet,
  /// only while one may well do so: where none may, bodies are mostly apart, and for a proof of that any order will do.
  /// False: the search has ended. Preconditions: one pair is open, and nothing else; a hit ends the search.
  bool run() noexcept {
    OpenPairs& open = at_.open;
    const float least_likely = task_.request.budget.is_limited() ? nothing : -likely;
    Next next{open.opened[0], open.other[0], -nothing};
    open.size = 0;
    for (std::uint32_t opened = 0; opened < most_opened && next.key <= least_likely; ++opened) {
      if (!at_.may_open()) {
        put_back(next);
        task_.result.ended = Progressed::spent;
        leave_likeliest();
        return false;
      }
      if (task_.spending.nears_end()) ask_for_statistics(next);
      task_.spending.spend_node_pairs(wide_lanes);
      const Opened pair(at_.met, next.opened, next.other);
      const Kept kept = likeliest_of(open.size);
      const FoundLanes<L> found = at_.opener.find(pair);
      if (found.leaf_pairs != 0) add_leaves<L>(pair, found.leaf_pairs, at_.leaf_pairs);
      const bool is_last = found.open == 0 && open.size == 0;
      if (!is_last) next = choose_next(pair, found, kept);
      if (found.leaf_pairs == 0) {
        if (is_last) return true;
        continue;
      }
      if (!is_last) put_back(next);
      if (!at_.visit_leaf_pairs()) {
        if (task_.result.ended == Progressed::spent) leave_likeliest();
        return false;
      }
      if (is_last) return true;
      --open.size;
    }
    put_back(next);
    return true;
  }

 private:
  using F = typename L::Float;

  /// After so many a proof that the bodies are apart is the likelier end, and that comes sooner by several at a time.
  static constexpr std::uint32_t most_opened = 32;
  static constexpr std::size_t most_open = most_opened * (wide_lanes - 1) + 1;
  static_assert(most_open <= Frontier<L>::crowded);
  static constexpr std::size_t window = 32;
  static_assert(window == 4 * wide_lanes);
  /// A key that no pair has. Keys are gaps for the thickness of both surfaces: the least is the likeliest.
  static constexpr float nothing = std::numeric_limits<float>::infinity();
  static constexpr float least_thickness = 1e-30F;
  /// Of all near-contact poses of 60,000 triangles and more those apart are below that after ten pairs for the most
  /// part, those that meet in one of ten.
  static constexpr float likely = 0.2F;

  struct Next {
    LaneAddress opened;
    LaneAddress other;
    float key;
  };
  struct Kept {
    float key;
    std::size_t index;
  };

  /// Of the first `size` in the array the likeliest of the newest, and of equals the newest. Meaningless if there are
  /// none.
  [[nodiscard]] ODDS_LANES_INLINE Kept likeliest_of(std::size_t size) const noexcept {
    const float* const newest = keys_ + size;  // behind as many that are nothing
    F keys[window / wide_lanes];
    for (std::size_t i = 0; i < std::size(keys); ++i) keys[i] = L::load_from(newest + i * wide_lanes);
    const F least = L::min(L::min(keys[0], keys[1]), L::min(keys[2], keys[3]));
    const float key = L::least_value(least);
    std::uint32_t has_key = 0;
    for (std::size_t i = 0; i < std::size(keys); ++i) {
      has_key |= L::less_equal(keys[i], L::all(key)) << (i * wide_lanes);
    }
    return {key, size - 1 - static_cast<std::size_t>(std::countl_zero(has_key))};
  }

  /// Keeps what a pair has brought but for the pair to be opened next.
  [[nodiscard]] ODDS_LANES_INLINE Next choose_next(const Opened& pair, const FoundLanes<L>& found,
                                                   const Kept& kept) noexcept {
    OpenPairs& open = at_.open;
    if (found.open == 0) {
      const Next next{open.opened[kept.index], open.other[kept.index], kept.key};
      remove(kept.index);
      return next;
    }
    const F thickness = L::max(found.thickness, L::all(least_thickness));
    // Finite: of surfaces without any thickness, 1e9 m large, a gap that rounding may hide is not.
    const F ratio = L::min(found.gap * L::divide(L::all(1.0F), thickness), L::all(std::numeric_limits<float>::max()));
    const F keys = L::choose_at_most(found.gap, found.bound, ratio, L::all(nothing));
    const auto lane = L::least(keys);
    const unsigned others = found.open & ~(1U << lane);
    L::write_some(keys_ + window + open.size, keys, others);
    open.add<L>(pair, others, found.opens_lane);
    const bool opens_own = (found.opens_lane >> lane & 1U) != 0;
    const LaneAddress mark = pair.side * OpenPairs::of_b;
    Next next{opens_own ? (pair.first + lane) | mark : pair.other | (mark ^ OpenPairs::of_b),
              opens_own ? pair.other : pair.first + lane, L::least_value(keys)};
    if (kept.key < next.key) {
      std::swap(next.opened, open.opened[kept.index]);
      std::swap(next.other, open.other[kept.index]);
      std::swap(next.key, keys_[window + kept.index]);
    }
    return next;
  }

  ODDS_LANES_INLINE void put_back(const Next& next) noexcept {
    OpenPairs& open = at_.open;
    open.opened[open.size] = next.opened;
    open.other[open.size] = next.other;
    keys_[window + open.size] = next.key;
    ++open.size;
  }
  void remove(std::size_t index) noexcept {
    OpenPairs& open = at_.open;
    --open.size;
    open.opened[index] = open.opened[open.size];
    open.other[index] = open.other[open.size];
    keys_[window + index] = keys_[window + open.size];
  }

  /// Of what is left open if the search ends soon: once of the likeliest, then of what became likelier.
  void ask_for_statistics(const Next& next) noexcept {
    OpenPairs& open = at_.open;
    if (!has_asked_) {
      has_asked_ = true;
      for (std::size_t size = open.size; size != 0 && open.size - size < Shortlist::capacity; --size) {
        const std::size_t likeliest = likeliest_of(size).index;  // in this array any order will do
        std::swap(open.opened[likeliest], open.opened[size - 1]);
        std::swap(open.other[likeliest], open.other[size - 1]);
        std::swap(keys_[window + likeliest], keys_[window + size - 1]);
      }
      at_.ask_for_statistics();
    }
    put_back(next);
    const SlotPair pair = open.pair(--open.size);
    at_.met.prefetch({pair.of[0], pair.of[1], next.key});
  }

  void leave_likeliest() noexcept {
    const std::uint32_t all = task_.result.open + static_cast<std::uint32_t>(at_.open.size);
    while (at_.open.size != 0 && !task_.result.shortlist.full()) {
      const Kept kept = likeliest_of(at_.open.size);
      const SlotPair pair = at_.open.pair(kept.index);
      leave_open<L>(task_, {pair.of[0], pair.of[1], kept.key == -nothing ? unranked : rank_of_key(kept.key)});
      remove(kept.index);
    }
    task_.result.open = all;
  }
  /// As `ranks` has it, of pairs that overlap.
  [[nodiscard]] static float rank_of_key(float key) noexcept {
    return math::rough_log2(static_cast<double>(std::clamp(-key, 1e-30F, 1e30F)));
  }

  Frontier<L>& at_;
  Task& task_;
  bool has_asked_ = false;
  alignas(64) float keys_[window + most_open + wide_lanes];  // lanes are written eight at a time
};

}  // namespace odds::query::wide
