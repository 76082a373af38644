// Where the axis of a capsule comes near the surface of a mesh, or goes through it.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "ode/collide/limit.hpp"
#include "ode/mesh/prepared_mesh.hpp"

namespace odds::ode {

/// Triangles nearest to the axis of a capsule and to its ends, or what was when they were looked for; no_feature: none.
struct NearestToCapsule {
  std::uint32_t to_axis = query::no_feature;
  std::array<std::uint32_t, 2> to_end = {query::no_feature, query::no_feature};
};

/// In the mesh's frame, metres: all points at most `radius` from the segment between the two ends.
struct Capsule {
  /// Of the radius: nearer places are one place, and an axis this near to the surface is on it.
  static constexpr double same_place = 1e-6;

  std::array<Vec3, 2> ends;
  double radius;
  Mat3 axes;               ///< columns; the third leads from the first end to the second
  NearestToCapsule guess;  ///< searches start from these

  [[nodiscard]] Vec3 middle() const noexcept { return 0.5 * (ends[0] + ends[1]); }
};

/// The point of one triangle that is nearest to the axis.
struct CapsulePlace {
  Vec3 on_axis;
  Vec3 on_surface;
  double distance;  ///< 0: the axis meets the triangle there
  double extent;    ///< no point of the triangle is farther from `on_surface`
  std::uint32_t triangle;
};

struct CapsulePlaces {
  static constexpr std::size_t most = 256;
  std::array<CapsulePlace, most> all;
  std::size_t count = 0;
  bool complete = true;         ///< false: some triangle was left out; the nearest of those that were seen is there
  bool cut_off = false;         ///< by the limit; else only the room for places was too small
  bool nearest_is_sure = true;  ///< none is nearer by 1e-6 of the mesh's size, nor within the radius if there is none

  [[nodiscard]] std::span<const CapsulePlace> span() const noexcept { return {all.data(), count}; }
};

/// Whether there is hardly time to look at all triangles near a capsule.
[[nodiscard]] bool has_little_time(const Limit& limit) noexcept;

/// One place for each triangle that is nearer to the axis than the radius, nearest first. noexcept, no allocation.
void find_places(const PreparedMesh& mesh, const Capsule& capsule, Limit& limit, CapsulePlaces& places) noexcept;

/// One of several equal parts of an axis, counted from its first end.
struct PartOfAxis {
  std::uint32_t number = 0;
  std::uint32_t of = 1;
};

/// The nearest of those only, or where the axis goes through: `complete` if there is none. Less than the whole axis:
/// what is nearest to that part, or the guess, but surely neither. noexcept, no allocation.
void find_nearest_place(const PreparedMesh& mesh, const Capsule& capsule, PartOfAxis part, Limit& limit,
                        CapsulePlaces& places) noexcept;

/// Whether no nearer triangle of `places` touches the place: otherwise it is only the rim of a neighbour, and its
/// normal would be that of an internal edge.
[[nodiscard]] bool is_local_minimum(const PreparedMesh& mesh, const CapsulePlaces& places, std::size_t index,
                                    double tolerance) noexcept;

}  // namespace odds::ode
