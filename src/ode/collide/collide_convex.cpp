// Our class against ODE's convex geoms, which tell nothing about themselves: their arrays must be given once more.
#include <algorithm>
#include <cstdint>
#include <exception>
#include <string_view>
#include <vector>

#include "ode/collide/convex_contacts.hpp"
#include "ode/collide/limit.hpp"
#include "ode/geom/colliders.hpp"
#include "ode/geom/partners.hpp"
#include "ode/last_error.hpp"
#include "ode/statistics.hpp"

namespace odds::ode {
namespace {

// dGeomSetConvex leaves ODE's box around the geom as it was, until the geom moves. So it is moved to where it is; one
// with a body by its body, for a geom's own offset would be added with a rounding.
void renew_bounds(dGeomID geom) noexcept {
  if (const dBodyID body = dGeomGetBody(geom); body != nullptr) {
    const dReal* const at = dBodyGetPosition(body);
    dBodySetPosition(body, at[0], at[1], at[2]);
  } else {
    const dReal* const at = dGeomGetPosition(geom);
    dGeomSetPosition(geom, at[0], at[1], at[2]);
  }
}

}  // namespace

int collide_convex(dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts, int skip) noexcept {
  const std::int64_t begun_ns = Limit::now();  // to ask whether it is unchanged takes time, too
  Partner* const partner = partner_table().find(o2);
  if (partner == nullptr || partner->convex == nullptr) return collide_unsupported(o1, o2, flags, contacts, skip);
  if (!is_unchanged(*partner)) {
    count(statistics().changed_partners);
    return collide_unsupported(o1, o2, flags, contacts, skip);
  }
  return collide_convex_body(o1, o2, *partner->convex, flags, contacts, skip, begun_ns);
}

}  // namespace odds::ode

int oddsRegisterConvex(dGeomID convex, const dReal* points, unsigned point_count, const unsigned* polygons,
                       unsigned polygon_count) noexcept {
  using namespace odds::ode;
  if (oddsGetClass() < 0 || convex == nullptr || dGeomGetClass(convex) != dConvexClass || points == nullptr) {
    set_last_error(
        "oddsRegisterConvex: the library is not initialised, or not a geom made by dCreateConvex, or no points");
    return 0;
  }
  if (point_count > ConvexShape::most_points) {
    set_last_error("oddsRegisterConvex: more than 4096 points; give the arrays of dCreateConvex, or a mesh");
    return 0;
  }
  try {
    std::vector<odds::Vec3> corners(point_count);
    for (odds::Vec3& corner : corners) {
      corner = odds::Vec3(points[0], points[1], points[2]);
      points += 3;
    }
    auto shape = ConvexShape::make(corners, polygons, polygon_count);
    if (!shape.ok()) {
      set_last_error(shape.error());
      return 0;
    }
    auto partner = std::make_unique<Partner>(convex);
    partner->convex = std::move(shape).value();
    if (!is_unchanged(*partner)) renew_bounds(convex);  // else it may be called from a callback
    partner_table().put(std::move(partner));
    return 1;
  } catch (const std::exception& error) {
    set_last_error(std::string_view(error.what()));
  } catch (...) {
    set_last_error("oddsRegisterConvex: unknown failure");
  }
  return 0;
}
