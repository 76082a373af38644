// Incremental search (Li and Chen 1998): the bottom slice of the bounding volume test tree is kept between calls.
#pragma once

#include <cstdint>
#include <vector>

#include "query/search/search.hpp"

namespace odds::query {

/// The part of the test tree that earlier searches unfolded. Its leaves are the bottom slice: every pair of triangles
/// lies below exactly one of them, so a search that tests the slice, going down where volumes overlap now and up where
/// a parent is apart again, is as exact as one from the root. Fixed capacity: what finds no room is searched and not
/// kept.
class BottomSlice {
 public:
  explicit BottomSlice(std::uint32_t capacity) : nodes_(capacity) { reset(); }

  void reset() noexcept {
    used_ = 1;
    free_ = none;
    slice_size_ = 1;
    nodes_[0] = {};
    pause_ = 0;
  }

  /// Whether it is better left alone in this run, within a limit: a slice that its budget ended is not taken up where
  /// it stopped, and for some runs the likeliest pairs tell more.
  [[nodiscard]] bool pauses() noexcept {
    if (pause_ == 0) return false;
    --pause_;
    return true;
  }

  /// How many pairs the slice has; 1 after reset.
  [[nodiscard]] std::uint32_t size() const noexcept { return slice_size_; }

  template <volume::BoundingVolume V>
  void search(const Encounter<V>& encounter, std::uint32_t wanted, HitList& hits, Spending& spending,
              SearchResult& result) noexcept {
    Visit<V> visit{*this, encounter, wanted, hits, spending, result};
    static_cast<void>(visit.below(0));
    if (result.ended == Progressed::spent) pause_ = pause;
  }

 private:
  static constexpr std::uint32_t none = 0xFFFFFFFFU;
  static constexpr std::uint32_t pause = 64;  ///< runs

  struct Node {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    std::uint32_t children = none;  ///< two adjacent nodes, or none: part of the slice
  };

  /// Two adjacent nodes, or none.
  [[nodiscard]] std::uint32_t take_two() noexcept {
    if (free_ != none) {
      const std::uint32_t taken = free_;
      free_ = nodes_[taken].children;
      return taken;
    }
    if (used_ + 2 > nodes_.size()) return none;
    used_ += 2;
    return used_ - 2;
  }

  void give_back_two(std::uint32_t first) noexcept {
    nodes_[first].children = free_;
    free_ = first;
  }

  /// One search. Recursion is as deep as the test tree: at most twice the deepest level.
  template <volume::BoundingVolume V>
  struct Visit {
    BottomSlice& slice;
    const Encounter<V>& encounter;
    std::uint32_t wanted;
    HitList& hits;
    Spending& spending;
    SearchResult& result;

    /// What was learnt about a pair. `apart`: its own volumes are known to be apart now, or it is a pair of leaves
    /// whose volumes are not to be tested: whether it may go is its parent's to say.
    enum class Found : std::uint8_t { apart, kept, stopped };

    [[nodiscard]] Found below(std::uint32_t index) noexcept {
      if (slice.nodes_[index].children == none) return at_slice(index);
      const std::uint32_t first = slice.nodes_[index].children;
      const Found left = below(first);
      if (left == Found::stopped) return Found::stopped;
      const Found right = below(first + 1);
      if (right == Found::stopped) return Found::stopped;
      if (left != Found::apart || right != Found::apart) return Found::kept;
      // Both children are apart: the slice moves up if their parent is, too.
      if (slice.nodes_[first].children != none || slice.nodes_[first + 1].children != none) return Found::kept;
      if (!spending.may_go_on() || !spending.allows(1)) return stop(index, Progressed::spent);
      spending.spend_node_pairs(1);
      if (encounter.volumes_overlap(slice.nodes_[index].a, slice.nodes_[index].b)) return Found::kept;
      slice.nodes_[index].children = none;
      slice.give_back_two(first);
      --slice.slice_size_;
      return Found::apart;
    }

    [[nodiscard]] Found at_slice(std::uint32_t index) noexcept {
      const NodePair pair{slice.nodes_[index].a, slice.nodes_[index].b, 0.0F};
      if (!spending.may_go_on() || !spending.allows(1)) return stop(index, Progressed::spent);
      spending.spend_node_pairs(1);
      if (!encounter.volumes_overlap(pair.a, pair.b)) return Found::apart;
      if (encounter.is_leaf_pair(pair.a, pair.b)) {
        const Progressed leaves = encounter.test_leaves(pair.a, pair.b, wanted, hits, spending);
        if (leaves != Progressed::finished) return stop(index, leaves);
        return encounter.tests_leaf_volumes() ? Found::kept : Found::apart;
      }
      const std::uint32_t first = slice.take_two();
      if (first == none) {
        spending.note_full_queue();
        search_depth_first(encounter, pair, wanted, hits, spending, result);
        return result.ended == Progressed::finished ? Found::kept : Found::stopped;
      }
      const auto children = encounter.children(pair.a, pair.b);
      slice.nodes_[first] = {children.first.a, children.first.b, none};
      slice.nodes_[first + 1] = {children.second.a, children.second.b, none};
      slice.nodes_[index].children = first;
      ++slice.slice_size_;
      const Found left = at_slice(first);
      if (left == Found::stopped) return Found::stopped;
      return at_slice(first + 1) == Found::stopped ? Found::stopped : Found::kept;
    }

    [[nodiscard]] Found stop(std::uint32_t index, Progressed how) noexcept {
      result.ended = how;
      if (how == Progressed::spent) {
        NodePair pair{slice.nodes_[index].a, slice.nodes_[index].b, 0.0F};
        pair.rank = encounter.rank(pair.a, pair.b);
        consider(result, pair);
      }
      return Found::stopped;
    }
  };

  std::vector<Node> nodes_;
  std::uint32_t used_ = 1;
  std::uint32_t free_ = none;
  std::uint32_t slice_size_ = 1;
  std::uint32_t pause_ = 0;  ///< runs
};

}  // namespace odds::query
