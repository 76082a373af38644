// What a broad phase knows of the pairs for which it does not ask: where it left them, they were apart.
#pragma once

#include <ode/ode.h>

#include <cstdint>
#include <optional>

#include "odds/math/pose.hpp"
#include "ode/geom/geom_data.hpp"

namespace odds::ode {

/// The number, from 1 on, of the calling thread's call of a broad phase that asks for all pairs that are near and whose
/// caller notes the geoms' places after each; 0: none is under way.
inline thread_local std::uint64_t current_broad_phase = 0;

/// From its construction to its end such a call is under way.
class BroadPhaseScope {
 public:
  explicit BroadPhaseScope(std::uint64_t number) noexcept : outer_(current_broad_phase) {
    current_broad_phase = number;
  }
  BroadPhaseScope(const BroadPhaseScope&) = delete;
  BroadPhaseScope& operator=(const BroadPhaseScope&) = delete;
  ~BroadPhaseScope() { current_broad_phase = outer_; }

 private:
  std::uint64_t outer_;
};

/// Notes where the geoms of a space stand, all of which are meshes of this library, as the broad phase `number` found
/// them. A geom whose pose is none is not noted.
void note_places(dSpaceID space, std::uint64_t number) noexcept;

/// As if no broad phase had seen a geom, which is a mesh of this library.
void forget_place(dGeomID geom) noexcept;

/// The pose of B in A in the broad phase before the current one; nothing if one is not known to have been seen by it.
[[nodiscard]] std::optional<math::Pose> before_this_broad_phase(const GeomData& a, const GeomData& b) noexcept;

}  // namespace odds::ode
