// Our class against ODE's ray: the crossings, nearest first, by the ray's own options.
#include <algorithm>
#include <cmath>

#include "ode/collide/contact_writer.hpp"
#include "ode/collide/limit.hpp"
#include "ode/collide/manifold.hpp"
#include "ode/geom/colliders.hpp"
#include "ode/geom/geom_data.hpp"
#include "ode/mesh/triangle_corners.hpp"
#include "ode/statistics.hpp"
#include "query/ray/crossings.hpp"

namespace odds::ode {
namespace {

// Out of the surface; against the ray where nobody knows.
Vec3 outward(const Corners& triangle, const Vec3& direction) noexcept {
  const Vec3 normal = unit_normal(triangle);
  return normal == Vec3::Zero() ? Vec3(-direction) : normal;
}

}  // namespace

int collide_ray(dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts, int skip) noexcept {
  count(statistics().primitive_queries);
  GeomData& data = own_data(o1);
  const PreparedMesh& mesh = *data.mesh;
  const std::optional<math::Pose> pose = world_pose(o1);
  dVector3 start;
  dVector3 along;
  dGeomRayGet(o2, start, along);
  const Vec3 origin(start[0], start[1], start[2]);
  const Vec3 direction(along[0], along[1], along[2]);
  const double length = dGeomRayGetLength(o2);
  if (!pose || !is_position(origin) || !(std::abs(direction.squaredNorm() - 1.0) < 1e-3) || !(length >= 0.0)) {
    count(statistics().bad_poses);
    return 0;
  }
  Limit limit(data, dRayClass);
  const bool only_one = dGeomRayGetClosestHit(o2) != 0 || dGeomRayGetFirstContact(o2) != 0;
  const Vec3 local_origin = pose->inverse() * origin;
  const Vec3 local_direction = (pose->rotation.transpose() * direction).normalized();
  query::Crossings crossings(mesh.mesh(), *mesh.wide_tree, local_origin, local_direction, length,
                             dGeomRayGetBackfaceCull(o2) != 0);
  const bool limited = data.settings.max_contacts < static_cast<int>(most_contacts);
  const int most = only_one ? std::min(1, data.settings.max_contacts) : (limited ? data.settings.max_contacts : 0xffff);
  ContactWriter writer(o1, o2, room_for(flags, most), contacts, skip);
  bool cut_off = false;
  while (!writer.full() && !cut_off) {
    query::RayEffort effort;
    const auto hit = crossings.next({limit.nodes_in_time(1.0), limit.up()}, effort);
    limit.spend(effort.nodes);
    cut_off = !effort.finished || limit.time_is_up();
    if (!hit) break;
    // ODE's rule for rays: the depth is the distance; the normal is the face's, out of the mesh for g1 = ray.
    writer.add(*pose * (local_origin + hit->distance * local_direction),
               -(pose->rotation * outward(mesh.corners(hit->triangle), local_direction)), hit->distance, hit->triangle,
               query::no_feature);
  }
  return limit.finish(!cut_off, writer.count());
}

}  // namespace odds::ode
