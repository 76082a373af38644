// The tables [effects.*] of a scene.
#pragma once

#include <memory>
#include <optional>

#include "odds/haptics/effect.hpp"
#include "odds/scene/scene.hpp"

namespace odds::scene {

/// Reads [effects]: every table in it switches one effect on. Checks each one's keys by making it once, and what it
/// rests on: other effects, moving bodies, a device. The bodies are known already.
std::optional<Error> read_effects(const haptics::Settings& settings, Scene& scene);

/// What effects are made from in this scene.
[[nodiscard]] std::vector<haptics::BodyInfo> body_infos(const Scene& scene);

}  // namespace odds::scene
