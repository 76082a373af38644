// The tables [effects.*] of a scene.
#pragma once

#include <optional>

#include "odds/scene/scene.hpp"

namespace odds::scene {

/// Reads [effects]: every table in it switches one effect on.
std::optional<Error> read_effects(const haptics::Settings& settings, Effects& effects);

}  // namespace odds::scene
