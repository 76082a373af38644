// The exact search: as Algorithm 4.2, a few pairs at a time, after a start that looks for a hit.
#pragma once

#include "query/wide/likeliest_first.hpp"

namespace odds::query::wide {

/// The newest few pairs are opened at a time: what is found below one says which pair is next, so that one pair after
/// the other would wait for the end of every sum, and for its numbers from memory. What remains is kept without
/// branches that nobody could predict.
///
/// Where one hit is enough it comes after a start with the likeliest pairs, and opens six at a time, as they come.
///
/// Where several are wanted (`ordered`), it is two from the beginning, the deepest overlap first: such hits are worth a
/// contact, while the likeliest may be where a side of one body only just crosses the other. And it does not go on
/// beside a hit but somewhere else: hits that are found until a budget ends it, or until no more are kept, come from
/// all over the rim, and contacts made of them hold a body on all sides.
template <class L, bool ordered = false>
class DepthFirst {
 public:
  /// The search from the roots, whose result says which order it was.
  static void run_from_roots(Task& task) noexcept {
    task.result.method = task.wanted > 1 ? Method::exact : Method::time_critical;
    run(task, tree::WideTree::root, tree::WideTree::root);
  }
  static void run(Task& task, Slot start_a, Slot start_b) noexcept {
    Frontier<L> frontier(task, start_a, start_b);
    if (task.wanted > 1) return DepthFirst<L, true>(frontier).run();
    if (frontier.open.size != 0) {
      // A budget also wants to know where they may meet.
      LikeliestFirst<L> start(frontier);
      if (!start.run(most_started, task.request.budget.is_limited())) return;
    }
    DepthFirst<L>(frontier).run();
  }

  explicit DepthFirst(Frontier<L>& frontier) noexcept : at_(frontier), task_(frontier.task) {}

  void run() noexcept {
    while (at_.open.size != 0 || at_.leaf_pairs.size != 0) {
      if (at_.leaf_pairs.size != 0) {
        if (!at_.visit_leaf_pairs()) return leave_rest();
        go_elsewhere();
        continue;
      }
      if (!at_.may_open()) {
        task_.result.ended = Progressed::spent;
        return leave_rest();
      }
      if (task_.spending.nears_end()) at_.ask_for_statistics();
      open_newest();
    }
  }

 private:
  void open_newest() noexcept {
    OpenPairs& open = at_.open;
    const std::size_t allowed = std::max<std::size_t>(1, task_.spending.units_left() / wide_lanes);
    const std::size_t most = open.size <= Frontier<L>::crowded ? std::min(at_once, allowed) : 1;
    const auto count = static_cast<std::uint32_t>(std::min(open.size, most));
    open.size -= count;
    task_.spending.spend_node_pairs(count * wide_lanes);
    at_.opener.template run<ordered>(count, open, at_.leaf_pairs);
  }

  /// After a hit, to an open pair that follows no order. Not while crowded: what bounds the room is that then the
  /// newest is opened, always.
  void go_elsewhere() noexcept {
    OpenPairs& open = at_.open;
    if (!at_.has_new_hits() || open.size < 2 || open.size > Frontier<L>::crowded) return;
    at_.note_hits();
    open.bring_up(elsewhere(task_.hits.size(), open.size - 1));
  }

  void leave_rest() noexcept {
    if (task_.result.ended == Progressed::spent) at_.leave_newest();
  }

  /// Pairs. Of 1 to 8 these are fastest: more waste less time waiting, and open more for nothing where there is a hit.
  static constexpr std::size_t at_once = ordered ? 2 : 6;
  static_assert(at_once <= Opener<L>::most);
  /// Pairs of the start. After them a proof that the bodies are apart is the likelier end, and that comes sooner by six
  /// at a time.
  static constexpr std::uint32_t most_started = 32;

  Frontier<L>& at_;
  Task& task_;
};

}  // namespace odds::query::wide
