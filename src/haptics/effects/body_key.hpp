// Names of bodies in the tables of effects.
#pragma once

#include <fmt/core.h>

#include <string>
#include <string_view>
#include <vector>

#include "odds/haptics/effect.hpp"

namespace odds::haptics::effects {

/// Reads the name of a body, which must be there; reports an unknown one with the nearest that is known, and one
/// that never moves where that makes no sense.
inline void read_body(SettingsReader& reader, std::string_view key, std::span<const BodyInfo> bodies, bool must_move,
                      ode::BodyId& target) {
  reader.require(key);
  std::string name;
  if (!reader.text(key, name)) return;
  std::vector<std::string_view> names;
  for (const BodyInfo& body : bodies) names.push_back(body.name);
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].name != name) continue;
    target = {i};
    if (must_move && !bodies[i].dynamic) {
      reader.reject(key, fmt::format("the body '{}' never moves", name), "name a dynamic body, or make it dynamic");
    }
    return;
  }
  const std::string near = nearest_name(name, names);
  reader.reject(key, fmt::format("there is no [[body]] named '{}'", name),
                !near.empty()   ? fmt::format("did you mean '{}'?", near)
                : names.empty() ? "add a [[body]] of this name"
                                : "valid are " + list_names(names));
}

/// Whether a body takes part in a meeting.
inline bool involves(const ode::Meeting& meeting, ode::BodyId body) noexcept {
  return meeting.a == body || meeting.b == body;
}

}  // namespace odds::haptics::effects
