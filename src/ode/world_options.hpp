// What options a world can be made from.
#pragma once

#include <optional>

#include "odds/ode/world.hpp"

namespace odds::ode {

inline constexpr int most_contacts_per_pair = 8;  ///< the geom's own limit

/// What is wrong with the options; nothing if all is well.
[[nodiscard]] std::optional<Error> check(const WorldOptions& options);

}  // namespace odds::ode
