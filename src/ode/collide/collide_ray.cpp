// Our class against ODE's ray: the crossings, nearest first, by the ray's own options.
#include <algorithm>
#include <cmath>
#include <limits>

#include "odds/math/orient2d.hpp"
#include "ode/collide/contact_writer.hpp"
#include "ode/collide/limit.hpp"
#include "ode/collide/manifold.hpp"
#include "ode/geom/colliders.hpp"
#include "ode/geom/geom_data.hpp"
#include "ode/mesh/triangle_corners.hpp"
#include "ode/statistics.hpp"

namespace odds::ode {
namespace {

// Crossings nearer to each other than this part of the distance are one: the neighbours of a common edge both meet it.
constexpr double same_crossing = 1e-10;
constexpr double nothing = -std::numeric_limits<double>::infinity();

struct Ray {  // mesh frame
  Ray(const Vec3& from, const Vec3& along, double reach, bool fronts) noexcept
      : origin(from), direction(along), length(reach), front_only(fronts) {
    Eigen::Index longest = 0;
    direction.cwiseAbs().maxCoeff(&longest);
    z = static_cast<int>(longest);
    x = (z + 1) % 3;
    y = (z + 2) % 3;
  }

  Vec3 origin;
  Vec3 direction;  // unit
  double length;
  bool front_only;
  int x;  // z: the axis along which the ray is longest; x, y: the other two, in cyclic order
  int y;
  int z;
};

// A corner as the ray sees it: the ray goes through the origin. A function of the corner alone, so that all triangles
// that share it agree where it is (Woop, Benthin and Wald 2013), and signs are exact: no ray slips through an edge or
// a corner.
struct Seen {
  Seen(const Vec3& corner, const Ray& ray) noexcept {
    const Vec3 offset = corner - ray.origin;
    ahead = offset[ray.z] / ray.direction[ray.z];
    place = {offset[ray.x] - ahead * ray.direction[ray.x], offset[ray.y] - ahead * ray.direction[ray.y]};
  }
  Eigen::Vector2d place;
  double ahead;  // along the ray
};

// The distance along the ray at which it crosses the triangle, or -1. Borders belong to the triangle.
double crossing(const Corners& triangle, const Ray& ray) noexcept {
  const Seen a(triangle[0], ray);
  const Seen b(triangle[1], ray);
  const Seen c(triangle[2], ray);
  const auto turn = [](const Seen& p, const Seen& q) {
    return math::orient2d(0.0, 0.0, p.place.x(), p.place.y(), q.place.x(), q.place.y());
  };
  const int ab = turn(a, b);
  const int bc = turn(b, c);
  const int ca = turn(c, a);
  const bool left = ab >= 0 && bc >= 0 && ca >= 0;
  const bool right = ab <= 0 && bc <= 0 && ca <= 0;
  if (left == right) return -1.0;  // outside, or seen edge-on: then its neighbours are met
  const bool from_behind = left == (ray.direction[ray.z] > 0.0);
  if (from_behind && ray.front_only) return -1.0;
  const auto area = [](const Seen& p, const Seen& q) { return p.place.x() * q.place.y() - p.place.y() * q.place.x(); };
  const double wa = area(b, c);
  const double wb = area(c, a);
  const double wc = area(a, b);
  const double sum = wa + wb + wc;
  const auto [nearest, farthest] = std::minmax({a.ahead, b.ahead, c.ahead});
  if (!(std::abs(sum) > 0.0)) return nearest;  // a sliver
  return std::clamp((wa * a.ahead + wb * b.ahead + wc * c.ahead) / sum, nearest, farthest);
}

// The same; one without an area, which has no normal, counts as a little farther: wherever rounding does not part the
// neighbours whose gap it closes, one of them is met first.
double distance_to(const Corners& triangle, const Ray& ray) noexcept {
  const double distance = crossing(triangle, ray);
  const bool no_area = distance > 0.0 && unit_normal(triangle) == Vec3::Zero();
  return no_area ? distance * (1.0 + 0.1 * same_crossing) : distance;
}

// Out of the surface; against the ray where nobody knows.
Vec3 outward(const Corners& triangle, const Ray& ray) noexcept {
  const Vec3 normal = unit_normal(triangle);
  return normal == Vec3::Zero() ? Vec3(-ray.direction) : normal;
}

// Where the ray enters a box, or -infinity if it misses it within (`after`, length].
double entry_bound(const Vec3& center, const Vec3& half, const Ray& ray, double after) noexcept {
  double enter = 0.0;
  double leave = ray.length;
  for (int axis = 0; axis < 3; ++axis) {
    const double middle = center[axis] - ray.origin[axis];
    // Widened by some roundings: a triangle may lie in the face of its box.
    const double reach = half[axis] + 1e-14 * (std::abs(center[axis]) + std::abs(ray.origin[axis]));
    const double speed = ray.direction[axis];
    if (std::abs(speed) < 1e-300) {
      if (std::abs(middle) > reach) return nothing;
      continue;
    }
    const double one = (middle - reach) / speed;
    const double other = (middle + reach) / speed;
    enter = std::fmax(enter, std::fmin(one, other) * (1.0 - 1e-12));
    leave = std::fmin(leave, std::fmax(one, other) * (1.0 + 1e-12));
  }
  return enter <= leave && leave > after ? -enter : nothing;
}

}  // namespace

int collide_ray(dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts, int skip) noexcept {
  count(statistics().primitive_queries);
  const GeomData& data = own_data(o1);
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
  Limit limit(data.settings);
  const bool only_one = dGeomRayGetClosestHit(o2) != 0 || dGeomRayGetFirstContact(o2) != 0;
  const Ray ray(pose->inverse() * origin, (pose->rotation.transpose() * direction).normalized(), length,
                dGeomRayGetBackfaceCull(o2) != 0);
  const bool limited = data.settings.max_contacts < static_cast<int>(most_contacts);
  const int most = only_one ? std::min(1, data.settings.max_contacts) : (limited ? data.settings.max_contacts : 0xffff);
  ContactWriter writer(o1, o2, room_for(flags, most), contacts, skip);
  double after = -1.0;
  bool cut_off = false;
  while (!writer.full() && !cut_off) {
    const std::uint32_t triangle = mesh.triangle_tree.greatest(
        [&](std::uint32_t t) {
          const double distance = distance_to(mesh.corners(t), ray);
          return distance >= 0.0 && distance > after && distance <= ray.length ? -distance : nothing;
        },
        [&](const Vec3& center, const Vec3& half) { return entry_bound(center, half, ray, after); }, limit.units);
    cut_off = limit.units == 0 || limit.time_is_up();
    if (triangle == no_item) break;
    const double distance = distance_to(mesh.corners(triangle), ray);
    // ODE's rule for rays: the depth is the distance; the normal is the face's, out of the mesh for g1 = ray.
    writer.add(*pose * (ray.origin + distance * ray.direction),
               -(pose->rotation * outward(mesh.corners(triangle), ray)), distance, triangle, query::no_feature);
    after = distance * (1.0 + same_crossing) + 1e-300;
  }
  return limit.finish(!cut_off, writer.count());
}

}  // namespace odds::ode
