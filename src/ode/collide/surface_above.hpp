// Where the surface of a mesh is over a point of a convex body.
#pragma once

#include <cstdint>
#include <optional>

#include "odds/math/pose.hpp"
#include "ode/collide/limit.hpp"
#include "ode/geom/convex_body.hpp"
#include "ode/mesh/prepared_mesh.hpp"

namespace odds::ode {

/// Where a line from inside the surface comes out of it.
struct Above {
  std::uint32_t triangle;
  double way;  ///< metres, > 0
};

/// Where the surface is over a point of the body, seen along `up` (both in the body's frame; unit), by no more than
/// `most` (metres). Nothing if it is not, or not within the time. noexcept, no allocation.
std::optional<Above> surface_above(const PreparedMesh& mesh, const math::Pose& body_in_mesh, const ConvexBody& body,
                                   const Vec3& point, const Vec3& up, double most, Limit& limit) noexcept;

}  // namespace odds::ode
