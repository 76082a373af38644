// The exact search: until a proof or the budget ends it.
#pragma once

#include "query/wide/depth_first.hpp"
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
    if (wants_several(task)) return DepthFirst<L, true>(frontier).run();
    if (frontier.open.size == 0 || LikeliestFirst<L>(frontier).run()) DepthFirst<L, false>(frontier).run();
  }

 private:
  [[nodiscard]] static bool wants_several(const Task& task) noexcept { return task.request.max_contacts > 1; }
};

}  // namespace odds::query::wide
