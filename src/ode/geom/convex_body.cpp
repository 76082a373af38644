// What convex bodies have in common; Minkowski portal refinement through libccd.
#include "ode/geom/convex_body.hpp"

#include <ccd/ccd.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "query/wide/points_by_eight.hpp"
#include "query/wide/searches.hpp"

namespace odds::ode {
namespace {

// libccd caps only its last phase. Support points beyond these are the centre, which ends every phase at once: no
// direction is found then. A body of many faces needs about ten.
constexpr int most_supports = 48;
constexpr unsigned long most_iterations = 24;
constexpr double refinement_tolerance = 1e-7;  // of the body's size
// A hull of more corners takes longer to search than its direction is worth.
constexpr std::size_t most_hull_corners = 256;

struct Hull {
  const query::wide::PointsByEight<most_hull_corners>& corners;
  Vec3 middle;
  double scale;
};

struct Searched {
  const ConvexBody& body;
  double scale;
  mutable int supports_left = most_supports;
};

// To a size of about 1. libccd takes 2e-16 for nothing, products of three lengths among them: of bodies below a
// millimetre it would find no direction. A power of two, which rounds nothing.
double scale_of(double size) noexcept {
  constexpr int most = 1000;
  int exponent = 0;
  std::frexp(size, &exponent);
  return std::ldexp(1.0, std::clamp(-exponent, -most, most));
}

Vec3 from_ccd(const ccd_vec3_t& v) noexcept { return {v.v[0], v.v[1], v.v[2]}; }
void to_ccd(const Vec3& from, ccd_vec3_t* to) noexcept { ccdVec3Set(to, from.x(), from.y(), from.z()); }

void body_support(const void* self, const ccd_vec3_t* direction, ccd_vec3_t* point) noexcept {
  const auto& searched = *static_cast<const Searched*>(self);
  const bool goes_on = searched.supports_left-- > 0;
  to_ccd(searched.scale * (goes_on ? searched.body.farthest(from_ccd(*direction)) : searched.body.center()), point);
}

void body_center(const void* self, ccd_vec3_t* center) noexcept {
  const auto& searched = *static_cast<const Searched*>(self);
  to_ccd(searched.scale * searched.body.center(), center);
}

void hull_support(const void* self, const ccd_vec3_t* direction, ccd_vec3_t* point) noexcept {
  const auto& hull = *static_cast<const Hull*>(self);
  const query::wide::Searches& kernels = *query::wide::searches_for(query::InstructionSet::best);
  const std::uint32_t best = kernels.outermost_along(hull.corners.all(), from_ccd(*direction), 0.0, 0.0, 1);
  const Vec3 corner = best == query::no_feature ? hull.middle : hull.corners.point(best);
  to_ccd(hull.scale * corner, point);
}

void hull_center(const void* self, ccd_vec3_t* center) noexcept {
  const auto& hull = *static_cast<const Hull*>(self);
  to_ccd(hull.scale * hull.middle, center);
}

}  // namespace

double ConvexBody::way_through(const Vec3& point, const Vec3& direction) const noexcept {
  double way = std::numeric_limits<double>::infinity();
  for (const HalfSpace& side : sides_) {
    const double speed = side.normal.dot(direction);
    if (speed < 1e-12) continue;
    const double room = std::max(0.0, side.offset - side.normal.dot(point));
    if (room < way * speed) way = room / speed;
  }
  return way;
}

void add_refined_exit(const ConvexBody& body, std::span<const Piece* const> patch, ExitList& exits) noexcept {
  query::wide::PointsByEight<most_hull_corners> corners;
  Vec3 sum = Vec3::Zero();
  for (const Piece* piece : patch) {
    if (corners.count() + piece->count > most_hull_corners) return;
    for (const Vec3& corner : std::span(piece->corners).first(piece->count)) {
      sum += corner;
      corners.add(corner, 0.0);
    }
  }
  if (corners.count() == 0) return;
  const double size = body.box_half_extents().norm();
  if (!std::isfinite(size)) return;  // there is no scale: libccd might go round in circles
  const double scale = scale_of(size);
  const Hull hull = {corners, sum / static_cast<double>(corners.count()), scale};
  ccd_t settings;
  CCD_INIT(&settings);
  settings.support1 = &body_support;
  settings.support2 = &hull_support;
  settings.center1 = &body_center;
  settings.center2 = &hull_center;
  settings.max_iterations = most_iterations;
  settings.mpr_tolerance = refinement_tolerance * scale * size;
  double depth = 0.0;
  ccd_vec3_t direction;
  ccd_vec3_t position;
  const Searched searched = {body, scale};
  if (ccdMPRPenetration(&searched, &hull, &settings, &depth, &direction, &position) == 0) {
    exits.add_facing(from_ccd(direction));
  }
}

}  // namespace odds::ode
