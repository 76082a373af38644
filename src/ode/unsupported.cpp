// Partners that our class does not collide with: said once per class, never silently.
#include <array>
#include <atomic>

#include "ode/colliders.hpp"
#include "ode/statistics.hpp"

namespace odds::ode {
namespace {

const char* class_name(int number) noexcept {
  switch (number) {
    case dCapsuleClass:
      return "capsule";
    case dCylinderClass:
      return "cylinder";
    case dRayClass:
      return "ray";
    case dConvexClass:
      return "convex";
    case dTriMeshClass:
      return "dTriMesh";
    case dHeightfieldClass:
      return "heightfield";
    default:
      return "other";
  }
}

}  // namespace

int collide_unsupported(dGeomID, dGeomID o2, int, dContactGeom*, int) noexcept {
  static std::array<std::atomic<bool>, dGeomNumClasses> told = {};
  count(statistics().unsupported);
  const int other = dGeomGetClass(o2);
  if (other >= 0 && other < dGeomNumClasses && !told[static_cast<std::size_t>(other)].exchange(true)) {
    dMessage(0,
             "odds: collisions of an odds mesh with a %s geom are not supported: 0 contacts; use a mesh, plane, sphere "
             "or box",
             class_name(other));
  }
  return 0;
}

}  // namespace odds::ode
