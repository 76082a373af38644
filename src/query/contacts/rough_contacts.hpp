// Contacts from single pairs of triangles: what a budget without time for a patch still gives.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>

#include "odds/math/tolerances.hpp"
#include "odds/primitive/triangle_triangle.hpp"
#include "odds/query/answer.hpp"
#include "odds/query/contact_patch.hpp"
#include "query/posed_meshes.hpp"

namespace odds::query {

/// A pair of triangles and the segment in which they meet, in A's hierarchy frame; metres.
struct Crossing {
  tree::TriangleCorners a;
  tree::TriangleCorners b;
  Vec3 normal_a;  ///< unit, or zero for a triangle without area
  Vec3 normal_b;
  primitive::IntersectionSegment segment;  ///< turned so that it runs along normal_a x normal_b

  [[nodiscard]] static Crossing of(const PosedMeshes& meshes, TrianglePair hit) noexcept {
    Crossing crossing{meshes.corners_a(hit.a), meshes.corners_b(hit.b), {}, {}, {}};
    crossing.normal_a = unit_normal(crossing.a);
    crossing.normal_b = unit_normal(crossing.b);
    const Vec3 middle = (crossing.a[0] + crossing.a[1] + crossing.a[2]) / 3.0;
    crossing.segment.begin = crossing.segment.end = middle;
    static_cast<void>(primitive::intersection_segment(crossing.a.data(), crossing.b.data(), crossing.segment));
    const Vec3 along = crossing.segment.end - crossing.segment.begin;
    if (along.dot(crossing.normal_a.cross(crossing.normal_b)) < 0.0) {
      std::swap(crossing.segment.begin, crossing.segment.end);
    }
    return crossing;
  }
  [[nodiscard]] Vec3 middle() const noexcept { return 0.5 * (segment.begin + segment.end); }
  /// How far the triangles overlap along a direction into A, >= 0.
  [[nodiscard]] double overlap_along(const Vec3& direction) const noexcept {
    const double top_b = std::max({direction.dot(b[0]), direction.dot(b[1]), direction.dot(b[2])});
    const double bottom_a = std::min({direction.dot(a[0]), direction.dot(a[1]), direction.dot(a[2])});
    return std::max(top_b - bottom_a, 0.0);
  }

 private:
  [[nodiscard]] static Vec3 unit_normal(const tree::TriangleCorners& t) noexcept {
    const Vec3 cross = (t[1] - t[0]).cross(t[2] - t[0]);
    const double length = cross.norm();
    return length > 0.0 ? Vec3(cross / length) : Vec3(Vec3::Zero());
  }
};

/// Of some crossings, one at least.
[[nodiscard]] inline Vec3 middle_of(std::span<const Crossing> crossings) noexcept {
  Vec3 middle = Vec3::Zero();
  for (const Crossing& crossing : crossings) middle += crossing.middle() / static_cast<double>(crossings.size());
  return middle;
}

/// Towards A, as bodies lie that meet at `place`, in A's hierarchy frame; unit, or zero where it says nothing. The
/// middle of a sheet, as of ground, may be anywhere: the other body's says on which side of it that is.
[[nodiscard]] inline Vec3 side_of_place(const PosedMeshes& meshes, bool solid_a, bool solid_b,
                                        const Vec3& place) noexcept {
  const Vec3& centre_b = meshes.pose().translation;
  if (solid_a == solid_b) return (-centre_b).stableNormalized();
  return (solid_a ? Vec3(-place) : Vec3(place - centre_b)).stableNormalized();
}

/// The direction into A of least common volume, from some of the crossings of one overlap: the vector area that their
/// segments span about their middle (see PatchBuilder; exact if they are all), or where they span none the sum of the
/// differences of normals, for what the sides of an overlap say sideways cancels out. `towards_a`: last resort, and the
/// side of surfaces that have none. Unit.
[[nodiscard]] inline Vec3 rough_direction(std::span<const Crossing> crossings, bool both_solid,
                                          const Vec3& towards_a) noexcept {
  const Vec3 middle = middle_of(crossings);
  Vec3 apart = Vec3::Zero();
  double length = 0.0;
  for (const Crossing& crossing : crossings) {
    apart += crossing.normal_b - crossing.normal_a;
    length += (crossing.segment.end - crossing.segment.begin).norm();
  }
  Vec3 area = Vec3::Zero();
  for (const Crossing& crossing : crossings) {
    area += 0.5 * (crossing.segment.begin - middle).cross(crossing.segment.end - middle);
  }
  if (!both_solid && apart.dot(towards_a) < 0.0) apart = -apart;
  if (area.dot(apart) < 0.0) area = -area;
  // A closed curve of this length spans at most 1 / (4 pi) of its square; one that is long and thin, or a piece of one,
  // must not point elsewhere than the normals do.
  const double spanned = area.norm();
  const bool wide = spanned > 0.01 * length * length;
  if (spanned > 1e-5 * length * length && (wide || area.dot(apart) > 0.5 * spanned * apart.norm())) {
    return area / spanned;
  }
  if (apart.norm() > 1e-6) return apart.normalized();
  return towards_a.norm() > 0.0 ? Vec3(towards_a.normalized()) : Vec3(Vec3::UnitZ());
}

/// The normal of a face that carries most of the crossings, if it is not far from `direction` and parts the triangles
/// sooner; else `direction`. A face that lies on a face is then pushed straight, from however few crossings.
[[nodiscard]] inline Vec3 snapped_to_face(std::span<const Crossing> crossings, bool both_solid,
                                          const Vec3& direction) noexcept {
  const auto towards = [&](const Vec3& normal) noexcept {
    return !both_solid && normal.dot(direction) < 0.0 ? Vec3(-normal) : normal;
  };
  const auto share_on = [&](const Vec3& face) noexcept {
    double on = 0.0;
    double all = 0.0;
    for (const Crossing& crossing : crossings) {
      const double length = (crossing.segment.end - crossing.segment.begin).norm();
      all += length;
      if (std::max(face.dot(towards(crossing.normal_b)), face.dot(towards(-crossing.normal_a))) > tolerances::same_face)
        on += length;
    }
    return on / all;  // not a number where nothing has a length: no share
  };
  const auto most_overlap = [&](const Vec3& along) noexcept {
    double most = 0.0;
    for (const Crossing& crossing : crossings) most = std::max(most, crossing.overlap_along(along));
    return most;
  };
  Vec3 best = direction;
  double least = most_overlap(direction);
  for (const Crossing& crossing : crossings) {
    for (const Vec3& face : {towards(crossing.normal_b), towards(-crossing.normal_a)}) {
      if (face == best || !(face.dot(direction) > 0.5) || !(share_on(face) > tolerances::snap_from)) continue;
      const double overlap = most_overlap(face);
      if (!(overlap < least)) continue;
      least = overlap;
      best = face;
    }
  }
  return best;
}

/// Diagonal of the box about all segments.
[[nodiscard]] inline double extent_of(std::span<const Crossing> crossings) noexcept {
  Vec3 lower = crossings.front().segment.begin;
  Vec3 upper = lower;
  for (const Crossing& crossing : crossings) {
    lower = lower.cwiseMin(crossing.segment.begin).cwiseMin(crossing.segment.end);
    upper = upper.cwiseMax(crossing.segment.begin).cwiseMax(crossing.segment.end);
  }
  return (upper - lower).norm();
}

/// In which order to take an eighth of a list each (bits reversed: a van der Corput sequence). First those that are far
/// apart: if time is short, they are all there is.
inline constexpr std::array<std::size_t, most_contacts> spread_eighths{0, 4, 2, 6, 1, 5, 3, 7};

/// As many contacts as there is room for, spread over the hits, all with one direction and one depth: the least overlap
/// of some pairs of triangles along it, at most the extent of what was cut. In A's mesh frame. About 0.4 us for each
/// pair; `may_go_on()` is asked before every one after the first. `towards_a(place)`: the side of surfaces that have
/// none, for bodies that meet there. `known`: the direction, or null. Returns how many.
template <class TowardsA, class MayGoOn>
std::size_t rough_contacts(const PosedMeshes& meshes, std::span<const TrianglePair> hits, bool both_solid,
                           TowardsA towards_a, const Vec3* known, std::span<Contact> written,
                           MayGoOn may_go_on) noexcept {
  std::array<Crossing, most_contacts> crossings;  // also for one contact: a direction is made of several
  std::array<TrianglePair, most_contacts> chosen;
  const std::size_t most = std::min(hits.size(), crossings.size());
  std::size_t count = 0;
  for (const std::size_t eighth : spread_eighths) {
    if (eighth >= most) continue;
    if (count > 0 && !may_go_on()) break;
    chosen[count] = hits[eighth * hits.size() / most];
    crossings[count] = Crossing::of(meshes, chosen[count]);
    ++count;
  }
  const std::span<const Crossing> made = std::span(crossings).first(count);
  const Vec3 direction =
      known != nullptr
          ? *known
          : snapped_to_face(made, both_solid, rough_direction(made, both_solid, towards_a(middle_of(made))));
  // A corner that has just come through is not deeper than its rim is wide, though the triangles reach on.
  double depth = extent_of(made);
  for (const Crossing& crossing : made) depth = std::min(depth, crossing.overlap_along(direction));
  count = std::min(count, written.size());
  for (std::size_t i = 0; i < count; ++i) {
    written[i] = {made[i].middle() + meshes.origin_a(), direction, depth, chosen[i].a, chosen[i].b};
  }
  return count;
}

}  // namespace odds::query
