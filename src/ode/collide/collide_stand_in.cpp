// Our class against a dTriMesh or heightfield: as against our own class, with the mesh that stands in for the geom.
#include "ode/geom/colliders.hpp"
#include "ode/geom/partners.hpp"

namespace odds::ode {

int collide_stand_in(dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts, int skip) noexcept {
  if (mesh_of_partner(o2, own_data(o1).mesh->shape->volume()) == nullptr) {
    return collide_unsupported(o1, o2, flags, contacts, skip);
  }
  return collide_mesh(o1, o2, flags, contacts, skip);
}

}  // namespace odds::ode
