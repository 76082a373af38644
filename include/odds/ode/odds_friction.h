/* Friction that holds places. Beside odds_ode.h, whose general rules hold; for contacts of any two geoms of ODE. */
#ifndef ODDS_FRICTION_H
#define ODDS_FRICTION_H

#include <ode/ode.h>

#include "odds/ode/odds_ode.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What bodies that touch have slid since they came to rest against each other, pair by pair.
 *
 * ODE's friction holds speeds, not places: whatever speed its solver leaves at a contact, some nanometres a step, is
 * never taken back, so that stacks creep by millimetres in ten minutes and bodies crawl down a slope on which they
 * should rest. Friction anchors ask the solver to take it back. Contacts then hold like bristles that give by up to
 * `most_slip` before the bodies slide (Haessig and Friedland 1991). Sliding, rolling and conveyors, straight or turning
 * (dContactMotion1 and 2 of your own), are as without; so is an axis with a slip of its own (dContactSlip1 and 2). No
 * contact gets more force than its mu allows. */
typedef struct oddsFrictionAnchors* oddsFrictionAnchorsID;

/* Takes memory for at most `most_pairs` pairs of geoms that touch in a step (1 .. 1048576; 1.5 to 3 KB each).
 * `most_slip`: metres, > 0, finite. A ten-thousandth of a body's size will do, 1e-5 for bricks of 0.1 m; bodies that
 * give by more swing back as on springs. Null with an error otherwise. Any number may be alive; at most one thread at a
 * time may use one. */
oddsFrictionAnchorsID oddsFrictionAnchorsCreate(int most_pairs, dReal most_slip) ODDS_NOTHROW;
/* Null is allowed. */
void oddsFrictionAnchorsDestroy(oddsFrictionAnchorsID anchors) ODDS_NOTHROW;

/* Once before the collisions of every step: bodies that have not touched in the last 16 steps begin anew. Without it
 * nothing is held. */
void oddsFrictionAnchorsNextStep(oddsFrictionAnchorsID anchors) ODDS_NOTHROW;

/* For the near callback, after dCollide and after the surfaces are set, before dJointCreateContact; with all contacts
 * of a pair of geoms in one call, once in a step. Adds to motion1 and motion2 of each what takes back a fifth of what
 * the bodies have slid there. `b1` and `b2` are what you give to dJointAttach, in its order. 1: done, or there is
 * nothing to hold: no contacts, or both bodies null. 0, with an error and nothing changed: there is no room for one
 * more pair, a pointer is null, the step is not > 0, it is one body twice, the contacts are of several pairs, or
 * something is not finite, or a normal zero. No allocation, no lock, no system call. */
int oddsFrictionAnchorsHold(oddsFrictionAnchorsID anchors, dBodyID b1, dBodyID b2, dContact* contacts, int count,
                            dReal step_s) ODDS_NOTHROW;

#ifdef __cplusplus
}
#endif

#endif
