// Our class against any convex body: the surface inside it, in patches of similar normals, each with one direction.
#pragma once

#include <cstdint>
#include <optional>

#include "odds/math/pose.hpp"
#include "ode/collide/contact_writer.hpp"
#include "ode/collide/limit.hpp"
#include "ode/geom/convex_body.hpp"
#include "ode/mesh/prepared_mesh.hpp"

namespace odds::ode {

/// How much of the surface inside a body a collision has looked at.
enum class Seen : std::uint8_t {
  all,
  what_has_room,  ///< more pieces than are kept: the same ones in every run
  cut_off,        ///< the limit ended it
};

/// Writes contacts of a mesh (the writer's g1) with a body, the deepest patch first; normals lead into the mesh. One
/// normal for all patches that the body leaves in the same direction; depths are at most the way out of the patch.
/// Nothing but the limit, or the room for pieces of the surface, ends it before every triangle was seen; `turn`: see
/// gather_pieces. noexcept, no allocation (about 150 KB of the stack).
[[nodiscard]] Seen write_convex_contacts(const PreparedMesh& mesh, const math::Pose& mesh_in_world,
                                         const math::Pose& body_in_world, const ConvexBody& body, std::uint32_t turn,
                                         Limit& limit, ContactWriter& writer, int room) noexcept;

/// The whole of a collider function: the mesh's pose and settings, the limit, the counters. `begun_ns`: as of Limit.
[[nodiscard]] int collide_convex_body(dGeomID mesh, dGeomID partner, const ConvexBody& body, int flags,
                                      dContactGeom* contacts, int skip,
                                      std::optional<std::int64_t> begun_ns = std::nullopt) noexcept;

}  // namespace odds::ode
