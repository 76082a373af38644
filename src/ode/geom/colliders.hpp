// The collider functions that ODE's table points at. Each obeys ODE's contract: o1 is of our class, contacts have g1 =
// o1, normals point into o1, `skip` is a byte stride, the low 16 bits of `flags` are the most contacts.
#pragma once

#include <ode/ode.h>

namespace odds::ode {

int collide_mesh(dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts, int skip) noexcept;
int collide_plane(dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts, int skip) noexcept;
int collide_sphere(dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts, int skip) noexcept;
int collide_box(dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts, int skip) noexcept;
int collide_capsule(dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts, int skip) noexcept;
int collide_cylinder(dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts, int skip) noexcept;
int collide_ray(dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts, int skip) noexcept;
int collide_convex(dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts, int skip) noexcept;
int collide_stand_in(dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts, int skip) noexcept;
/// 0 contacts; says so once per class through ODE's message handler, and counts.
int collide_unsupported(dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts, int skip) noexcept;

}  // namespace odds::ode
