// ODE's own colliders of a dTriMesh, for what a takeover leaves to them.
#pragma once

#include <ode/ode.h>

#include <array>

namespace odds::ode {

/// The classes whose collisions with a dTriMesh can be taken over, in the order of ODDS_TAKE_... bits.
inline constexpr std::array<int, 8> takeover_classes = {dTriMeshClass,  dSphereClass, dBoxClass, dCapsuleClass,
                                                        dCylinderClass, dPlaneClass,  dRayClass, dConvexClass};

/// Whether this build of ODE lets others call its collider of a dTriMesh with that class. (They are not part of its
/// interface, but visible in Debian's library and in static ones.)
[[nodiscard]] bool has_odes_collider(int other) noexcept;

/// That collider, with o1 = the dTriMesh; 0 contacts if it is not there.
int collide_by_ode(dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts, int skip) noexcept;

/// Puts that collider back into ODE's table. Precondition: has_odes_collider(other).
void restore_odes_collider(int other) noexcept;

}  // namespace odds::ode
