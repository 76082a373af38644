// The time-critical search: Algorithm 4.3 on the wide tree.
#pragma once

#include "query/wide/depth_first.hpp"

namespace odds::query::wide {

/// Likeliest pair first. Ends on proof, on k_min pairs with p >= p_min, or with the budget.
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

}  // namespace odds::query::wide
