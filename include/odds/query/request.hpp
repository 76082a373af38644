// What a query is asked.
#pragma once

#include <cstdint>

#include "odds/query/budget.hpp"

namespace odds::query {

enum class Method : std::uint8_t {
  /// Depth-first search (Algorithm 4.2), no estimates; obeys the budget too. With the wide engine after a start of up
  /// to 32 pairs, the likeliest first, if one hit is enough.
  exact,
  /// From the bottom slice of the previous run (Li and Chen 98), with the verdicts of exact: for poses that follow each
  /// other. With the wide engine a run that its budget ends is taken up by the next one. With p_min < 1 it is as
  /// time_critical; within budgets of more than 25 us and 500 work units, or none, also from the roots: for some runs
  /// where a budget was too short for it, and as long as that takes less work, as of bodies that hurry.
  incremental,
  /// Likeliest pair first (Algorithm 4.3). With the wide engine only where p_min < 1 or polygons are dropped: else as
  /// exact.
  time_critical,
};

enum class EstimatorKind : std::uint8_t {
  cells,      ///< the book's: well-filled cells, balls into bins (4.15, 4.16)
  kinematic,  ///< integral geometry: area densities and normal moments
};

/// One question to a Pair. Defaults ask for a proof without a limit and for one contact.
struct Request {
  Method method = Method::time_critical;
  EstimatorKind estimator = EstimatorKind::kinematic;
  Budget budget = {};
  double p_min = 1.0;        ///< in (0, 1]; 1: never stop on probability. A pair of nodes with p >= p_min counts ...
  std::uint32_t k_min = 10;  ///< ... and k_min such pairs end the query with an estimated hit (>= 1)
  /// 0 .. 8. 0: verdict only. 1: one of the first hit that is found, somewhere at the rim of what overlaps: it has a
  /// place and a direction, but hardly a depth. What is to push needs 2 or more: the deepest is then among them.
  int max_contacts = 1;
  /// Contacts that were made with care are carried along with the bodies, instead of being made anew, while nothing
  /// near them has moved farther than this part of the smaller body's size since; a pair of triangles proves the hit.
  /// For bodies at rest about a microsecond instead of 10 to 100. In [0, 1]; 0: always anew. Of queries for more than
  /// one contact.
  double carry_motion = 0.0;
  /// Whether a mesh that lies wholly within a solid (a closed mesh), where no surfaces meet, is hit too, with one
  /// contact that leads out: the way it came in, or else one of the shortest of some ten; no deeper than the last known
  /// depth and the motion since. Of a mesh in several pieces one tells for all. Some 2 us within the solid's bounding
  /// box, 5 to 10 within the solid; where the budget has not so much left, the answer is undecided. Not polygon-free.
  bool solids = false;
  /// Metres, >= 0, finite. Surfaces that touched in the run before and have come apart by no more than this keep a
  /// contact, whose depth is minus the gap, measured anew by two rays along its normal. A solver that lets them come
  /// nearer by the gap in a step, and no faster, does not drop a body for a tick where it has lost a contact by a
  /// nanometre. Of queries that were decided by proof, behind the contacts of surfaces that meet; for what budget is
  /// left. 0: none.
  double margin = 0.0;
  /// Whether contacts (more than one) that a budget has no time for, one of less than 50 us or one that a run of this
  /// pair has seen not to do, are made over the runs that follow, in what is left of their budgets, and carried along
  /// with the bodies: complete, but of a pose some runs ago (Answer::contacts_late). Until the first of them they are
  /// guessed, and no deeper than 1e-4 of the smaller body's size: a guess holds, and hardly pushes. For bodies that
  /// rest or move slowly, in a solver that holds what touches. Flat faces that lie on each other need no such work:
  /// they have their contacts in the same run (Answer::contacts_flush). Without, contacts are made of what the budget
  /// has time for (Answer::contacts_complete): rougher, but with a depth. Of pairs with PairOptions::late_contacts; not
  /// polygon-free.
  bool late_contacts = true;
  /// Whether Cost tells how long a query without a limit of time took. Two readings of the clock are for that alone, 20
  /// to 60 ns together: of bodies that are hardly ever near each other, half of a query. With a limit it always does.
  bool timed = true;
  /// Whether a pair of leaves has its volumes tested before its triangles (Algorithm 4.2 leaves it open). Of the
  /// generic framework only: the wide engine tests the eight leaves of a node at once with their siblings and has
  /// nothing to leave out.
  bool leaf_test = true;
  bool polygon_free = false;  ///< no triangles: a pair of leaves of probability >= 0.5 ends the search (footnote 6)
};

}  // namespace odds::query
