// Partners that our class cannot collide with as they are: said once per class, never silently.
#include <array>
#include <atomic>

#include "ode/geom/colliders.hpp"
#include "ode/geom/partners.hpp"
#include "ode/last_error.hpp"
#include "ode/statistics.hpp"

namespace odds::ode {
namespace {

struct Remedy {
  const char* name;
  const char* text;
};

Remedy remedy_for(dGeomID geom) noexcept {
  const Partner* const partner = partner_table().find(geom);
  const bool known = partner != nullptr && (partner->mesh != nullptr || partner->convex != nullptr);
  switch (dGeomGetClass(geom)) {
    case dConvexClass:
      return {"convex", known ? "it is not the one that was registered; call oddsForgetGeom before dGeomDestroy, and "
                                "oddsRegisterConvex again, also after dGeomSetConvex"
                              : "ODE does not tell its points; call oddsRegisterConvex"};
    case dHeightfieldClass:
      return {"heightfield", known ? "it is not the one that a mesh stands in for; call oddsForgetGeom before "
                                     "dGeomDestroy, and oddsSetStandIn again, also after "
                                     "dGeomHeightfieldSetHeightfieldData"
                                   : "ODE does not tell its heights; call oddsMeshDataBuildHeightfield and "
                                     "oddsSetStandIn"};
    case dTriMeshClass:
      return {"dTriMesh", known ? "it changed since it was read; call oddsPrepareTriMesh again, and oddsForgetGeom "
                                  "before dGeomDestroy"
                                : "it cannot be read, and oddsPrepareTriMesh says why"};
    default:
      return {"other", "use another class"};
  }
}

}  // namespace

int collide_unsupported(dGeomID, dGeomID o2, int, dContactGeom*, int) noexcept {
  static std::array<std::atomic<bool>, dGeomNumClasses> told = {};
  count(statistics().unsupported);
  const int other = dGeomGetClass(o2);
  if (other >= 0 && other < dGeomNumClasses && !told[static_cast<std::size_t>(other)].exchange(true)) {
    const Remedy remedy = remedy_for(o2);
    dMessage(0, "odds: collisions of an odds mesh with this %s geom are not supported: 0 contacts; %s", remedy.name,
             remedy.text);
  }
  return 0;
}

}  // namespace odds::ode
