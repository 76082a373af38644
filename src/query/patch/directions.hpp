// Directions that a patch may have, and what speaks for one of them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "odds/math/tolerances.hpp"
#include "odds/query/contact_patch.hpp"
#include "query/patch/eight.hpp"

namespace odds::query::patch {

[[nodiscard]] inline Vec3 unit_or_zero(const Vec3& v) noexcept {
  const double length = v.norm();
  return length > 0.0 && std::isfinite(length) ? Vec3(v / length) : Vec3::Zero();
}

[[nodiscard]] inline double smooth_step(double from, double to, double x) noexcept {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// Where the bodies are, as seen from the centre of a patch with a sheet: a direction towards A's body and away from
/// B's; zero if both are solid, for then the orientation of the surfaces says it exactly.
[[nodiscard]] inline Vec3 side_of_bodies(const PatchInput& input, const Vec3& centre) noexcept {
  if (input.solid_a && input.solid_b) return Vec3::Zero();
  Vec3 side = input.reference_a - input.reference_b;
  if (input.solid_a) side = input.reference_a - centre;
  if (input.solid_b) side = centre - input.reference_b;
  side = unit_or_zero(side);
  if (input.previous_normal != nullptr) side += tolerances::previous_side * *input.previous_normal;
  if (input.came != nullptr) side += tolerances::came_side * *input.came;
  return side;
}

/// By how much the overlap along a direction counts less if the run before had this direction.
[[nodiscard]] inline double hysteresis_of(const PatchInput& input, const Vec3& direction) noexcept {
  const Vec3* const previous = input.previous_normal;
  return previous != nullptr && previous->dot(direction) > tolerances::same_as_before ? tolerances::hysteresis : 1.0;
}

/// B's normal less A's, or of sums of them. That of a sheet, whose triangles may be turned either way, is taken as that
/// of a body on its side.
[[nodiscard]] inline Vec3 difference_of_normals(const PatchInput& input, const Vec3& normal_a, const Vec3& normal_b,
                                                const Vec3& side) noexcept {
  const Vec3 a = !input.solid_a && normal_a.dot(side) > 0.0 ? Vec3(-normal_a) : normal_a;
  const Vec3 b = !input.solid_b && normal_b.dot(side) < 0.0 ? Vec3(-normal_b) : normal_b;
  return b - a;
}

/// In which direction bodies that only touch are pressed together by a trifle before directions are compared: along
/// the difference of the normals, or else where the bodies are; unit, or zero.
[[nodiscard]] inline Vec3 pressing_direction(const PatchInput& input, const Vec3& difference,
                                             const Vec3& side) noexcept {
  for (const Vec3& direction : {difference, side, Vec3(input.reference_a - input.reference_b)}) {
    if (const Vec3 unit = unit_or_zero(direction); unit != Vec3::Zero()) return unit;
  }
  return Vec3::Zero();
}

/// A direction turned to a face's, the more the greater the share of the rim that is on the face; to the last bit the
/// direction where that is too little.
[[nodiscard]] inline Vec3 snapped_to(const Vec3& face, double share, const Vec3& direction) noexcept {
  const double snap = smooth_step(tolerances::snap_from, tolerances::snap_to, share);
  if (snap == 0.0) return direction;
  const Vec3 snapped = unit_or_zero((1.0 - snap) * direction + snap * unit_or_zero(face));
  return snapped == Vec3::Zero() ? direction : snapped;
}

/// A few directions with weights; directions within two degrees are one.
struct Directions {
  struct One {
    Vec3 sum = Vec3::Zero();
    Vec3 first = Vec3::Zero();
    double weight = 0.0;

    /// Of all that are one; the first if they cancel out.
    [[nodiscard]] const Vec3& mean() const noexcept { return sum == Vec3::Zero() ? first : sum; }
  };
  std::array<One, 8> ones;
  std::size_t count = 0;

  void add(const Vec3& direction, double weight) noexcept {
    if (direction == Vec3::Zero()) return;
    for (std::size_t i = 0; i < count; ++i) {
      if (direction.dot(ones[i].first) > tolerances::same_face) {
        ones[i].sum += weight * direction;
        ones[i].weight += weight;
        return;
      }
    }
    if (count < ones.size()) ones[count++] = {weight * direction, direction, weight};
  }
};

/// How much a face normal counts as the flat face `flat`: 1 up to half a degree, 0 from three degrees on, or if it is
/// zero.
[[nodiscard]] inline double flatness(const Vec3& normal, const Vec3& flat) noexcept {
  if (normal.dot(flat) > flat_agreement) return 1.0;
  if (normal == Vec3::Zero()) return 0.0;
  return 1.0 - smooth_step(tolerances::flat_from, tolerances::flat_to, normal.cross(flat).norm());
}

}  // namespace odds::query::patch
