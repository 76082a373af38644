// The first collisions of a process, made before the program's own.
#pragma once

#include "odds/ode/odds_ode.h"

namespace odds::preload {

/// Collides small meshes with what is taken over, so that the program's first collision finds its code in the
/// processor's reach and not a budget later. Counts nothing. ODE must be initialised, the takeover on; not while
/// another thread collides. Takes some milliseconds, and memory that it gives back.
void warm_up(const oddsTakeOverParams& takeover) noexcept;

}  // namespace odds::preload
