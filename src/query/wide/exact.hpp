// The exact search: until a proof or the budget ends it.
#pragma once

#include "query/wide/depth_first.hpp"
#include "query/wide/likeliest_first.hpp"

namespace odds::query::wide {

/// Where one hit is enough, likeliest pair first, and what that leaves depth-first, several pairs at a time.
///
/// Where several are wanted, depth-first from the beginning, the deepest overlap first: such hits are worth a contact,
/// while the likeliest may be where a side of one body only just crosses the other.
template <class L>
struct Exact {
  /// The result says which order it was.
  static void run_from_roots(Task& task) noexcept {
    task.result.method = task.wanted > 1 ? Method::exact : Method::time_critical;
    run(task, tree::WideTree::root, tree::WideTree::root);
  }
  static void run(Task& task, Slot start_a, Slot start_b) noexcept {
    Frontier<L> frontier(task, start_a, start_b);
    if (task.wanted > 1) return DepthFirst<L, true>(frontier).run();
    if (frontier.open.size == 0 || LikeliestFirst<L>(frontier).run()) DepthFirst<L, false>(frontier).run();
  }
};

}  // namespace odds::query::wide
