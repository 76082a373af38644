// Smooth seeded noise over space. Private to mesh/made.
#pragma once

#include <cstdint>

#include "odds/math/types.hpp"

namespace odds::mesh::made {

/// Value noise in -1 .. 1 on the unit lattice, blended by quintics (continuous second derivative); a function of seed
/// and position alone. Positions up to 1e9 in magnitude.
double smooth_noise(std::uint64_t seed, const Vec3& position);

}  // namespace odds::mesh::made
