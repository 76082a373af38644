// What a world's pairs of meshes know before its first step.
#pragma once

#include <ode/ode.h>

#include "odds/query/request.hpp"

namespace odds::ode {

/// Collides what is near in a space of our meshes once, without a budget and without consequence. `query`: the world's
/// own, which is given back to the geoms. Takes its time.
void first_look(dSpaceID space, const query::Request& query) noexcept;

}  // namespace odds::ode
