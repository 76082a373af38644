// oddsInitODE and oddsCloseODE: pinning ODE, taking one user class, filling the collider table.
#include "ode/geom/registry.hpp"

#include <array>
#include <atomic>
#include <mutex>

#include "odds/ode/odds_ode.h"
#include "odds/realtime/clock.hpp"
#include "ode/geom/colliders.hpp"
#include "ode/geom/geom_data.hpp"
#include "ode/geom/partners.hpp"
#include "ode/geom/takeover.hpp"
#include "ode/last_error.hpp"

namespace odds::ode {
namespace {

// All built-in classes that a table row may be set for; spaces and dGeomTransform keep ODE's own recursion.
constexpr std::array built_in_classes = {dSphereClass, dBoxClass,    dCapsuleClass, dCylinderClass,   dPlaneClass,
                                         dRayClass,    dConvexClass, dTriMeshClass, dHeightfieldClass};

struct Registry {
  std::mutex mutex;
  int count = 0;
  int class_number = -1;
};

Registry& registry() noexcept {
  static Registry only;
  return only;
}

constinit std::atomic<int> live_class{-1};
constinit std::atomic<bool> marker_called{false};

// ODE has no collider for two rays. Ours answers "none" too, and thereby tells whether ODE still holds the table that
// we filled: a real close and init of ODE (its count reached 0) empties the table and forgets all user classes.
int mark_generation(dGeomID, dGeomID, int, dContactGeom*, int) noexcept {
  marker_called.store(true, std::memory_order_relaxed);
  return 0;
}

bool table_is_ours() noexcept {
  marker_called.store(false, std::memory_order_relaxed);
  const dGeomID a = dCreateRay(nullptr, 1);
  const dGeomID b = dCreateRay(nullptr, 1);
  dContactGeom contact;
  dCollide(a, b, 1, &contact, static_cast<int>(sizeof contact));
  dGeomDestroy(a);
  dGeomDestroy(b);
  return marker_called.load(std::memory_order_relaxed);
}

int register_class() noexcept {
  dGeomClass description = {};
  description.bytes = static_cast<int>(sizeof(GeomData*));
  description.collider = &collider_for;
  description.aabb = &compute_aabb;
  description.aabb_test = nullptr;
  description.dtor = &destroy_data;
  return dCreateGeomClass(&description);
}

// ODE fills its table at the first collision of a pair of classes; two threads would race there. So every row is set
// now.
void fill_table(int class_number) noexcept {
  for (const int other : built_in_classes) dSetColliderOverride(class_number, other, collider_for(other));
  dSetColliderOverride(class_number, class_number, &collide_mesh);
  dSetColliderOverride(dRayClass, dRayClass, &mark_generation);
}

void register_and_fill(Registry& state) noexcept {
  if (state.class_number < 0 || !table_is_ours()) state.class_number = register_class();
  live_class.store(state.class_number, std::memory_order_release);
  fill_table(state.class_number);
  install_takeover();
  static_cast<void>(realtime::fastest_clock());  // calibrates now, not in the first collision
}

}  // namespace

bool hold_again() noexcept {
  try {
    const std::lock_guard lock(registry().mutex);
    Registry& state = registry();
    if (state.count == 0 || table_is_ours()) return true;
    if (dInitODE2(0) == 0) return false;
    register_and_fill(state);
    return true;
  } catch (...) {
    return false;
  }
}

dColliderFn* collider_for(int other) noexcept {
  switch (other) {
    case dPlaneClass:
      return &collide_plane;
    case dSphereClass:
      return &collide_sphere;
    case dBoxClass:
      return &collide_box;
    case dCapsuleClass:
      return &collide_capsule;
    case dCylinderClass:
      return &collide_cylinder;
    case dRayClass:
      return &collide_ray;
    case dConvexClass:
      return &collide_convex;
    case dTriMeshClass:
    case dHeightfieldClass:
      return &collide_stand_in;
    default:
      break;
  }
  if (other == live_class.load(std::memory_order_relaxed)) return &collide_mesh;
  return other < dFirstUserClass ? &collide_unsupported : nullptr;
}

}  // namespace odds::ode

int oddsInitODE(unsigned flags) noexcept {
  using namespace odds::ode;
  try {
    const std::lock_guard lock(registry().mutex);
    if (dInitODE2(flags) == 0) {
      set_last_error("oddsInitODE: dInitODE2 refused; check the flags");
      return 0;
    }
    if (dAllocateODEDataForThread(static_cast<unsigned>(dAllocateMaskAll)) == 0) {
      dCloseODE();
      set_last_error("oddsInitODE: dAllocateODEDataForThread refused; free memory");
      return 0;
    }
    Registry& state = registry();
    if (state.count++ == 0) register_and_fill(state);
    return 1;
  } catch (...) {
    set_last_error("oddsInitODE: the lock of the class registry failed");
    return 0;
  }
}

void oddsCloseODE(void) noexcept {
  using namespace odds::ode;
  try {
    const std::lock_guard lock(registry().mutex);
    Registry& state = registry();
    if (state.count == 0) {
      set_last_error("oddsCloseODE: called more often than oddsInitODE");
      return;
    }
    if (--state.count == 0) {
      partner_table().clear();
      live_class.store(-1, std::memory_order_release);
    }
    dCloseODE();
  } catch (...) {
    set_last_error("oddsCloseODE: the lock of the class registry failed");
  }
}

int oddsGetClass(void) noexcept { return odds::ode::live_class.load(std::memory_order_acquire); }
