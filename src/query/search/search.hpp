// The searches over pairs of nodes: depth-first (Algorithm 4.2) and time-critical (Algorithm 4.3).
#pragma once

#include <bit>

#include "query/search/encounter.hpp"
#include "query/search/shortlist.hpp"

namespace odds::query {

/// A depth-first search pops one pair and pushes two, one level lower on one side.
inline constexpr std::size_t stack_capacity = 2 * tree::deepest_level + 2;

/// Pairs of leaves that were judged by their probabilities, since there are no polygons.
struct JudgedLeaves {
  static constexpr float enough = 0.5F;  ///< a pair of leaves as likely as this ends a search (footnote 6)
  NodePair likeliest;
  float greatest = -1.0F;  ///< its probability, which may be 0; less: no pair was judged
  float sum = 0.0F;        ///< of all their probabilities

  /// Whether that is enough.
  bool note(const NodePair& pair, float probability) noexcept {
    sum += probability;
    if (probability > greatest) {
      greatest = probability;
      likeliest = pair;
    }
    return probability >= enough;
  }
};

/// What a search found besides the hits.
struct SearchResult {
  Progressed ended = Progressed::finished;
  bool estimated_hit = false;             ///< k_min pairs reached p_min
  float estimate = 0.0F;                  ///< the greatest probability that such a pair had
  JudgedLeaves judged;                    ///< of a polygon-free search
  std::uint32_t open = 0;                 ///< pairs of nodes that were left undecided
  Shortlist shortlist;                    ///< the likeliest of them
  Method method = Method::time_critical;  ///< the order that was followed

  /// Whether a polygon-free search ended by what it made of pairs of leaves: by one that was enough, or by all of them.
  [[nodiscard]] bool is_judged() const noexcept {
    return judged.greatest >= 0.0F && ended != Progressed::spent && !estimated_hit;
  }
};

/// Notes a pair that is left undecided. The likeliest come first; what finds no room is only counted.
inline void consider(SearchResult& result, const NodePair& pair) noexcept {
  ++result.open;
  result.shortlist.add(pair);
}

/// Notes all pairs that wait in the queue.
inline void consider(SearchResult& result, const BucketQueue& queue) noexcept {
  result.open += queue.size();
  queue.show_first(Shortlist::capacity, [&](const NodePair& pair) { result.shortlist.add(pair); });
}

/// Whether a pair of volumes takes some microsecond to compare, not some hundredths of one: then the clock is read
/// before each.
constexpr bool are_pieces_long(volume::Kind kind) noexcept { return kind == volume::Kind::hull; }
template <volume::BoundingVolume V>
inline constexpr bool pieces_are_long = are_pieces_long(kind_of<V>);

/// Depth-first from `start` until done, `wanted` hits or the budget's end. Without estimates, so the fastest way to a
/// proof of separation. On the budget's end the newest undecided pairs are estimated once.
template <volume::BoundingVolume V>
void search_depth_first(const Encounter<V>& encounter, NodePair start, std::uint32_t wanted, HitList& hits,
                        Spending& spending, SearchResult& result) noexcept {
  std::array<NodePair, stack_capacity> stack;
  std::size_t size = 0;
  stack[size++] = start;
  const auto stop = [&](Progressed how) {
    result.ended = how;
    if (how != Progressed::spent) return;
    constexpr std::size_t estimated_at_most = 4;  // each estimate costs about as much as a node pair
    result.open += static_cast<std::uint32_t>(size);
    for (std::size_t n = 0; n < estimated_at_most && n < size; ++n) {
      NodePair& pair = stack[size - 1 - n];
      pair.rank = encounter.rank(pair.a, pair.b);
      result.shortlist.add(pair);
    }
  };
  while (size != 0) {
    const NodePair pair = stack[size - 1];
    if (!spending.may_go_on()) return stop(Progressed::spent);
    if (encounter.is_leaf_pair(pair.a, pair.b)) {
      const Progressed leaves = encounter.test_leaves(pair.a, pair.b, wanted, hits, spending);
      if (leaves != Progressed::finished) return stop(leaves);
      --size;
      continue;
    }
    if (!spending.allows(2)) return stop(Progressed::spent);
    --size;
    const auto children = encounter.children(pair.a, pair.b);
    spending.spend_node_pairs(2);
    if (encounter.volumes_overlap(children.second.a, children.second.b)) stack[size++] = children.second;
    if (pieces_are_long<V> && !spending.may_go_on()) {
      stack[size++] = children.first;
      return stop(Progressed::spent);
    }
    if (encounter.volumes_overlap(children.first.a, children.first.b)) stack[size++] = children.first;
  }
}

/// Expectations above this count as this, so that among nearly certain pairs the newest and deepest come first instead
/// of all coarse ones; log2.
inline constexpr float highest_rank = 0.5F;

/// The bucket of log2 of a pair's expected crossings per remaining cost, in quarters; the lowest for a NaN.
[[nodiscard]] inline std::uint32_t bucket_of_value(float value) noexcept {
  return static_cast<std::uint32_t>(std::min(63.0F, std::max(0.0F, 60.0F + 4.0F * value)));
}

[[nodiscard]] inline std::uint32_t bucket_of(float rank, int levels_left) noexcept {
  return bucket_of_value(std::min(rank, highest_rank) - math::rough_log2(static_cast<double>(levels_left + 2)));
}

/// Algorithm 4.3. Ends on proof (`wanted` hits, or nothing left), on k_min pairs with p >= p_min, or with the budget.
template <volume::BoundingVolume V>
class TimeCriticalSearch {
 public:
  TimeCriticalSearch(const Encounter<V>& encounter, const Request& request, std::uint32_t wanted, BucketQueue& queue,
                     HitList& hits, Spending& spending) noexcept
      : encounter_(encounter), request_(request), wanted_(wanted), queue_(queue), hits_(hits), spending_(spending) {}

  [[nodiscard]] SearchResult run(NodePair root) noexcept {
    queue_.clear();
    root.rank = encounter_.rank(root.a, root.b);
    queue_.push(bucket_of(root.rank, encounter_.levels_left(root.a, root.b)), root);
    while (!queue_.empty() && !finished_) {
      if (!spending_.may_go_on()) {
        finish(Progressed::spent);
        break;
      }
      visit(queue_.pop());
    }
    if (result_.is_judged()) {
      consider(result_, result_.judged.likeliest);
      result_.open += queue_.size();
    } else if (result_.ended != Progressed::finished) {
      consider(result_, queue_);
    }
    return result_;
  }

 private:
  void finish(Progressed how) noexcept {
    result_.ended = how;
    finished_ = true;
  }

  void visit(const NodePair& pair) noexcept {
    if (encounter_.is_leaf_pair(pair.a, pair.b)) return visit_leaves(pair);
    if (!spending_.allows(2)) {
      consider(result_, pair);
      return finish(Progressed::spent);
    }
    spending_.spend_node_pairs(2);
    const auto children = encounter_.children(pair.a, pair.b);
    encounter_.prefetch(children.first);
    encounter_.prefetch(children.second);
    meet(children.first);
    if (finished_) return;
    if (pieces_are_long<V> && !spending_.may_go_on()) {
      consider(result_, {children.second.a, children.second.b, encounter_.rank(children.second.a, children.second.b)});
      return finish(Progressed::spent);
    }
    meet(children.second);
  }

  void visit_leaves(const NodePair& pair) noexcept {
    if (request_.polygon_free) {
      if (result_.judged.note(pair, encounter_.probability(pair.a, pair.b))) finish(Progressed::enough);
      return;
    }
    const Progressed leaves = encounter_.test_leaves(pair.a, pair.b, wanted_, hits_, spending_);
    if (leaves == Progressed::finished) return;
    if (leaves == Progressed::spent) consider(result_, pair);
    finish(leaves);
  }

  void meet(NodePair pair) noexcept {
    if (!encounter_.volumes_overlap(pair.a, pair.b)) return;
    pair.rank = encounter_.rank(pair.a, pair.b);
    if (request_.p_min < 1.0 && passes_threshold(pair)) {
      if (++sure_pairs_ >= request_.k_min) {
        result_.estimated_hit = true;
        consider(result_, pair);
        return finish(Progressed::enough);
      }
    }
    if (!queue_.full()) return queue_.push(bucket_of(pair.rank, encounter_.levels_left(pair.a, pair.b)), pair);
    // Nothing is dropped: what finds no room is searched to its end at once.
    spending_.note_full_queue();
    if (request_.polygon_free) return consider(result_, pair);  // no triangles to fall back on
    search_depth_first(encounter_, pair, wanted_, hits_, spending_, result_);
    if (result_.ended != Progressed::finished) finished_ = true;
  }

  bool passes_threshold(const NodePair& pair) noexcept {
    const float p = encounter_.probability(pair.a, pair.b);
    if (static_cast<double>(p) < request_.p_min) return false;
    result_.estimate = std::max(result_.estimate, p);
    return true;
  }

  const Encounter<V>& encounter_;
  const Request& request_;
  std::uint32_t wanted_;
  BucketQueue& queue_;
  HitList& hits_;
  Spending& spending_;
  SearchResult result_;
  std::uint32_t sure_pairs_ = 0;
  bool finished_ = false;
};

}  // namespace odds::query
