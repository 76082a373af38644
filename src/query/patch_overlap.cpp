// Overlap of pairs of triangles along a direction, and of whole meshes along a line.
#include "query/patch_overlap.hpp"

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

/// Signed distance from `point` along `outwards` to the surface where a line in that direction leaves the body.
bool exit_along(const Probed& body, const Vec3& point, const Vec3& outwards, double reach, double* distance,
                std::uint32_t* triangle) noexcept {
  const double limit = body.solid ? std::numeric_limits<double>::max() / 4 : reach;
  double ahead = 0.0;
  std::uint32_t triangle_ahead = no_feature;
  const bool found_ahead = body.probe.ray(body.probe.self, point, outwards, limit, &ahead, &triangle_ahead);
  if (body.solid && found_ahead && normal_of(body, triangle_ahead).dot(outwards) > 0.0) {
    *distance = ahead;
    *triangle = triangle_ahead;
    return true;
  }
  double behind = 0.0;
  std::uint32_t triangle_behind = no_feature;
  const Vec3 backwards = -outwards;
  bool found_behind = body.probe.ray(body.probe.self, point, backwards, limit, &behind, &triangle_behind);
  if (body.solid) found_behind = found_behind && normal_of(body, triangle_behind).dot(outwards) > 0.0;
  if (!body.solid && found_ahead && (!found_behind || ahead <= behind)) {
    *distance = ahead;
    *triangle = triangle_ahead;
    return true;
  }
  *distance = -behind;
  *triangle = triangle_behind;
  return found_behind;
}

}  // namespace

double pair_depth(const PlacedPair& placed, const Frame& frame, const Vec3& shift) noexcept {
  double deepest = 0.0;
  overlap_corners(placed, frame, shift,
                  [&deepest](const Vec3&, const Vec3&, double depth) noexcept { deepest = std::max(deepest, depth); });
  return deepest;
}

bool probe_overlap(const PatchInput& input, const Vec3& point, const Vec3& normal, double reach, Watch& watch,
                   Witness& witness) noexcept {
  if (!input.probe_a || !input.probe_b) return false;
  const Probed a{input.probe_a, input.vertices_a, input.triangles_a, input.solid_a};
  const Probed b{input.probe_b, input.vertices_b, input.triangles_b, input.solid_b};
  const Mat3 to_b = input.pose_b_in_a.rotation.transpose();
  double down = 0.0;
  double up = 0.0;
  Witness found;
  if (watch.late() || !exit_along(a, point, -normal, reach, &down, &found.triangle_a)) return false;
  if (watch.late()) return false;
  if (!exit_along(b, to_b * (point - input.pose_b_in_a.translation), to_b * normal, reach, &up, &found.triangle_b)) {
    return false;
  }
  found.depth = up + down;
  if (!(found.depth >= 0.0) || !std::isfinite(found.depth)) return false;
  found.on_a = point - down * normal;
  found.on_b = point + up * normal;
  witness = found;
  return true;
}

}  // namespace odds::query::patch
