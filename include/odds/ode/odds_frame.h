/* One frame's time shared over all pairs of a space, by importance. Beside odds_ode.h, whose general rules hold. */
#ifndef ODDS_FRAME_H
#define ODDS_FRAME_H

#include <ode/ode.h>

#include "odds/ode/odds_ode.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A budget for the collisions of a whole frame, and what it remembers of their pairs from frame to frame. */
typedef struct oddsFrameBudget* oddsFrameBudgetID;

/* Takes memory for frames of at most `most_pairs` pairs (1 .. 1048576). Null with an error otherwise. Any number of
 * budgets may be alive; one thread uses one at a time. */
oddsFrameBudgetID oddsFrameBudgetCreate(int most_pairs) ODDS_NOTHROW;
/* Null is allowed. */
void oddsFrameBudgetDestroy(oddsFrameBudgetID budget) ODDS_NOTHROW;

/* Wall time of a frame's collisions, broad phase and callbacks included, > 0; dInfinity: no limit (default). */
int oddsFrameBudgetSetTime(oddsFrameBudgetID budget, dReal microseconds) ODDS_NOTHROW;

/* Work of a frame's collisions with meshes: pairs of nodes plus pairs of triangles; with primitives, nodes. Same bits
 * on every run if the time is dInfinity, and the geoms' own too. 0: no limit (default). */
int oddsFrameBudgetSetWork(oddsFrameBudgetID budget, unsigned long units) ODDS_NOTHROW;

/* Where somebody looks or feels, world frame; pairs near it count for more, down to a tenth far beyond `radius` metres
 * (> 0). A null position: nowhere (default). */
int oddsFrameBudgetSetAttention(oddsFrameBudgetID budget, const dReal* position, dReal radius) ODDS_NOTHROW;

enum {
  ODDS_SHARE_BY_IMPORTANCE = 0, /* default */
  ODDS_SHARE_EQUALLY = 1        /* every pair as much, in ODE's order, whoever has waited: for comparison only */
};
int oddsFrameBudgetSetSharing(oddsFrameBudgetID budget, int sharing) ODDS_NOTHROW;

/* A frame in so many parts (1 .. 1024; default 1): as many calls of oddsSpaceCollide, each within the whole budget, make
 * one frame. The first finds the pairs; every further one calls those that had no turn yet, each once; what held
 * contacts stand in for those that had none comes with the last. In between, no geom may be destroyed or leave the
 * space, and bodies should stay where they are. The next call begins a frame, also if another was under way. */
int oddsFrameBudgetSetParts(oddsFrameBudgetID budget, int parts) ODDS_NOTHROW;

/* What the last frame did; one in parts, so far: times and work are those of its last part. */
typedef struct oddsFrameSummary {
  int pairs;           /* that the broad phase gave */
  int served;          /* that were given a share */
  int starved;         /* ... of these, with meshes: came to nothing within it; more is tried in the next frame */
  int held;            /* that were given none, but touched: contacts of an earlier frame, where the bodies are now */
  int waiting_longest; /* frames that some pair within `most_pairs` has been without a turn by now; one that starved
                        * had none */
  int beyond_memory;   /* pairs beyond `most_pairs`: called one after the other, through several frames if need be, each
                        * with the least share, in the first half of a frame; without a limit all, in full */
  double gross_us;     /* of the whole frame */
  double overshoot_us; /* beyond the budget, >= 0 */
  unsigned long work;  /* units spent with meshes */
} oddsFrameSummary;
int oddsFrameBudgetGetSummary(oddsFrameBudgetID budget, oddsFrameSummary* summary) ODDS_NOTHROW;

/* dSpaceCollide (data, callback as there) with all pairs of geoms put in order first: the callback, which calls
 * dCollide once for its pair as always, is called for the most important pairs first. Important is what probably
 * touches, touched lately, moves fast against each other, is near to the attention. No pair but the first in line gets
 * less than it needs for an answer of use, which is learned from what its collisions cost: a share that led to none is
 * doubled, up to half of the frame. Where a frame cannot pay the needs of all, pairs take turns, by importance times
 * the square of the frames waited, and among pairs of like need none has its turns more than four times as rarely as
 * another. One that has not its turn is not called. But if two meshes touched, or a mesh and a box, cylinder, capsule
 * or convex, it gets the contacts that were last made of triangles, moved on with the bodies, as far as time allows
 * (none where the policy for undecided queries is no contact); a body may otherwise sink in for some frames. What the
 * needs leave over goes by importance; what a pair does not use, to the others. The share bounds the collision in
 * addition to the geoms' own budgets. One pair at least is called in every frame. Spaces inside of `space` are searched
 * too, each once, and each pair of geoms is called once; not so spaces inside of a quad tree, for ODE does not list
 * what it holds. A pair that the broad phase does not give is forgotten. odds allocates nothing here; ODE's hash and
 * sweep-and-prune spaces do. The last error stays as it is. Returns 1, or 0 with an error, also within the callback of
 * another call. */
int oddsSpaceCollide(dSpaceID space, void* data, dNearCallback* callback, oddsFrameBudgetID budget) ODDS_NOTHROW;

#ifdef __cplusplus
}
#endif
#endif
