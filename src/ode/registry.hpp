// The one geom class in ODE's registry, and which function collides it with which other class.
#pragma once

#include <ode/ode.h>

namespace odds::ode {

/// The collider for our class against class `other`; null for classes that are not ours and not ODE's own, so that the
/// owner of such a class is asked instead.
[[nodiscard]] dColliderFn* collider_for(int other) noexcept;

}  // namespace odds::ode
