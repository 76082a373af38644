// What a world's pairs of meshes know before its first step.
#pragma once

#include <ode/ode.h>

#include <optional>

#include "odds/math/error.hpp"
#include "odds/query/request.hpp"

namespace odds::ode {

/// Collides what is near in a space of our meshes once, without a budget and without consequence: that a body starts in
/// another or on it, and how deeply, is then known before a budget leaves time for a part of it only. `query`: the
/// world's own, which is given back to the geoms. An error where a geom refuses it. Takes its time.
[[nodiscard]] std::optional<Error> first_look(dSpaceID space, const query::Request& query);

}  // namespace odds::ode
