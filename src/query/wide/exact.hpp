// The exact search: until a proof or the budget ends it.
#pragma once

#include "query/wide/depth_first.hpp"
#include "query/wide/instalment.hpp"
#include "query/wide/likeliest_first.hpp"

namespace odds::query::wide {

/// For a verdict or one contact the likeliest pair first, and what that leaves depth-first, several pairs at a time.
///
/// For several contacts, also if they have to be made of one hit, depth-first from the beginning, the deepest overlap
/// first: such hits are worth a contact, while the likeliest may be where a side of one body only just crosses the
/// other.
template <class L>
struct Exact {
  /// The result says which order it was.
  static void run_from_roots(Task& task) noexcept {
    task.result.method = wants_several(task) ? Method::exact : Method::time_critical;
    run(task, tree::WideTree::root, tree::WideTree::root);
  }
  static void run(Task& task, Slot start_a, Slot start_b) noexcept {
    Frontier<L> frontier(task, start_a, start_b);
    if (wants_several(task) && task.sweep != nullptr) return go_on(frontier, start_a, start_b);
    if (wants_several(task)) return DepthFirst<L, true>(frontier).run();
    if (frontier.open.size == 0 || LikeliestFirst<L>(frontier).run()) DepthFirst<L, false>(frontier).run();
  }

 private:
  /// With what met and what was left open, then from the roots.
  static void go_on(Frontier<L>& frontier, Slot start_a, Slot start_b) noexcept {
    Task& task = frontier.task;
    Instalment<L> instalment(frontier);
    if (task.sweep->runs_left == 0) {
      const Sweep::MetLeaves before = task.sweep->met;
      task.sweep->met.forget();
      DepthFirst<L, true>(frontier).run();
      return instalment.judge_search_from_roots(before);
    }
    --task.sweep->runs_left;
    const bool resumes = instalment.resume();
    if (!instalment.look_at_met()) {
      if (task.result.ended == Progressed::spent) frontier.leave_newest();
      return;
    }
    DepthFirst<L, true>(frontier).run();
    if (resumes && task.result.ended == Progressed::finished) {
      if (task.hits.empty()) {
        frontier.start(start_a, start_b);
        DepthFirst<L, true>(frontier).run();
      } else {
        task.result.ended = Progressed::enough;  // there may be more that has come since
      }
    }
    instalment.keep();
  }
  [[nodiscard]] static bool wants_several(const Task& task) noexcept { return task.request.max_contacts > 1; }
};

}  // namespace odds::query::wide
