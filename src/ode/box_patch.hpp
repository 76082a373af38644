// The pieces of a mesh's surface inside a box, and the direction in which the box leaves them soonest.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "odds/math/types.hpp"

namespace odds::ode {

/// A triangle cut by a box, in the box's frame (centre at the origin, axes along the sides).
struct Piece {
  static constexpr std::size_t most_corners = 9;  // three corners, one more for each of six cuts
  std::array<Vec3, most_corners> corners;
  std::array<std::int8_t, most_corners> side;  ///< of the edge from corner i on: the box face that cut it (axis, or
                                               ///< axis + 3 for the negative face), or -1 for an edge of the triangle
  std::size_t count = 0;
  Vec3 normal = Vec3::Zero();  ///< unit, of the triangle
  double area = 0.0;           ///< of the piece
  std::uint32_t triangle = 0;
};

/// Cuts a triangle (box frame) by the box {|x_i| <= half_i}. False if nothing with an area is left.
[[nodiscard]] bool cut_by_box(const std::array<Vec3, 3>& triangle, const Vec3& half, Piece& piece) noexcept;

/// Where a box goes to leave a patch of surface.
struct Exit {
  Vec3 direction = Vec3::Zero();  ///< unit, of the box's motion
  double depth = 0.0;             ///< metres until the box is clear of the patch; infinity: no way found
};

/// The shortest way out of `patch` (pieces with similar normals) among the patch's normals, the box's faces and the
/// crossings of box edges with the patch's own edges. Where the surface goes on beyond the box on the side that the box
/// moves to, the whole plane of the piece must be cleared, not only the piece: otherwise a box would slip sideways out
/// of a tessellated floor.
[[nodiscard]] Exit shortest_exit(std::span<const Piece* const> patch, const Vec3& half) noexcept;

}  // namespace odds::ode
