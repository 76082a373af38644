// One run's part of a search from the roots that goes on over several.
#pragma once

#include <algorithm>
#include <cstddef>

#include "query/wide/frontier.hpp"

namespace odds::query::wide {

/// See Sweep. Only of searches for several contacts: others have a witness, or want a proof.
template <class L>
class Instalment {
 public:
  explicit Instalment(Frontier<L>& frontier) noexcept : at_(frontier), task_(frontier.task), sweep_(*task_.sweep) {
    sweep_.looked_at.forget();
    at_.looked_at = &sweep_.looked_at;
  }

  /// Puts what the last search left open in place of what the frontier starts with. False: it has left nothing.
  bool resume() noexcept {
    if (sweep_.open_count + sweep_.leaf_pair_count == 0) return false;
    at_.open.size = sweep_.open_count;
    for (std::size_t i = 0; i < sweep_.open_count; ++i) {
      at_.open.opened[i] = sweep_.open[i].opened;
      at_.open.other[i] = sweep_.open[i].other;
    }
    at_.leaf_pairs.size = sweep_.leaf_pair_count;
    for (std::size_t i = 0; i < sweep_.leaf_pair_count; ++i) {
      at_.leaf_pairs.of[0][i] = sweep_.leaf_pairs[i].a;
      at_.leaf_pairs.of[1][i] = sweep_.leaf_pairs[i].b;
    }
    return true;
  }

  /// Looks at some of what met in the last searches, at others in the next. False: the search has ended.
  bool look_at_met() noexcept {
    const Sweep::MetLeaves before = sweep_.met;
    sweep_.met.forget();
    std::size_t looks = 0;
    for (const TwoLeafSlots& pair : before.pairs()) {
      if (looks++ == most_looks || !look_at(pair)) break;
    }
    const Sweep::MetLeaves still = sweep_.met;
    sweep_.met.forget();
    for (const TwoLeafSlots& pair : before.pairs()) {
      if (!sweep_.looked_at.has(pair)) sweep_.met.note(pair);
    }
    for (const TwoLeafSlots& pair : still.pairs()) sweep_.met.note(pair);
    return task_.result.ended == Progressed::finished;
  }

  /// At the end of a search that began at the roots and with nothing else: `before` is what met in the last ones. If
  /// it has found nothing, others are made in instalments.
  void judge_search_from_roots(const Sweep::MetLeaves& before) noexcept {
    if (task_.result.ended != Progressed::spent || !task_.hits.empty()) return;
    sweep_.met = before;
    sweep_.runs_left = Sweep::a_while;
    keep();
  }

  /// Leaves what is open for the next search; of too much the newest, which lie deepest.
  void keep() noexcept {
    sweep_.open_count = std::min(at_.open.size, Sweep::most_open);
    const std::size_t first = at_.open.size - sweep_.open_count;
    for (std::size_t i = 0; i < sweep_.open_count; ++i) {
      sweep_.open[i] = {at_.open.opened[first + i], at_.open.other[first + i]};
    }
    sweep_.leaf_pair_count = at_.leaf_pairs.size;
    for (std::size_t i = 0; i < sweep_.leaf_pair_count; ++i) {
      sweep_.leaf_pairs[i] = {at_.leaf_pairs.of[0][i], at_.leaf_pairs.of[1][i]};
    }
  }

 private:
  /// Pairs of leaves in a run: the rest of its time is for what has begun to meet.
  static constexpr std::size_t most_looks = 4;
  /// Of one pair of leaves: more of the same place say little.
  static constexpr std::uint32_t most_hits = 1;
  static_assert(Sweep::most_open <= Frontier<L>::crowded);
  static_assert(Sweep::most_leaf_pairs == Frontier<L>::most_leaf_pairs);

  /// False: the search has ended.
  bool look_at(const TwoLeafSlots& pair) noexcept {
    if (!at_.may_open()) {
      task_.result.ended = Progressed::spent;
      return false;
    }
    sweep_.looked_at.note(pair);
    const std::uint32_t wanted = task_.wanted;
    task_.wanted = std::min(wanted, static_cast<std::uint32_t>(task_.hits.size()) + most_hits);
    const bool was_empty = task_.hits.empty();
    const bool goes_on = visit_leaves<L>(task_, pair.a, pair.b);
    task_.wanted = wanted;
    // The leaves were looked at for one hit, of which no contacts are made.
    if (was_empty && !task_.hits.empty() && wanted > 1) task_.spending.keep_time_for_contacts();
    if (goes_on) return true;
    if (task_.result.ended == Progressed::spent || task_.hits.full(wanted)) return false;
    task_.result.ended = Progressed::finished;
    return true;
  }

  Frontier<L>& at_;
  Task& task_;
  Sweep& sweep_;
};

}  // namespace odds::query::wide
