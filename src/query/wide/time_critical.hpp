// The time-critical search: Algorithm 4.3 on the wide tree.
#pragma once

#include "query/wide/exact.hpp"

namespace odds::query::wide {

/// Where pairs are counted by probability, or no polygons are left to prove anything with: likeliest pair first. Ends
/// on proof, on k_min pairs with p >= p_min, or with the budget.
///
/// Where only a proof ends it before the budget does, it is the exact search, which starts in the same order at a
/// quarter of the price of a pair: nobody has to be asked how probable it is.
template <class L>
class TimeCritical {
 public:
  static void run(Task& task) noexcept {
    if (task.request.p_min >= 1.0 && !task.request.polygon_free) return Exact<L>::run_from_roots(task);
    TimeCritical search(task);
    search.run();
  }

 private:
  explicit TimeCritical(Task& task) noexcept : task_(task), met_(task.encounter) {}

  void run() noexcept {
    task_.queue->clear();
    task_.queue->push(0, {tree::WideTree::root, tree::WideTree::root, unranked});
    if (!task_.spending.may_go_on()) finish(Progressed::spent);
    while (!task_.queue->empty() && !finished_) {
      if (!task_.spending.may_go_on_in_time(units_between_polls)) {
        finish(Progressed::spent);
        break;
      }
      if (task_.spending.nears_end()) {
        task_.queue->show_first(Shortlist::capacity, [this](const NodePair& pair) { met_.prefetch(pair); });
      }
      visit(task_.queue->pop());
    }
    SearchResult& result = task_.result;
    if (result.is_judged()) {
      leave_open<L>(task_, result.judged.likeliest);
      result.open += task_.queue->size();
    } else if (result.ended != Progressed::finished) {
      consider_queue();
    }
  }

  void consider_queue() noexcept {
    SearchResult& result = task_.result;
    const std::uint32_t open = result.open + task_.queue->size();
    task_.queue->show_first(Shortlist::capacity, [&](const NodePair& pair) { leave_open<L>(task_, pair); });
    result.open = open;
  }

  void finish(Progressed how) noexcept {
    task_.result.ended = how;
    finished_ = true;
  }

  [[nodiscard]] std::uint32_t levels_left(const NodePair& pair) const noexcept {
    return met_.child(0, pair.a).height() + met_.child(1, pair.b).height();
  }

  void visit(const NodePair& pair) noexcept {
    const std::uint32_t levels = levels_left(pair);
    if (levels == 0) return visit_leaf_pair(pair);
    if (!task_.spending.allows(wide_lanes)) {
      leave_open<L>(task_, pair);
      return finish(Progressed::spent);
    }
    const Expanded<L> expanded = expand<L, true>(met_, {{pair.a, pair.b}});
    task_.spending.spend_node_pairs(wide_lanes);
    meet_lanes(expanded, levels);
  }

  void meet_lanes(const Expanded<L>& expanded, std::uint32_t levels) noexcept {
    alignas(64) float rank[wide_lanes];
    L::store(rank, expanded.ranks);
    const float cost = log_cost.of[std::min<std::uint32_t>(levels - 1, log_cost.most)];
    NodePair child;
    (expanded.side == 0 ? child.b : child.a) = expanded.other;
    Slot& opened = expanded.side == 0 ? child.a : child.b;
    bool is_time_up = false;
    for (unsigned lanes = expanded.lanes; lanes != 0 && !finished_; lanes &= lanes - 1U) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
      opened = expanded.first + lane;
      child.rank = rank[lane];
      is_time_up = is_time_up || !task_.spending.may_go_on_in_time(units_between_polls);
      if (is_time_up) {
        keep(child, cost);
        continue;
      }
      if (task_.request.estimator != EstimatorKind::kinematic) {
        note_estimate();
        child.rank = met_.rank(child.a, child.b);
      }
      meet(child, cost);
    }
    if (is_time_up) finish(Progressed::spent);
  }

  /// To ask how probable a pair is takes as long as opening one or two, and counts as none: the clock is looked at so
  /// much sooner.
  void note_estimate() noexcept {
    task_.spending.hasten_poll(task_.request.estimator == EstimatorKind::kinematic ? wide_lanes : 2 * wide_lanes);
  }
  [[nodiscard]] float probability(const NodePair& pair) noexcept {
    note_estimate();
    return met_.probability(pair.a, pair.b);
  }

  /// log2 of what is left to do below a pair: each level of eight lanes is worth three of two.
  struct LogCost {
    static constexpr std::uint32_t most = 2 * tree::ChildRef::highest;
    float of[most + 1];
  };
  static constexpr LogCost log_cost = [] {
    LogCost cost{};
    for (std::uint32_t levels = 0; levels <= LogCost::most; ++levels) {
      // log2(x) = 2 / ln 2 * artanh((x / 2^n - 1) / (x / 2^n + 1)) + n
      double x = 3.0 * levels + 2.0;
      double log = 0.0;
      for (; x >= 2.0; x /= 2.0) log += 1.0;
      const double y = (x - 1.0) / (x + 1.0);
      double power = y;
      double sum = 0.0;
      for (int k = 1; k < 30; k += 2, power *= y * y) sum += power / k;
      cost.of[levels] = static_cast<float>(log + 2.0 * sum / 0.69314718055994531);
    }
    return cost;
  }();

  void visit_leaf_pair(const NodePair& pair) noexcept {
    if (task_.request.polygon_free) {
      if (task_.result.judged.note(pair, probability(pair))) finish(Progressed::enough);
      return;
    }
    if (!task_.spending.allows(wide_lanes)) {
      leave_open<L>(task_, pair);
      return finish(Progressed::spent);
    }
    if (visit_leaves<L>(task_, pair.a, pair.b)) return;
    if (task_.result.ended == Progressed::spent) leave_open<L>(task_, pair);
    finished_ = true;
  }

  void meet(const NodePair& pair, float cost) noexcept {
    if (task_.request.p_min < 1.0) {
      const float p = probability(pair);
      if (static_cast<double>(p) >= task_.request.p_min) {
        task_.result.estimate = std::max(task_.result.estimate, p);
        if (++sure_pairs_ >= task_.request.k_min) {
          task_.result.estimated_hit = true;
          leave_open<L>(task_, pair);
          return finish(Progressed::enough);
        }
      }
    }
    add(pair, cost);
  }

  void push(const NodePair& pair, float cost) noexcept {
    task_.queue->push(bucket_of_value(std::min(pair.rank, highest_rank) - cost), pair);
  }

  /// A pair that there was no time to ask anything about; its rank is how deep it overlaps.
  void keep(const NodePair& pair, float cost) noexcept {
    if (!task_.queue->full()) return push(pair, cost);
    leave_open<L>(task_, pair);
  }

  void add(const NodePair& pair, float cost) noexcept {
    if (!task_.queue->full()) return push(pair, cost);
    // Nothing is dropped: what finds no room is searched to its end at once.
    task_.spending.note_full_queue();
    if (task_.request.polygon_free) return leave_open<L>(task_, pair);  // no triangles to fall back on
    Exact<L>::run(task_, pair.a, pair.b);
    if (task_.result.ended != Progressed::finished) finished_ = true;
  }

  Task& task_;
  const Encounter& met_;
  std::uint32_t sure_pairs_ = 0;
  bool finished_ = false;
};

}  // namespace odds::query::wide
