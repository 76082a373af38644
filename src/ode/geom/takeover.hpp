// Answering the collisions of ODE's own dTriMesh geoms.
#pragma once

#include <cstdint>

#include "odds/ode/odds_ode.h"

namespace odds::ode {

/// Called after each collision that the takeover saw, from the thread that collided: the class of the partner, the
/// time from start to end in nanoseconds, the contacts given, and whether ODE's own collider made them. It must not
/// allocate, lock, or throw.
using TakeoverObserver = void (*)(int partner_class, std::int64_t ns, int contacts, bool by_ode) noexcept;

/// Null (default): nobody is told, and no clock is read. Set it before the first collision.
void observe_takeover(TakeoverObserver observer) noexcept;

/// Points ODE's table at our colliders if a takeover is on: after every registration of the class.
void install_takeover() noexcept;

}  // namespace odds::ode
