// The names of all effects, in the order in which they act: each is the file NAME.cpp of this folder.
#pragma once

#include "odds/haptics/effect.hpp"

// clang-format off
#define ODDS_EFFECTS(X) \
  X(virtual_coupling) X(gravity) X(damping) X(viscosity) X(attraction) X(snap) X(gyroscopic) X(contact) \
  X(deep_contact) X(compliance) X(texture) X(surface_velocity) X(friction) X(rolling_friction) X(restitution) X(energy_tank) \
  X(events) X(vibration) X(passivity_control)
// clang-format on

namespace odds::haptics::effects {

#define ODDS_DECLARE(name) Result<std::unique_ptr<Effect>> make_##name(const EffectRequest& request);
ODDS_EFFECTS(ODDS_DECLARE)
#undef ODDS_DECLARE

}  // namespace odds::haptics::effects
