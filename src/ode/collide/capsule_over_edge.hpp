// A capsule whose axis cuts off an edge of a solid: it goes in through one face and out through another.
#pragma once

#include <cstdint>
#include <optional>

#include "ode/collide/capsule_places.hpp"
#include "ode/mesh/prepared_mesh.hpp"

namespace odds::ode {

/// The way of such an axis over the edge, in the mesh's frame.
struct WayOverEdge {
  /// Where the axis goes through the surface, and the unit normal of that face.
  struct Side {
    const CapsulePlace* place = nullptr;
    Vec3 out = Vec3::Zero();
  };

  Vec3 on_edge = Vec3::Zero();  ///< nearest to the axis, of the line in which the planes of both faces meet
  Vec3 out = Vec3::Zero();      ///< unit, across the axis
  double depth = 0.0;           ///< metres the axis has to go along `out`
  Side in;                      ///< nearer to the capsule's first end
  Side back;                    ///< nearer to its second one
};

/// Nothing where an end of the axis is within the solid, or more than one part of it, or where the faces are parallel.
/// All places where the axis goes through must be among `places`. noexcept, no allocation.
[[nodiscard]] std::optional<WayOverEdge> way_over_edge(const PreparedMesh& mesh, const Capsule& capsule,
                                                       const CapsulePlaces& places) noexcept;

}  // namespace odds::ode
