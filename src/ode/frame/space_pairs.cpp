// A space inside of another meets many things there, but is searched from its own owner.
#include "ode/frame/space_pairs.hpp"

namespace odds::ode {
namespace {

struct Caller {
  void* data;
  dNearCallback* callback;
};

void open_spaces(void* caller, dGeomID a, dGeomID b) noexcept {
  if (dGeomIsSpace(a) != 0 || dGeomIsSpace(b) != 0) {
    dSpaceCollide2(a, b, caller, &open_spaces);
    return;
  }
  const auto& to = *static_cast<const Caller*>(caller);
  to.callback(to.data, a, b);
}

}  // namespace

void for_each_pair(dSpaceID space, void* data, dNearCallback* callback) noexcept {
  Caller caller{data, callback};
  dSpaceCollide(space, &caller, &open_spaces);
  if (dSpaceGetClass(space) == dQuadTreeSpaceClass) return;  // ODE aborts where one asks for its members
  const int members = dSpaceGetNumGeoms(space);
  for (int i = 0; i < members; ++i) {
    const dGeomID member = dSpaceGetGeom(space, i);
    if (dGeomIsSpace(member) == 0 || dGeomIsEnabled(member) == 0) continue;
    for_each_pair(reinterpret_cast<dSpaceID>(member), data, callback);
  }
}

}  // namespace odds::ode
