// Effects by name: how a scene gets what it asks for.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "odds/haptics/effect.hpp"

namespace odds::haptics {

struct EffectType {
  std::string_view name;  ///< of the table [effects.NAME] and of the file src/haptics/effects/NAME.cpp
  Result<std::unique_ptr<Effect>> (*make)(const EffectRequest& request) = nullptr;
};

/// All effects, in the order in which they act within a stage.
[[nodiscard]] std::span<const EffectType> effect_types() noexcept;

/// Index into effect_types(), or their number if there is none of this name.
[[nodiscard]] std::size_t effect_index(std::string_view name) noexcept;

/// Makes one and counts it. Errors name the key, its place and the remedy. Precondition: the name is known.
[[nodiscard]] Result<std::unique_ptr<Effect>> make_effect(std::string_view name, const EffectRequest& request);

/// How many of a type this process has made so far: what nobody asked for was never made.
[[nodiscard]] std::uint64_t effects_made(std::string_view name) noexcept;

}  // namespace odds::haptics
