// Eight triangle pairs of a patch at a time: what each instruction set does in its own way. See wide/patch_kernel.hpp.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "odds/math/tolerances.hpp"
#include "query/patch/overlap.hpp"
#include "query/patch/rim.hpp"
#include "query/patch/select.hpp"

namespace odds::query::patch {

inline constexpr std::size_t eight = 8;

/// The pieces of rim of eight pairs, by lanes. Those that are not `plain` are left to `rim_pieces`.
struct CutEight {
  alignas(64) double from[3][eight];
  alignas(64) double to[3][eight];
  alignas(64) double length[eight];
  unsigned plain;  ///< bits of the pairs of which each triangle has one corner alone beyond the other's plane

  [[nodiscard]] RimPiece piece(std::size_t lane, std::uint32_t pair) const noexcept {
    RimPiece made;
    made.from = {from[0][lane], from[1][lane], from[2][lane]};
    made.to = {to[0][lane], to[1][lane], to[2][lane]};
    made.length = length[lane];
    made.pair = pair;
    return made;
  }
};

/// What `overlap_corners` finds of eight pairs, or of one along eight directions, by lanes, and by the kinds below.
/// Lanes that were not asked for are as the first, but for `found`.
struct CornersOfEight {
  static constexpr std::size_t of_a = 0;      ///< corners of A above B, 3
  static constexpr std::size_t of_b = 3;      ///< corners of B below A, 3
  static constexpr std::size_t crossing = 6;  ///< of side i of A with side j of B: crossing + 3 i + j
  static constexpr std::size_t kinds = 15;

  alignas(64) double depth[kinds][eight];
  alignas(64) double share[kinds][eight];  ///< along A's side; of crossings only
  alignas(64) double deepest[eight];       ///< of what was found in each lane, at least 0
  std::array<std::uint8_t, kinds> found;   ///< lanes; depth is finite and no less than the least that was asked for

  /// What was found by lanes: bits of kinds.
  [[nodiscard]] std::array<std::uint16_t, eight> kinds_of_lanes() const noexcept;
  /// What was found in a lane, of the pair and along the direction that it was asked for, without a shift.
  [[nodiscard]] Witness witness(const PlacedPair& placed, const Vec3& direction, std::size_t kind,
                                std::size_t lane) const noexcept;
};

/// Up to eight pieces of rim, by lanes: their pairs and lengths; of lanes that are not used any pair and 0.
struct EightPieces {
  alignas(64) std::array<double, eight> length{};
  std::array<const PlacedPair*, eight> pairs{};
  std::size_t count = 0;

  void add(const RimPiece& piece, const PlacedPair& placed) noexcept {
    length[count] = piece.length;
    pairs[count++] = &placed;
  }
  /// The next eight.
  void clear() noexcept {
    length.fill(0.0);
    count = 0;
  }
};

/// Which triangles' normals are near a direction, turned round if need be: steeper ones are not, nor those of a solid
/// that lead the other way.
struct Facing {
  static constexpr double steepest = 0.8;  ///< cosine
  Vec3 direction;
  bool solid_a;
  bool solid_b;

  /// The normals so turned, or zero.
  [[nodiscard]] Vec3 of_a(const PlacedPair& placed) const noexcept { return turned(placed.normal_a, solid_a, -1.0); }
  [[nodiscard]] Vec3 of_b(const PlacedPair& placed) const noexcept { return turned(placed.normal_b, solid_b, 1.0); }

 private:
  [[nodiscard]] Vec3 turned(const Vec3& normal, bool solid, double sign) const noexcept {
    const double along = normal.dot(direction);
    if (!(std::abs(along) > steepest) || (solid && sign * along < 0.0)) return Vec3::Zero();
    return std::copysign(1.0, along) * normal;
  }
};

/// Cosines of the angle between a normal and a flat face: as good as that, and far off.
inline constexpr double flat_agreement = 1.0 - 0.5 * tolerances::flat_from * tolerances::flat_from;
inline constexpr double not_flat = 0.99;
static_assert(not_flat < 1.0 - tolerances::flat_to * tolerances::flat_to);

/// Sums over pieces of rim by lanes: of the normals that count, times length, and of lengths.
struct FaceSums {
  alignas(64) double normal[3][eight]{};
  alignas(64) double length[eight]{};

  [[nodiscard]] Vec3 normals() const noexcept;
  [[nodiscard]] double lengths() const noexcept;
};

struct Kernels {
  /// Fetches the triangles of up to eight pairs; returns how many. Those with an index out of range or a coordinate
  /// that is not finite are left out.
  std::size_t (*place)(const PatchInput& input, std::span<const TrianglePair> hits, PlacedPair* placed) noexcept;
  /// As `rim_pieces` of placed[0] .. placed[count - 1], count in 1 .. 8.
  void (*cut)(const PlacedPair* placed, std::size_t count, CutEight& pieces) noexcept;
  /// As `overlap_corners` of 1 .. 8 pairs.
  void (*corners)(std::span<const PlacedPair* const> pairs, const Frame& frame, const Vec3& shift, double least_depth,
                  CornersOfEight& corners) noexcept;
  /// As `overlap_corners` of one pair along 1 .. 8 directions, unit, with a least depth of 0.
  void (*corners_along)(const PlacedPair& pair, std::span<const Vec3> directions, const Vec3& shift,
                        CornersOfEight& corners) noexcept;
  /// Adds the normals that agree with `first`. Returns those that face that way and do not, as bits: B's from bit 0 on,
  /// A's from bit 8 on.
  unsigned (*same_faces)(const EightPieces& pieces, const Facing& facing, const Vec3& first, FaceSums& sums) noexcept;
  /// Adds the normals that are as good as `flat`, and the lengths of pieces with any. Returns the lanes, not added, of
  /// which a normal is neither that nor far off.
  unsigned (*flat_faces)(const EightPieces& pieces, const Facing& facing, const Vec3& flat, FaceSums& sums) noexcept;
  /// Where points reach farthest in the directions of a fan, beyond what is known by then. The points' coordinates in
  /// the fan's plane are at u and v, their numbers count from `first`.
  void (*farthest)(const double* u, const double* v, std::size_t count, std::size_t first, const Fan& fan,
                   FanEnds& ends) noexcept;
};

/// Those of the best instruction set that runs here. They are compiled with the searches (src/query/wide/searches.cpp).
[[nodiscard]] const Kernels& best_kernels() noexcept;

}  // namespace odds::query::patch
