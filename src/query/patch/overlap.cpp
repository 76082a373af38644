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

void cast(const DepthProbe& probe, ProbeRay& ray) noexcept {
  ray.found = probe.ray(probe.self, ray.origin, ray.direction, ray.max_distance, &ray.distance, &ray.triangle);
}

/// One ray with each probe; a null one is left out.
void cast_both(const PatchInput& input, ProbeRay* ray_a, ProbeRay* ray_b) noexcept {
  if (ray_a != nullptr && ray_b != nullptr && input.probe_both != nullptr) {
    return input.probe_both(input.probe_a, *ray_a, input.probe_b, *ray_b);
  }
  if (ray_a != nullptr) cast(input.probe_a, *ray_a);
  if (ray_b != nullptr) cast(input.probe_b, *ray_b);
}

/// Where a line through a point leaves a body: looked for ahead, and, where that tells nothing, behind.
class Exit {
 public:
  Exit(const Probed& body, const Vec3& point, const Vec3& outwards, double reach) noexcept
      : body_(body), ahead_(ray_from(point, outwards, reach)), behind_(ray_from(point, -outwards, reach)) {}

  [[nodiscard]] ProbeRay* first() noexcept { return &ahead_; }
  /// Once the first is cast; null if that has told all.
  [[nodiscard]] ProbeRay* second() noexcept { return is_ahead() ? nullptr : &behind_; }

  /// Once both are cast: whether there is nothing of the body, as far as they reach.
  [[nodiscard]] bool is_missed() const noexcept { return !ahead_.found && !behind_.found; }
  /// Once both are cast: the signed distance from the point along the line, and the triangle. False: it does not leave.
  [[nodiscard]] bool place(double& distance, std::uint32_t& triangle) const noexcept {
    if (is_ahead()) return give(ahead_, 1.0, distance, triangle);
    const bool found_behind =
        behind_.found && (!body_.solid || leaves_through(body_, behind_.triangle, ahead_.direction));
    if (!body_.solid && ahead_.found && (!found_behind || ahead_.distance <= behind_.distance)) {
      return give(ahead_, 1.0, distance, triangle);
    }
    return found_behind && give(behind_, -1.0, distance, triangle);
  }

 private:
  [[nodiscard]] ProbeRay ray_from(const Vec3& point, const Vec3& direction, double reach) const noexcept {
    return {point, direction, body_.solid ? std::numeric_limits<double>::max() / 4 : reach};
  }
  [[nodiscard]] bool is_ahead() const noexcept {
    return body_.solid && ahead_.found && leaves_through(body_, ahead_.triangle, ahead_.direction);
  }
  static bool give(const ProbeRay& ray, double sign, double& distance, std::uint32_t& triangle) noexcept {
    distance = sign * ray.distance;
    triangle = ray.triangle;
    return true;
  }

  const Probed& body_;
  ProbeRay ahead_;
  ProbeRay behind_;
};

}  // namespace

double pair_depth(const PlacedPair& placed, const Frame& frame, const Vec3& shift) noexcept {
  double deepest = 0.0;
  overlap_corners(placed, frame, shift,
                  [&deepest](const Vec3&, const Vec3&, double depth) noexcept { deepest = std::max(deepest, depth); });
  return deepest;
}

Probing probe_line(const PatchInput& input, const Vec3& point, const Vec3& normal, double reach, Watch& watch,
                   Witness& witness) noexcept {
  if (!input.probe_a || !input.probe_b || watch.late()) return Probing::unknown;
  const Probed a{input.probe_a, input.vertices_a, input.triangles_a, input.solid_a};
  const Probed b{input.probe_b, input.vertices_b, input.triangles_b, input.solid_b};
  const Mat3 to_b = input.pose_b_in_a.rotation.transpose();
  Exit of_a(a, point, -normal, reach);
  Exit of_b(b, to_b * (point - input.pose_b_in_a.translation), to_b * normal, reach);
  cast_both(input, of_a.first(), of_b.first());
  ProbeRay* const again_a = of_a.second();
  ProbeRay* const again_b = of_b.second();
  if (again_a != nullptr || again_b != nullptr) {
    if (watch.late()) return Probing::unknown;
    cast_both(input, again_a, again_b);
  }
  double down = 0.0;
  double up = 0.0;
  Witness found;
  if (of_a.is_missed() || of_b.is_missed()) return Probing::missed;
  if (!of_a.place(down, found.triangle_a) || !of_b.place(up, found.triangle_b)) return Probing::unknown;
  found.depth = up + down;
  if (!std::isfinite(found.depth)) return Probing::unknown;
  found.on_a = point - down * normal;
  found.on_b = point + up * normal;
  witness = found;
  return found.depth >= 0.0 ? Probing::overlap : Probing::apart;
}

bool probe_overlap(const PatchInput& input, const Vec3& point, const Vec3& normal, double reach, Watch& watch,
                   Witness& witness) noexcept {
  return probe_line(input, point, normal, reach, watch, witness) == Probing::overlap;
}

Vec3 normal_in_a(const PatchInput& input, std::uint32_t triangle) noexcept {
  return normal_of({input.probe_a, input.vertices_a, input.triangles_a, input.solid_a}, triangle);
}

Vec3 normal_in_b(const PatchInput& input, std::uint32_t triangle) noexcept {
  return input.pose_b_in_a.rotation *
         normal_of({input.probe_b, input.vertices_b, input.triangles_b, input.solid_b}, triangle);
}

}  // namespace odds::query::patch
