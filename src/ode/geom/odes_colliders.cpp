// Weak references: a program links and runs whether ODE shows these functions or not.
#include "ode/geom/odes_colliders.hpp"

#include <algorithm>

// The names and types of ODE 0.16's internals, written down from the symbols of its library.
[[gnu::weak]] int dCollideTTL(dxGeom*, dxGeom*, int, dContactGeom*, int);
[[gnu::weak]] int dCollideSTL(dxGeom*, dxGeom*, int, dContactGeom*, int);
[[gnu::weak]] int dCollideBTL(dxGeom*, dxGeom*, int, dContactGeom*, int);
[[gnu::weak]] int dCollideRTL(dxGeom*, dxGeom*, int, dContactGeom*, int);
[[gnu::weak]] int dCollideCCTL(dxGeom*, dxGeom*, int, dContactGeom*, int);
[[gnu::weak]] int dCollideTrimeshPlane(dxGeom*, dxGeom*, int, dContactGeom*, int);
[[gnu::weak]] int dCollideCylinderTrimesh(dxGeom*, dxGeom*, int, dContactGeom*, int);
[[gnu::weak]] int dCollideConvexTrimesh(dxGeom*, dxGeom*, int, dContactGeom*, int);

namespace odds::ode {
namespace {

struct OdesCollider {
  dColliderFn* function = nullptr;
  bool trimesh_first = true;  // else it expects the dTriMesh as its second geom
};

OdesCollider odes_collider(int other) noexcept {
  switch (other) {
    case dTriMeshClass:
      return {&dCollideTTL, true};
    case dSphereClass:
      return {&dCollideSTL, true};
    case dBoxClass:
      return {&dCollideBTL, true};
    case dRayClass:
      return {&dCollideRTL, true};
    case dCapsuleClass:
      return {&dCollideCCTL, true};
    case dPlaneClass:
      return {&dCollideTrimeshPlane, true};
    case dCylinderClass:
      return {&dCollideCylinderTrimesh, false};
    case dConvexClass:
      return {&dCollideConvexTrimesh, false};
    default:
      return {};
  }
}

}  // namespace

bool has_odes_collider(int other) noexcept { return odes_collider(other).function != nullptr; }

int collide_by_ode(dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts, int skip) noexcept {
  const OdesCollider own = odes_collider(dGeomGetClass(o2));
  if (own.function == nullptr) return 0;
  if (own.trimesh_first) return own.function(o1, o2, flags, contacts, skip);
  const int count = own.function(o2, o1, flags, contacts, skip);
  char* bytes = reinterpret_cast<char*>(contacts);
  for (int i = 0; i < count; ++i, bytes += skip) {
    auto* contact = reinterpret_cast<dContactGeom*>(bytes);
    for (int axis = 0; axis < 3; ++axis) contact->normal[axis] = -contact->normal[axis];
    std::swap(contact->g1, contact->g2);
    std::swap(contact->side1, contact->side2);
  }
  return count;
}

void restore_odes_collider(int other) noexcept {
  const OdesCollider own = odes_collider(other);
  const int first = own.trimesh_first ? dTriMeshClass : other;
  const int second = own.trimesh_first ? other : dTriMeshClass;
  dSetColliderOverride(first, second, own.function);
}

}  // namespace odds::ode
