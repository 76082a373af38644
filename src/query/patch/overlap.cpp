// Overlap of pairs of triangles along a direction, and of whole meshes along a line.
#include "query/patch/overlap.hpp"

#include <algorithm>
#include <limits>

namespace odds::query::patch {
namespace {

/// One mesh as a probe sees it, in that mesh's own frame.
struct Probed {
  const DepthProbe& probe;
  std::span<const Vec3> vertices;
  std::span<const mesh::Triangle> triangles;
  bool solid;
};

Vec3 normal_of(const Probed& body, std::uint32_t triangle) noexcept {
  if (triangle >= body.triangles.size()) return Vec3::Zero();
  const mesh::Triangle& t = body.triangles[triangle];
  const Vec3& p = body.vertices[t[0]];
  return (body.vertices[t[1]] - p).cross(body.vertices[t[2]] - p);
}

/// Whether a line in that direction leaves a solid through the triangle; one that runs along it tells nothing.
bool leaves_through(const Probed& body, std::uint32_t triangle, const Vec3& outwards) noexcept {
  const Vec3 normal = normal_of(body, triangle);
  return normal.dot(outwards) > tolerances::along_a_face * normal.norm();
}

/// Signed distance from `point` along `outwards` to the surface where a line in that direction leaves the body. False:
/// it does not, or the time was up between two rays.
bool exit_along(const Probed& body, const Vec3& point, const Vec3& outwards, double reach, Watch& watch,
                double* distance, std::uint32_t* triangle) noexcept {
  const double limit = body.solid ? std::numeric_limits<double>::max() / 4 : reach;
  double ahead = 0.0;
  std::uint32_t triangle_ahead = no_feature;
  const bool found_ahead = body.probe.ray(body.probe.self, point, outwards, limit, &ahead, &triangle_ahead);
  if (body.solid && found_ahead && leaves_through(body, triangle_ahead, outwards)) {
    *distance = ahead;
    *triangle = triangle_ahead;
    return true;
  }
  if (watch.late()) return false;
  double behind = 0.0;
  std::uint32_t triangle_behind = no_feature;
  const Vec3 backwards = -outwards;
  bool found_behind = body.probe.ray(body.probe.self, point, backwards, limit, &behind, &triangle_behind);
  if (body.solid) found_behind = found_behind && leaves_through(body, triangle_behind, outwards);
  if (!body.solid && found_ahead && (!found_behind || ahead <= behind)) {
    *distance = ahead;
    *triangle = triangle_ahead;
    return true;
  }
  *distance = -behind;
  *triangle = triangle_behind;
  return found_behind;
}

/// How the height of a surface along `up` changes across it.
Vec3 slope_of(const Vec3& surface_normal, const Vec3& up) noexcept {
  const double facing = surface_normal.dot(up);
  if (std::abs(facing) <= tolerances::steep * surface_normal.norm()) return Vec3::Zero();  // a wall tells nothing
  return up - surface_normal / facing;
}

/// How the overlap changes across the normal at a witness.
Vec3 slope_of_overlap(const PatchInput& input, const Witness& w, const Vec3& normal) noexcept {
  const Vec3 normal_a = normal_of({input.probe_a, input.vertices_a, input.triangles_a, input.solid_a}, w.triangle_a);
  const Vec3 normal_b = normal_of({input.probe_b, input.vertices_b, input.triangles_b, input.solid_b}, w.triangle_b);
  return slope_of(input.pose_b_in_a.rotation * normal_b, normal) - slope_of(normal_a, normal);
}

}  // namespace

double pair_depth(const PlacedPair& placed, const Frame& frame, const Vec3& shift) noexcept {
  double deepest = 0.0;
  overlap_corners(placed, frame, shift,
                  [&deepest](const Vec3&, const Vec3&, double depth) noexcept { deepest = std::max(deepest, depth); });
  return deepest;
}

Probing probe_line(const PatchInput& input, const Vec3& point, const Vec3& normal, double reach, Watch& watch,
                   Witness& witness) noexcept {
  if (!input.probe_a || !input.probe_b) return Probing::unknown;
  const Probed a{input.probe_a, input.vertices_a, input.triangles_a, input.solid_a};
  const Probed b{input.probe_b, input.vertices_b, input.triangles_b, input.solid_b};
  const Mat3 to_b = input.pose_b_in_a.rotation.transpose();
  double down = 0.0;
  double up = 0.0;
  Witness found;
  if (watch.late() || !exit_along(a, point, -normal, reach, watch, &down, &found.triangle_a)) return Probing::unknown;
  if (watch.late()) return Probing::unknown;
  if (!exit_along(b, to_b * (point - input.pose_b_in_a.translation), to_b * normal, reach, watch, &up,
                  &found.triangle_b)) {
    return Probing::unknown;
  }
  found.depth = up + down;
  if (!std::isfinite(found.depth)) return Probing::unknown;
  if (!(found.depth >= 0.0)) return Probing::apart;
  found.on_a = point - down * normal;
  found.on_b = point + up * normal;
  witness = found;
  return Probing::overlap;
}

bool probe_overlap(const PatchInput& input, const Vec3& point, const Vec3& normal, double reach, Watch& watch,
                   Witness& witness) noexcept {
  return probe_line(input, point, normal, reach, watch, witness) == Probing::overlap;
}

Witness climb(const PatchInput& input, const Witness& start, const Vec3& normal, double radius, double reach,
              Watch& watch) noexcept {
  constexpr int most_probes = 10;
  Witness best = start;
  Vec3 slope = slope_of_overlap(input, best, normal);
  Vec3 across = Vec3::Zero();  // unit, across the ridge that has been reached; zero: none yet
  double step = -1.0;
  for (int i = 0; i < most_probes && !watch.late(); ++i) {
    const Vec3 along = slope - across * across.dot(slope);
    const double steepness = along.norm();
    if (!(steepness * radius > tolerances::level_overlap * best.depth) || !std::isfinite(steepness)) break;
    if (step < 0.0) step = std::clamp(best.depth / steepness, 0.05 * radius, 0.5 * radius);
    const Vec3 uphill = along / steepness;
    Witness next;
    if (!probe_overlap(input, best.middle() + step * uphill, normal, reach, watch, next)) {
      step *= 0.35;  // out of the overlap
      continue;
    }
    const Vec3 next_slope = slope_of_overlap(input, next, normal);
    const double still_uphill = next_slope.dot(uphill);
    if (next.depth > best.depth) {
      step *= still_uphill > 0.0 ? 1.6 : steepness / (steepness - still_uphill);
      best = next;
      slope = next_slope;
    } else if (still_uphill < 0.0 && across == Vec3::Zero()) {
      // Over the ridge: the two slopes differ across it, and agree along it.
      across = (slope - next_slope).normalized();
      step = 0.5 * radius;
    } else {
      step *= 0.35;
    }
  }
  return best;
}

}  // namespace odds::query::patch
