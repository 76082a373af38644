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

/// How the height of a surface along `up` changes across it.
Vec3 slope_of(const Vec3& surface_normal, const Vec3& up) noexcept {
  const double facing = surface_normal.dot(up);
  if (std::abs(facing) <= tolerances::steep * surface_normal.norm()) return Vec3::Zero();  // a wall tells nothing
  return up - surface_normal / facing;
}

/// How the heights of both surfaces change across the normal.
struct Slopes {
  Vec3 of_a;
  Vec3 of_b;

  [[nodiscard]] Vec3 of_overlap() const noexcept { return of_b - of_a; }
};

Slopes slopes_at(const PatchInput& input, const Witness& w, const Vec3& normal) noexcept {
  const Vec3 normal_a = normal_of({input.probe_a, input.vertices_a, input.triangles_a, input.solid_a}, w.triangle_a);
  const Vec3 normal_b = normal_of({input.probe_b, input.vertices_b, input.triangles_b, input.solid_b}, w.triangle_b);
  return {slope_of(normal_a, normal), slope_of(input.pose_b_in_a.rotation * normal_b, normal)};
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
  if (!of_a.place(down, found.triangle_a) || !of_b.place(up, found.triangle_b)) return Probing::unknown;
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

Witness climb(const PatchInput& input, const Witness& start, const Witness& beside, const Vec3& normal, double radius,
              double reach, Watch& watch) noexcept {
  constexpr int most_steps = 10;
  constexpr int most_in_vain = 2;
  Witness best = start;
  Slopes slopes = slopes_at(input, best, normal);
  Vec3 slope = slopes.of_overlap();
  const auto probe_at = [&](const Vec3& place, Witness& next) noexcept {
    return probe_overlap(input, place, normal, reach, watch, next);
  };
  // A spike that leans may lie beside the middle: it is followed just inside of its own surface. What is flat is none.
  const bool may_lean = start.depth > tolerances::flat_overlap * radius;
  const auto probe_beyond = [&](const Vec3& way, Witness& next) noexcept {
    if (probe_at(best.middle() + way, next)) return true;
    if (!may_lean) return false;
    const double inside = tolerances::inside_surface * way.norm();
    return slopes.of_b.squaredNorm() > slopes.of_a.squaredNorm()
               ? probe_at(best.on_b + way + (slopes.of_b.dot(way) - inside) * normal, next)
               : probe_at(best.on_a + way + (slopes.of_a.dot(way) + inside) * normal, next);
  };
  Vec3 across = Vec3::Zero();  // unit, across the ridge that has been reached; zero: none yet
  double step = -1.0;
  int in_vain = 0;  // steps out of the overlap, until there was one within it; -1: no longer counted
  for (int i = 0; i < most_steps && !watch.late(); ++i) {
    const Vec3 along = slope - across * across.dot(slope);
    const double steepness = along.norm();
    if (!(steepness * radius > tolerances::level_overlap * best.depth) || !std::isfinite(steepness)) break;
    if (step < 0.0) step = std::clamp(best.depth / steepness, 0.05 * radius, 0.5 * radius);
    const Vec3 uphill = along / steepness;
    Witness next;
    if (!probe_beyond(step * uphill, next)) {
      step *= 0.35;  // out of the overlap
      // At the side of a spike uphill leads out of it whatever the step.
      if (may_lean && beside.depth < start.depth && in_vain >= 0 && ++in_vain == most_in_vain) {
        best = beside;
        slopes = slopes_at(input, best, normal);
        slope = slopes.of_overlap();
        step = -1.0;
        in_vain = -1;
      }
      continue;
    }
    in_vain = -1;
    const Slopes next_slopes = slopes_at(input, next, normal);
    const Vec3 next_slope = next_slopes.of_overlap();
    const double still_uphill = next_slope.dot(uphill);
    if (next.depth > best.depth) {
      step *= still_uphill > 0.0 ? 1.6 : steepness / (steepness - still_uphill);
      best = next;
      slopes = next_slopes;
      // Between two facets of a spike the way leads along their ridge.
      slope = may_lean ? Vec3(0.5 * (slope + next_slope)) : next_slope;
    } else if (still_uphill < 0.0 && across == Vec3::Zero()) {
      // Over the ridge: the two slopes differ across it, and agree along it.
      across = (slope - next_slope).normalized();
      step = 0.5 * radius;
    } else {
      step *= 0.35;
    }
  }
  return best.depth > start.depth ? best : start;
}

}  // namespace odds::query::patch
