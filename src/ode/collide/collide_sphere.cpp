// Our class against ODE's sphere: the places of the surface that are locally nearest to the centre.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "ode/collide/contact_writer.hpp"
#include "ode/collide/limit.hpp"
#include "ode/collide/nearest_in_time.hpp"
#include "ode/geom/colliders.hpp"
#include "ode/mesh/triangle_corners.hpp"
#include "ode/statistics.hpp"
#include "query/shape/near_segment.hpp"

namespace odds::ode {
namespace {

constexpr std::size_t most_near_triangles = 256;
// The share of the time for the deepest place; then others are looked for.
constexpr double time_for_nearest = 0.8;
// Relative to the radius: nearer places are one place. Neighbours share their common edge to rounding only.
constexpr double same_place = 1e-6;

struct Place {
  Vec3 point;
  double distance;
  double extent;  // no point of the triangle is farther from `point`
  std::uint32_t triangle;
};

struct Places {
  std::array<Place, most_near_triangles> all;
  std::size_t count = 0;
  bool complete = true;
};

// Adds the nearest point of the triangle if it is no farther than the radius. False if there is no room or time for it.
bool add_place(const PreparedMesh& mesh, const Vec3& center, double radius, std::uint32_t triangle, const Limit& limit,
               Places& places) noexcept {
  if (limit.time_is_up()) return false;
  const Corners corners = mesh.corners(triangle);
  const Vec3 point = closest_point(corners, center);
  const double distance = (point - center).norm();
  if (distance > radius) return true;
  if (places.count == places.all.size()) return false;
  double square = 0.0;
  for (const Vec3& corner : corners) square = std::max(square, (corner - point).squaredNorm());
  places.all[places.count++] = {point, distance, std::sqrt(square), triangle};
  return true;
}

// The nearest point of every triangle that is no farther than the radius, nearest first; of no use if they are not
// complete.
void find_places(const PreparedMesh& mesh, const Vec3& center, double radius, Limit& limit, Places& places) noexcept {
  const auto add = [&](std::uint32_t triangle) { return add_place(mesh, center, radius, triangle, limit, places); };
  const std::uint64_t nodes = limit.nodes_left();
  std::uint64_t left = nodes;
  places.complete = query::NearSegment(mesh.mesh(), *mesh.wide_tree, center, center)
                        .all_within(
                            radius, add, [&] { return !limit.time_is_up(); }, left);
  limit.spend(nodes - left);
  if (!places.complete) return;
  std::sort(places.all.begin(), places.all.begin() + places.count, [](const Place& a, const Place& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.triangle < b.triangle;
  });
}

// A place on an edge or corner is no local minimum of the distance if another triangle that shares it comes closer:
// then it is only the rim of a neighbour, and its normal would be that of an internal edge.
bool is_local_minimum(const PreparedMesh& mesh, const Places& places, std::size_t index, double tolerance) noexcept {
  const Place& place = places.all[index];
  for (std::size_t i = 0; i < index; ++i) {
    const Place& closer = places.all[i];
    const double apart = (closer.point - place.point).norm();
    if (apart <= tolerance) return false;
    if (closer.distance >= place.distance || apart > closer.extent + tolerance) continue;
    if ((closest_point(mesh.corners(closer.triangle), place.point) - place.point).norm() <= tolerance) return false;
  }
  return true;
}

// Across a triangle that is a line, anywhere from a point: a contact without a direction makes ODE's solver abort.
Vec3 away_from_line(const Corners& corners) noexcept {
  Vec3 longest = corners[1] - corners[0];
  for (const Vec3& side : {Vec3(corners[2] - corners[1]), Vec3(corners[0] - corners[2])}) {
    if (side.squaredNorm() > longest.squaredNorm()) longest = side;
  }
  return longest.squaredNorm() > 0.0 ? Vec3(longest.normalized().unitOrthogonal()) : Vec3(Vec3::UnitZ());
}

}  // namespace

int collide_sphere(dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts, int skip) noexcept {
  count(statistics().primitive_queries);
  GeomData& data = own_data(o1);
  const PreparedMesh& mesh = *data.mesh;
  const std::optional<math::Pose> pose = world_pose(o1);
  const dReal* p = dGeomGetPosition(o2);
  const Vec3 world_center(p[0], p[1], p[2]);
  const double radius = dGeomSphereGetRadius(o2);
  if (!pose || !is_position(world_center) || !(radius < dInfinity)) {
    count(statistics().bad_poses);
    return 0;
  }
  Limit limit(data, dSphereClass);
  const Vec3 center = pose->inverse() * world_center;
  const bool may_be_inside = mesh.closed && in_bounds(mesh, center);
  const double reach = may_be_inside ? std::numeric_limits<double>::infinity() : radius;
  bool complete = false;
  const bool remembers = data.settings.carry_motion > 0.0;
  std::array<std::uint32_t, LastPlaces::most> met;
  const std::uint32_t guess = remembers && data.met.of(o2, met) > 0 ? met[0] : query::no_feature;
  const auto nearest =
      nearest_in_time(mesh, center, reach, time_for_nearest, Wanted::something, limit, complete, guess);
  if (remembers && nearest) data.met.note(o2, std::span(&nearest->triangle, 1));

  ContactWriter writer(o1, o2, room_for(flags, data.settings.max_contacts), contacts, skip);
  if (nearest && (nearest->inside || nearest->distance <= radius)) {
    // Towards the mesh seen from outside; from the pseudo-normal where the centre is on the surface itself.
    const bool on_surface = nearest->distance <= same_place * radius;
    const double side = nearest->inside ? -1.0 : 1.0;
    const bool has_side = nearest->outward != Vec3::Zero();
    const Vec3 outward = has_side ? nearest->outward : away_from_line(mesh.corners(nearest->triangle));
    const Vec3 into_mesh = on_surface ? Vec3(-outward)
                           : complete ? Vec3(side / nearest->distance * (nearest->point - center))
                                      : Vec3(-side * way_from_any(nearest->point, nearest->outward, center));
    writer.add(*pose * nearest->point, pose->rotation * into_mesh, radius - side * nearest->distance, nearest->triangle,
               query::no_feature);
    if (!nearest->inside && !on_surface && !writer.full()) {
      Places found;
      find_places(mesh, center, radius, limit, found);
      complete = complete && found.complete;
      // Without depth nothing pushes, and every triangle that is touched is told, as by ODE.
      const bool only_touches = nearest->distance == radius;
      for (std::size_t i = 0; i < found.count && found.complete && !writer.full(); ++i) {
        if (limit.time_is_up()) {  // each of many places is compared with all before it
          complete = false;
          break;
        }
        const Place& place = found.all[i];
        const bool written = only_touches ? place.triangle == nearest->triangle
                                          : (place.point - nearest->point).norm() <= same_place * radius;
        if (written || !(only_touches || is_local_minimum(mesh, found, i, same_place * radius))) continue;
        writer.add(*pose * place.point, pose->rotation * ((place.point - center) / place.distance),
                   radius - place.distance, place.triangle, query::no_feature);
      }
    }
  }
  return limit.finish(complete, writer.count());
}

}  // namespace odds::ode
