// What a query returns.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

#include "odds/math/types.hpp"

namespace odds::query {

enum class Verdict : std::uint8_t {
  clear,  ///< no collision, or that is the likelier of the two
  hit,    ///< collision, or that is the likelier of the two
};

enum class Basis : std::uint8_t {
  /// An intersecting pair of triangles was found (hit), or every pair was excluded (clear). Where Request::solids asks
  /// for it, also: every pair was excluded, and rays tell that one mesh lies within the other (hit), or neither
  /// (clear).
  proved,
  estimated,  ///< the probability passed the threshold that the caller set (p_min, k_min), or polygons were dropped
  budget,     ///< the budget ran out; the verdict is the likelier one
};

/// The words that stand in every table: "clear", "hit".
[[nodiscard]] constexpr std::string_view name(Verdict verdict) noexcept {
  return verdict == Verdict::hit ? "hit" : "clear";
}

/// "proved", "estimated", "budget".
[[nodiscard]] constexpr std::string_view name(Basis basis) noexcept {
  switch (basis) {
    case Basis::proved:
      return "proved";
    case Basis::estimated:
      return "estimated";
    case Basis::budget:
      break;
  }
  return "budget";
}

constexpr std::uint32_t no_feature = std::numeric_limits<std::uint32_t>::max();

/// One point of contact. Frames: A's mesh frame in an Answer; world where a name says so.
struct Contact {
  Vec3 position = Vec3::Zero();  ///< metres
  Vec3 normal = Vec3::UnitZ();   ///< unit; points into A: moving A along it by `depth` ends this contact (ODE's rule)
  /// Metres, >= 0; of surfaces that have come apart (Request::margin) minus the gap. Of a query for one contact it is
  /// that of one pair of triangles along their own direction, while the normal is that of the surfaces about them.
  double depth = 0.0;
  std::uint32_t triangle_a = no_feature;  ///< index into A's mesh, or no_feature where the contact is an estimate
  std::uint32_t triangle_b = no_feature;  ///< index into B's mesh, or no_feature
};

/// What the query spent. Times in microseconds by the budget's clock; 0 where it was not asked for (Request::timed).
struct Cost {
  std::uint64_t node_pairs = 0;      ///< pairs of bounding volumes tested
  std::uint64_t triangle_pairs = 0;  ///< pairs of triangles tested exactly, or found certain to meet; of the wide
                                     ///< engine also each triangle near the box of another leaf
  std::uint64_t queue_full = 0;      ///< pairs that found the queue full and were searched at once instead
  double gross_us = 0.0;             ///< from call to return
  double stall_us = 0.0;             ///< gaps between two clock polls too long to be the query's own work (pre-emption)
  double overshoot_us = 0.0;         ///< gross time beyond the budget, >= 0
  double net_overshoot_us = 0.0;     ///< the same without the stalls, >= 0
  std::uint32_t longest_unpolled_units = 0;  ///< most work units done between two polls of the clock
  [[nodiscard]] double net_us() const noexcept { return gross_us - stall_us; }
};

/// The answer of one query. Always complete: whatever the budget, verdict, basis and probability are set.
struct Answer {
  Verdict verdict = Verdict::clear;
  Basis basis = Basis::proved;
  double probability = 0.0;           ///< of a hit, in [0, 1]; exactly 1 or 0 where proved
  std::span<const Contact> contacts;  ///< in A's mesh frame, best first; valid until the pair's next run
  /// False if the time ended before the contacts were made with care: they come from some of the pairs of triangles
  /// that meet, have one direction, and a depth that is bounded by what earlier runs proved, not measured. It is about
  /// time only: where more pairs meet than are kept (PairOptions::hit_capacity), it stays true for contacts of a sample
  /// of that many, whose directions may differ from those of the whole rim where bodies are curved or serrated;
  /// Pair::crossings() is then as long as hit_capacity. Their depths are at most twice what earlier runs at nearby
  /// poses say; runs at one pose come to what they find there.
  bool contacts_complete = true;
  /// Pairs of triangles that the contacts were made from. Where they are not complete, some twenty tell a direction; of
  /// fewer than that it is a guess, and a caller that has good contacts of the last tick may prefer those. 0 for the
  /// way out of a solid (Request::solids).
  std::uint32_t contact_pairs = 0;
  bool contacts_carried = false;  ///< they are those of an earlier run, moved along (Request::carry_motion)
  /// They were made with care, but for a pose some runs ago, for a short budget had no time for them at once; moved
  /// along with the bodies since (Request::late_contacts). First come those where the bodies are deepest, though what
  /// came in while nobody knew is given its depth gently: another may be given more. Then contacts_complete is false.
  bool contacts_late = false;
  /// They are of flat faces that lie on each other, as polygons, at the pose of this run (Request::late_contacts).
  /// Where contacts_complete is false, it had no time for a patch: all that is known of, but something else may touch.
  bool contacts_flush = false;
  bool has_cell_pair = false;  ///< whether `cell_pair` is set: some pair of nodes remained undecided
  Contact cell_pair;           ///< where the surfaces most probably meet: of patches of surface, not of triangles
  double cell_pair_probability = 0.0;  ///< of an intersection within that pair of nodes
  Cost cost;
};

}  // namespace odds::query
