// The pieces of a mesh's surface inside a convex body, and the direction in which the body leaves them soonest.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "odds/math/pose.hpp"
#include "ode/collide/limit.hpp"
#include "ode/geom/convex_body.hpp"
#include "ode/mesh/prepared_mesh.hpp"

namespace odds::ode {

/// Shares of a collision's time after which a part of its work ends, so that what it found can be worked on: pieces are
/// gathered, ways out are looked for, points are made; then contacts are chosen, for which the limit keeps time of its
/// own.
constexpr double time_for_pieces = 0.55;
constexpr double time_for_exits = 0.72;
constexpr double time_for_points = 1.0;

/// A body of which nodes of a mesh, and its own corners, take long.
[[nodiscard]] inline bool has_many_sides(const ConvexBody& body) noexcept { return !body.many_sides().empty(); }

/// About a piece: what does not come near it is told soonest.
struct Ball {
  explicit Ball(const Piece& piece) noexcept {
    for (std::size_t i = 0; i < piece.count; ++i) center += piece.corners[i] / static_cast<double>(piece.count);
    double square = 0.0;
    for (std::size_t i = 0; i < piece.count; ++i) square = std::max(square, (piece.corners[i] - center).squaredNorm());
    radius = (1.0 + 1e-9) * std::sqrt(square) + 1e-12 * center.norm();  // more than rounding takes
  }
  Vec3 center = Vec3::Zero();
  double radius = 0.0;
};

/// Any of the first sides of a body may cut.
constexpr std::uint64_t all_sides = ~std::uint64_t{0};

/// Cuts a triangle by sides of the body: of the first ones those with a bit in `sides`, where no more than these may
/// cut it; of a body with many sides all. False if nothing with an area is left, or what is left does not meet the
/// body.
[[nodiscard]] bool cut_triangle(const PreparedMesh& mesh, std::uint32_t triangle, const math::Pose& mesh_in_body,
                                const ConvexBody& body, std::uint64_t sides, Piece& piece) noexcept;

/// Where a body goes to leave a patch of surface.
struct Exit {
  Vec3 direction = Vec3::Zero();  ///< unit, of the body's motion
  double depth = 0.0;             ///< metres until the body is clear of the patch; infinity: no way found
};

/// The shortest way out of `patch` (pieces with similar normals, not empty) among the patch's normals and the body's
/// own exits. Where the surface goes on beyond the body on the side that the body moves to, the whole plane of the
/// piece must be cleared, not only the piece: otherwise a body would slip sideways out of a tessellated floor.
/// `goes_on`: pieces of the patch were left out, and the surface may go on wherever it is seen to end; then the plane
/// in its middle must be cleared. When the time is up, the best so far; at least the mean normal was tried.
[[nodiscard]] Exit shortest_exit(std::span<const Piece* const> patch, const ConvexBody& body, bool goes_on,
                                 const Limit& limit) noexcept;

}  // namespace odds::ode
