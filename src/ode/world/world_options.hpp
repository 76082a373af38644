// What options a world can be made from, and what ODE is told of them.
#pragma once

#include <ode/ode.h>

#include <cstdint>
#include <optional>

#include "odds/ode/world.hpp"

namespace odds::ode {

inline constexpr int most_contacts_per_pair = 8;  ///< the geom's own limit

/// What is out of range, and what to give instead.
struct Fault {
  const char* what;
  const char* remedy;
};

/// What is wrong with a model of contact; nothing if all is well.
[[nodiscard]] std::optional<Fault> fault_of(const ContactModel& contact) noexcept;

[[nodiscard]] bool is_in_range(const Damping& damping) noexcept;

/// What is wrong with the options; nothing if all is well.
[[nodiscard]] std::optional<Error> check(const WorldOptions& options);

/// Gives a mesh geom the limits and the method of a world's queries. False where it refuses one (oddsGetLastError).
[[nodiscard]] bool configure(dGeomID geom, const query::Request& query) noexcept;

/// Makes the solver take its memory for the most contacts of a step at once.
void reserve_solver(dWorldID world, const WorldOptions& options, std::uint32_t dynamic_bodies) noexcept;

}  // namespace odds::ode
