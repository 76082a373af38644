// Our class against ODE's plane: exact, by the corners below it.
#include <array>
#include <cmath>
#include <span>

#include "ode/collide/contact_writer.hpp"
#include "ode/collide/corners_below.hpp"
#include "ode/collide/limit.hpp"
#include "ode/collide/manifold.hpp"
#include "ode/geom/colliders.hpp"
#include "ode/statistics.hpp"

namespace odds::ode {
namespace {

// Relative to the mesh's size: points this close count as one.
constexpr double same_place = 1e-6;
// What it takes to choose eight contacts.
constexpr double choosing_us = 1.5;

}  // namespace

int collide_plane(dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts, int skip) noexcept {
  count(statistics().primitive_queries);
  GeomData& data = own_data(o1);
  const std::optional<math::Pose> pose = world_pose(o1);
  dVector4 plane;
  dGeomPlaneGetParams(o2, plane);
  const Vec3 normal(plane[0], plane[1], plane[2]);
  if (!pose || !normal.allFinite()) {
    count(statistics().bad_poses);
    return 0;
  }
  Limit limit(data, dPlaneClass, choosing_us);
  const Vec3 local_normal = pose->rotation.transpose() * normal;
  const bool remembers = data.settings.carry_motion > 0.0;
  std::array<std::uint32_t, LastPlaces::most> met;
  const std::size_t met_count = remembers ? data.met.of(o2, met) : 0;
  const CornersBelow below(*data.mesh, local_normal, plane[3] - normal.dot(pose->translation),
                           {std::span(met).first(met_count), remembers ? data.met.turn(o2) : 0}, limit);
  std::array<std::uint32_t, most_contacts> chosen;
  const int room = room_for(flags, data.settings.max_contacts);
  const std::size_t found =
      select_manifold(below, local_normal, same_place * data.mesh->mesh().size(),
                      std::span(chosen).first(static_cast<std::size_t>(room)), [&] { return !limit.is_over(); });
  if (remembers && found > 0) data.met.note(o2, std::span(chosen).first(found));
  ContactWriter writer(o1, o2, room, contacts, skip);
  for (std::size_t i = 0; i < found; ++i) {
    writer.add(*pose * (below.position(chosen[i]) + data.mesh->wide_tree->origin()), normal, below.depth(chosen[i]),
               query::CornerSearch::triangle_of(chosen[i]), query::no_feature);
  }
  return limit.finish(below.is_complete(), writer.count());
}

}  // namespace odds::ode
