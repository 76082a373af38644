// The pieces of a mesh's surface inside a convex body, as many as there is room and time for.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "odds/math/pose.hpp"
#include "ode/collide/limit.hpp"
#include "ode/geom/convex_body.hpp"
#include "ode/mesh/prepared_mesh.hpp"

namespace odds::ode {

struct Pieces {
  static constexpr std::size_t most = 128;
  static constexpr std::size_t most_added = 8;  ///< by add_piece_above
  std::array<Piece, most + most_added> all;
  std::size_t count = 0;
  bool complete = true;
  bool cut_off = false;        ///< by the limit; else only the room for pieces was too small
  bool nearest_first = false;  ///< to some inner point of the body: those left out are farther from it
};

/// Cuts every triangle near the body. Many small ones are gathered by octants of its box, so that those kept are from
/// all of them, unless the time ends; within an octant they are neighbours. Where it ends, collisions with another
/// `turn` have others. noexcept, no allocation.
void gather_pieces(const PreparedMesh& mesh, const math::Pose& body_in_mesh, const ConvexBody& body, std::uint32_t turn,
                   Limit& limit, Pieces& pieces) noexcept;

/// Where pieces were left out, the deepest may be among them. Adds the one that lies over the body's lowest point, seen
/// along `up` (body frame, unit), by no more than `most` (metres). False if there is none, or not within the time, or
/// it is there. noexcept, no allocation.
bool add_piece_above(const PreparedMesh& mesh, const math::Pose& body_in_mesh, const ConvexBody& body, const Vec3& up,
                     double most, Limit& limit, Pieces& pieces) noexcept;

}  // namespace odds::ode
