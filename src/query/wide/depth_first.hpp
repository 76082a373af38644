// Depth-first search as Algorithm 4.2, a few pairs at a time.
#pragma once

#include "query/wide/frontier.hpp"

namespace odds::query::wide {

/// The newest few pairs are opened at a time: what is found below one says which pair is next, so that one pair after
/// the other would wait for the end of every sum, and for its numbers from memory. What remains is kept without
/// branches that nobody could predict. It is six at a time, as they come.
///
/// For `several` contacts it is two, the deepest overlap first. And it does not go on beside a hit but somewhere else:
/// hits that are found until a budget ends it, or until no more are kept, come from all over the rim, and contacts made
/// of them hold a body on all sides.
template <class L, bool several>
class DepthFirst {
 public:
  explicit DepthFirst(Frontier<L>& frontier) noexcept : at_(frontier), task_(frontier.task), hits_(task_.hits.size()) {}

  void run() noexcept {
    while (at_.open.size != 0 || at_.leaf_pairs.size != 0) {
      if (at_.leaf_pairs.size != 0) {
        if (!at_.visit_leaf_pairs()) return leave_rest();
        if constexpr (several) go_elsewhere();
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
    // Near the end the clock is asked after two, for six may take longer than what is left.
    const std::size_t wanted = task_.spending.nears_end() ? std::min<std::size_t>(at_once, 2) : at_once;
    const std::size_t most = open.size <= Frontier<L>::crowded ? std::min(wanted, allowed) : 1;
    const auto count = static_cast<std::uint32_t>(std::min(open.size, most));
    open.size -= count;
    task_.spending.spend_node_pairs(count * wide_lanes);
    at_.opener.template run<several>(count, open, at_.leaf_pairs);
  }

  /// After a hit, to an open pair that follows no order. Not while crowded: what bounds the room is that then the
  /// newest is opened, always.
  void go_elsewhere() noexcept {
    OpenPairs& open = at_.open;
    if (task_.hits.size() == hits_ || open.size < 2 || open.size > Frontier<L>::crowded) return;
    hits_ = task_.hits.size();
    open.bring_up(elsewhere(hits_, open.size - 1));
  }

  void leave_rest() noexcept {
    if (task_.result.ended == Progressed::spent) at_.leave_newest();
  }

  /// Pairs. Of 1 to 8 these are fastest: more waste less time waiting, and open more for nothing where there is a hit.
  static constexpr std::size_t at_once = several ? 2 : 6;
  static_assert(at_once <= Opener<L>::most);

  Frontier<L>& at_;
  Task& task_;
  std::size_t hits_;
};

}  // namespace odds::query::wide
