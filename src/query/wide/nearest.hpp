// The distance between two wide trees: nearest pair of slots first, by branch and bound.
#pragma once

#include <algorithm>
#include <limits>

#include "query/wide/opening.hpp"

namespace odds::query::wide {

/// Gaps bound distances from below, pairs of triangles from above; what cannot be nearer than the nearest pair found is
/// not opened.
template <class L>
class Nearest {
 public:
  static void run(NearestTask& task) noexcept {
    Nearest search(task);
    search.run();
  }

 private:
  struct Open {
    SlotPair pair;
    float gap;
  };

  explicit Nearest(NearestTask& task) noexcept : task_(task), met_(task.encounter) {}

  void run() noexcept {
    stack_[0] = {{{tree::WideTree::root, tree::WideTree::root}}, 0.0F};
    size_ = 1;
    while (size_ != 0) {
      if (too_far(stack_[size_ - 1].gap)) {
        --size_;
        continue;
      }
      if (!task_.spending.may_go_on_in_time(units_between_polls) || !task_.spending.allows(wide_lanes)) return leave();
      const SlotPair pair = stack_[size_ - 1].pair;
      if (is_leaf(0, pair.of[0]) && is_leaf(1, pair.of[1])) {
        if (!compare_leaves(pair)) return leave();
        --size_;
      } else {
        --size_;
        open(pair);
      }
    }
    task_.finished = true;
  }

  [[nodiscard]] bool is_leaf(std::uint32_t side, Slot slot) const noexcept { return met_.child(side, slot).is_leaf(); }

  [[nodiscard]] double least_distance(float gap) const noexcept {
    return std::max(static_cast<double>(gap) - static_cast<double>(met_.margin()), 0.0);
  }
  /// What is as near as the bound is asked for until something is found: within a margin of 0 all that touches is.
  [[nodiscard]] bool may_be_nearer(double least) const noexcept {
    return least < task_.bound || (least == task_.bound && !task_.found);
  }
  [[nodiscard]] bool too_far(float gap) const noexcept { return !may_be_nearer(least_distance(gap)); }

  void open(const SlotPair& pair) noexcept {
    const Expanded<L> expanded = expand<L, false, true>(met_, pair);
    task_.spending.spend_node_pairs(wide_lanes);
    alignas(64) float gap[wide_lanes];
    L::store(gap, expanded.gaps);
    const std::size_t first = size_;
    for (std::uint32_t lane = 0; lane < wide_lanes; ++lane) {
      if (too_far(gap[lane])) continue;  // lanes without a child are farther than anything
      Open child{{}, gap[lane]};
      child.pair.of[expanded.side] = expanded.first + lane;
      child.pair.of[1 - expanded.side] = expanded.other;
      // The nearest last, for it is visited first and lowers the bound.
      std::size_t at = size_++;
      for (; at > first && stack_[at - 1].gap < child.gap; --at) stack_[at] = stack_[at - 1];
      stack_[at] = child;
    }
  }

  /// False if the budget ended it.
  bool compare_leaves(const SlotPair& pair) noexcept {
    const PlacedLeaf in_a = met_.leaf(0, pair.of[0]);
    const PlacedLeaf in_b = met_.leaf(1, pair.of[1]);
    float shift[3];
    met_.shift(pair.of[0], pair.of[1], shift);
    alignas(64) float gaps[wide_lanes][wide_lanes];
    triangle_gaps<L>(SpreadLeaves<L>(in_a, in_b, met_.turn_into(0), shift, met_.margin()), in_b.count(), gaps);
    const std::uint32_t rows = in_b.count();
    task_.spending.spend_triangle_pairs(rows);
    // The nearest first, so that the bound sinks before the others are asked.
    for (;;) {
      std::uint32_t row = 0;
      std::uint32_t lane = 0;
      for (std::uint32_t r = 0; r < rows; ++r) {
        for (std::uint32_t l = 0; l < in_a.count(); ++l) {
          if (gaps[r][l] < gaps[row][lane]) {
            row = r;
            lane = l;
          }
        }
      }
      if (!may_be_nearer(static_cast<double>(gaps[row][lane]))) return true;
      gaps[row][lane] = std::numeric_limits<float>::infinity();
      if (!task_.spending.may_go_on() || !task_.spending.allows(1)) return false;
      task_.spending.spend_triangle_pairs(1);
      met_.bring_nearer(in_a.leaf.triangle[lane], in_b.leaf.triangle[row], task_);
    }
  }

  void leave() noexcept {
    double lower = task_.bound;
    for (std::size_t i = 0; i < size_; ++i) lower = std::min(lower, least_distance(stack_[i].gap));
    task_.lower = lower;
  }

  NearestTask& task_;
  const Encounter& met_;
  Open stack_[wide_stack_capacity];
  std::size_t size_ = 0;
};

}  // namespace odds::query::wide
