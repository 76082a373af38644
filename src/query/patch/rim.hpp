// The rim of an overlap: the pieces of curve in which two surfaces cross, one or more for each intersecting triangle
// pair.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "odds/query/contact_patch.hpp"

namespace odds::query::patch {

/// Two triangles in A's frame. A normal is unit, or zero if the triangle has no area.
struct PlacedPair {
  std::array<Vec3, 3> a;
  std::array<Vec3, 3> b;
  Vec3 normal_a = Vec3::Zero();
  Vec3 normal_b = Vec3::Zero();
  TrianglePair index;
};

/// A directed piece of the rim. Both surfaces oriented outwards, the pieces of a closed rim follow one another,
/// counter- clockwise seen from A's side: direction = normal_b x normal_a.
struct RimPiece {
  Vec3 from = Vec3::Zero();
  Vec3 to = Vec3::Zero();
  double length = 0.0;          ///< of along()
  std::uint32_t pair = 0;       ///< index of its PlacedPair
  std::uint32_t component = 0;  ///< set by connect()
  bool counts = true;           ///< false for a copy of another piece (a rim that runs along an edge of a mesh)

  [[nodiscard]] Vec3 along() const noexcept { return to - from; }
  [[nodiscard]] Vec3 middle() const noexcept { return 0.5 * (from + to); }
};

constexpr std::size_t most_pieces_of_a_pair = 6;

/// Writes the pieces of rim of two triangles that are known to meet (`pair` stands in each of them) and returns how
/// many: 1 as a rule; for coplanar triangles that face each other the sides of their common polygon, for coplanar ones
/// that face the same way nothing if both bodies are solid (they say nothing about a direction); at least a point
/// otherwise.
[[nodiscard]] std::size_t rim_pieces(const PlacedPair& placed, bool both_solid, std::uint32_t pair,
                                     std::span<RimPiece, most_pieces_of_a_pair> pieces) noexcept;

}  // namespace odds::query::patch
