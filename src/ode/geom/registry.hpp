// The one geom class in ODE's registry, and which function collides it with which other class.
#pragma once

#include <ode/ode.h>

namespace odds::ode {

/// The collider for our class against class `other`; null for classes that are not ours and not ODE's own, so that the
/// owner of such a class is asked instead.
[[nodiscard]] dColliderFn* collider_for(int other) noexcept;

/// After a program closed ODE more often than it initialised it, and initialised it again, ODE has forgotten our class
/// and our table, and nobody holds it for us: takes hold of it and registers anew. Does nothing else. Precondition: ODE
/// is initialised. False if ODE refuses.
[[nodiscard]] bool hold_again() noexcept;

}  // namespace odds::ode
