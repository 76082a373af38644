// Eight triangle pairs of a patch at a time: what each instruction set does in its own way. See wide/patch_kernel.hpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "query/patch_overlap.hpp"
#include "query/patch_rim.hpp"

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

/// What `overlap_corners` finds of eight pairs, by lanes, and by the kinds below.
struct CornersOfEight {
  static constexpr std::size_t of_a = 0;      ///< corners of A above B, 3
  static constexpr std::size_t of_b = 3;      ///< corners of B below A, 3
  static constexpr std::size_t crossing = 6;  ///< of side i of A with side j of B: crossing + 3 i + j
  static constexpr std::size_t kinds = 15;

  alignas(64) double depth[kinds][eight];
  alignas(64) double share[kinds][eight];  ///< along A's side; of crossings only
  std::array<std::uint8_t, kinds> found;   ///< lanes; depth is finite and no less than the least that was asked for

  /// The same by lanes: bits of kinds.
  [[nodiscard]] std::array<std::uint16_t, eight> kinds_of_lanes() const noexcept;
  /// What was found in a lane, of the pair that it was asked for, without a shift.
  [[nodiscard]] Witness witness(const PlacedPair& placed, const Frame& frame, std::size_t kind,
                                std::size_t lane) const noexcept;
};

struct Kernels {
  /// As `place`, of up to eight; returns how many were placed, those that cannot be left out.
  std::size_t (*place)(const PatchInput& input, std::span<const TrianglePair> hits, PlacedPair* placed) noexcept;
  /// As `rim_pieces` of placed[0] .. placed[count - 1], count in 1 .. 8.
  void (*cut)(const PlacedPair* placed, std::size_t count, CutEight& pieces) noexcept;
  /// As `overlap_corners` of 1 .. 8 pairs.
  void (*corners)(std::span<const PlacedPair* const> pairs, const Frame& frame, const Vec3& shift, double least_depth,
                  CornersOfEight& corners) noexcept;
};

/// Those for this processor.
[[nodiscard]] const Kernels& kernels() noexcept;

}  // namespace odds::query::patch
